#include "live/node.h"

#include <stdlib.h>

#include "common/message_facts.h"
#include "common/report.h"
#include "hal_linux/linux_hal.h"
#include "text/units.h"

enum { ID_SETS = 3, IDS_MAX = (int)AGV_MSG_COUNT * ID_SETS + 1 };

/** Most frames that are handed over before a tick: those from before it are more than the sockets hold, unless their size was
 * raised; those after it are more than a bus carries in 20 ms. */
enum { FRAMES_AT_ONCE = 4096, LATER_AT_ONCE = 256 };

struct node {
    node_config_t given;
    agv_config_t config;
    uint16_t ids[IDS_MAX];
    size_t id_count;
    hal_t hal;
    session_t session;
};

/** What the kernel lets through: the protocol as configured and in both ID sets, as the supervisor watches for the other
 * one (P1), and the status frame unless it is off. */
static void choose_ids(node_t *node) {
    agv_ids_t ids;
    agv_config_ids(&node->config, &ids);
    for (uint16_t id = 1; id <= AGV_ID_MAX; id++) {
        if (message_id_is_heard(&ids, id) || (id == node->config.status_frame_id)) {
            node->ids[node->id_count] = id;
            node->id_count++;
        }
    }
}

static void on_left(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t at_us) {
    const node_t *node = ctx;
    if (node->given.on_sent != NULL) {
        node->given.on_sent(node->given.ctx, side, frame, at_us);
    }
}

static bool open_port(node_t *node) {
    char error[LINUX_CAN_ERROR_SIZE];
    const linux_hal_config_t port = {
        .interfaces = {[HAL_CAN_VEHICLE] = node->given.interfaces[HAL_CAN_VEHICLE],
                       [HAL_CAN_AI] = node->given.interfaces[HAL_CAN_AI]},
        .ids = node->ids,
        .id_count = node->id_count,
        .on_left = on_left,
        .ctx = node,
    };
    return linux_hal_open(&node->hal, &port, error) ? true : report("%s", error);
}

node_t *node_open(const node_config_t *config) {
    node_t *node = calloc(1, sizeof *node);
    if (node == NULL) {
        (void)report("out of memory");
        return NULL;
    }
    node->given = *config;
    node->config = *config->config;
    choose_ids(node);
    if (!open_port(node)) {
        free(node);
        return NULL;
    }
    session_init(&node->session, &node->hal);
    if (config->on_event != NULL) {
        (void)session_observe(&node->session, config->on_event, config->ctx);
    }
    return node;
}

/** Milliseconds since the node was opened; what happens now happens at that time, whenever its cause arrived. */
static uint64_t now_ms(const node_t *node) {
    return node_now_us(node) / US_PER_MS;
}

void node_start(node_t *node) {
    session_start(&node->session, &node->config, now_ms(node), hal_clock_now_ms(&node->hal));
}

int node_fd(const node_t *node, hal_can_side_t side) {
    return linux_hal_fd(&node->hal, side);
}

/** Hand over what has arrived. @return false: there may be more that arrived up to this time */
static bool receive_until(node_t *node, uint64_t until_us) {
    hal_can_side_t side = HAL_CAN_VEHICLE;
    hal_can_frame_t frame;
    uint64_t at_us = 0;
    int later = 0;
    for (int i = 0; (i < FRAMES_AT_ONCE) && (later < LATER_AT_ONCE); i++) {
        if (!linux_hal_receive(&node->hal, &side, &frame, &at_us)) {
            return true;
        }
        if (node->given.on_received != NULL) {
            node->given.on_received(node->given.ctx, side, &frame, at_us);
        }
        session_frame(&node->session, side, &frame, now_ms(node));
        later += (at_us > until_us) ? 1 : 0;
    }
    return later > 0;
}

void node_receive(node_t *node) {
    (void)receive_until(node, 0);
}

/** The tick's time is read before the frames: none that has arrived by then is unread when deadlines are judged (SUP-2). */
bool node_tick(node_t *node) {
    const uint64_t tick_us = node_now_us(node);
    const uint32_t clock_ms = (uint32_t)(tick_us / US_PER_MS);
    const bool is_done = receive_until(node, tick_us);
    const bool changed = linux_hal_tick(&node->hal);
    if (is_done) {
        session_tick(&node->session, now_ms(node), clock_ms);
    } else {
        session_tick_behind(&node->session, now_ms(node), clock_ms);
    }
    return changed;
}

uint64_t node_now_us(const node_t *node) {
    return linux_hal_now_us(&node->hal);
}

const session_t *node_session(const node_t *node) {
    return &node->session;
}

void node_finish(node_t *node) {
    if (node != NULL) {
        linux_hal_finish(&node->hal);
    }
}

void node_close(node_t *node) {
    if (node != NULL) {
        linux_hal_close(&node->hal);
        free(node);
    }
}

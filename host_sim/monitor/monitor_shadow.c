#include "monitor/monitor_shadow.h"

#include <stdlib.h>

#include "common/message_facts.h"
#include "hal_sim/sim_hal.h"
#include "logs/error_frame.h"
#include "text/units.h"

struct monitor_shadow {
    agv_config_t config;
    agv_ids_t ids;
    hal_t hal;
    session_t session;
    uint64_t next_ms; /* of the next tick */
};

static void discard(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame) {
    (void)ctx;
    (void)side;
    (void)frame;
}

monitor_shadow_t *monitor_shadow_new(const agv_config_t *config, session_observer_fn *fn, void *ctx, uint64_t t_us) {
    monitor_shadow_t *shadow = calloc(1, sizeof *shadow);
    if (shadow == NULL) {
        return NULL;
    }
    const uint64_t t_ms = t_us / US_PER_MS;
    const sim_hal_config_t hal = {.clock_start_ms = (uint32_t)t_ms, .watchdog_ms = config->watchdog_period_ms};
    shadow->config = *config;
    shadow->config.shadow = (uint16_t)AGV_SHADOW_ON;
    shadow->next_ms = t_ms + 1;
    agv_config_ids(&shadow->config, &shadow->ids);
    sim_hal_init_direct(&shadow->hal, &hal, (config->topology == AGV_TOPOLOGY_GATEWAY) ? 2 : 1, discard, NULL);
    session_init(&shadow->session, &shadow->hal);
    (void)session_observe(&shadow->session, fn, ctx);
    session_start(&shadow->session, &shadow->config, t_ms, (uint32_t)t_ms);
    return shadow;
}

static void run_ticks(monitor_shadow_t *shadow, uint64_t end_us) {
    while (shadow->next_ms * US_PER_MS < end_us) {
        sim_hal_set_now_ms(&shadow->hal, (uint32_t)shadow->next_ms);
        session_tick(&shadow->session, shadow->next_ms, (uint32_t)shadow->next_ms);
        shadow->next_ms++;
    }
}

bool monitor_shadow_time(monitor_shadow_t *shadow, uint64_t t_us) {
    if (t_us > (shadow->next_ms * US_PER_MS) + MONITOR_LEAP_MAX_US) {
        return false;
    }
    run_ticks(shadow, t_us);
    return true;
}

void monitor_shadow_frame(monitor_shadow_t *shadow, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    const uint64_t t_ms = t_us / US_PER_MS;
    const bool is_error = (frame->flags & HAL_CAN_ERROR) != 0;
    if (!is_error && !message_id_is_heard(&shadow->ids, frame->id)) {
        return;
    }
    hal_can_frame_t received = *frame;
    run_ticks(shadow, t_us);
    received.time_ms = (uint32_t)t_ms;
    received.time_us = (uint16_t)(t_us % US_PER_MS);
    sim_hal_set_now_ms(&shadow->hal, (uint32_t)t_ms);
    if (is_error) {
        error_frame_act(&shadow->hal, side, frame);
    }
    session_frame(&shadow->session, side, &received, t_ms);
}

void monitor_shadow_overrun(monitor_shadow_t *shadow, hal_can_side_t side) {
    sim_hal_add_overrun(&shadow->hal, side);
}

const session_t *monitor_shadow_session(const monitor_shadow_t *shadow) {
    return &shadow->session;
}

void monitor_shadow_free(monitor_shadow_t *shadow) {
    free(shadow);
}

/*
 * A controller does not receive its own frames, but the loopback driver has one set of filters for all nodes. So this
 * node passes on all received frames except its own. It recognises them because the driver's thread calls the callback
 * of a sent frame just before it delivers that frame. This node also adds bus-off, which the loopback driver does not
 * have, and a flood: frames of lower priority than the flood's stay in the controller.
 */
#define DT_DRV_COMPAT agv_test_node

#include "node.h"

#include <zephyr/drivers/can.h>
#include <zephyr/kernel.h>

enum { FILTERS = 4, BITRATE_MAX = 1000000 };

typedef struct {
    can_rx_callback_t callback;
    void *data;
} listener_t;

static struct {
    listener_t listeners[FILTERS];
    uint32_t count;
    can_tx_callback_t sent;
    void *sent_data;
    bool is_sender;
    bool is_off;
    bool is_stopped;
    uint32_t flood_id; /* 0: no flood */
    bool is_full;
    struct can_frame mailbox;
    uint32_t recoveries;
    can_state_change_callback_t state_changed;
    void *state_data;
} self;

struct node_config {
    const struct can_driver_config common;
};

struct node_data {
    struct can_driver_data common;
};

const struct device *const test_wire = DEVICE_DT_GET(DT_INST_PHANDLE(0, wire));
static const struct device *const node = DEVICE_DT_INST_GET(0);

bool test_node_sent_it(void) {
    return self.is_sender;
}

void test_node_others_send(void) {
    self.is_sender = false;
}

uint32_t test_node_recoveries(void) {
    return self.recoveries;
}

static void on_sent(const struct device *device, int error, void *data) {
    ARG_UNUSED(device);
    ARG_UNUSED(data);
    self.is_sender = true;
    self.sent(node, error, self.sent_data);
}

static int send(const struct device *device, const struct can_frame *frame, k_timeout_t timeout,
                can_tx_callback_t callback, void *data) {
    ARG_UNUSED(device);
    if (self.is_off || self.is_stopped) {
        return self.is_stopped ? -ENETDOWN : -ENETUNREACH;
    }
    if (self.is_full) {
        return -EAGAIN;
    }
    self.sent = callback;
    self.sent_data = data;
    if ((self.flood_id != 0u) && (frame->id > self.flood_id)) {
        self.is_full = true;
        self.mailbox = *frame;
        return 0;
    }
    return can_send(test_wire, frame, timeout, on_sent, NULL);
}

void test_node_flood(uint32_t id) {
    self.flood_id = id;
    if ((id == 0u) && self.is_full) {
        self.is_full = false;
        (void)can_send(test_wire, &self.mailbox, K_FOREVER, on_sent, NULL);
    }
}

void test_node_overrun(void) {
    CAN_STATS_RX_OVERRUN_INC(node);
}

static void on_frame(const struct device *device, struct can_frame *frame, void *data) {
    const listener_t *const listener = data;
    ARG_UNUSED(device);
    if (!self.is_sender && !self.is_off && !self.is_stopped) {
        listener->callback(node, frame, listener->data);
    }
}

static int add_rx_filter(const struct device *device, can_rx_callback_t callback, void *data,
                         const struct can_filter *filter) {
    ARG_UNUSED(device);
    if (self.count == (uint32_t)FILTERS) {
        return -ENOSPC;
    }
    listener_t *const listener = &self.listeners[self.count];
    *listener = (listener_t){.callback = callback, .data = data};
    self.count++;
    return can_add_rx_filter(test_wire, on_frame, listener, filter);
}

/* The other nodes stay on the bus when this one stops. */
static int start(const struct device *device) {
    CAN_STATS_RESET(device);
    if (!self.is_stopped) {
        return can_start(test_wire);
    }
    self.is_stopped = false;
    return 0;
}

static int stop(const struct device *device) {
    ARG_UNUSED(device);
    self.is_stopped = true;
    if (self.is_full) {
        self.is_full = false;
        self.sent(node, -ENETDOWN, self.sent_data);
    }
    return 0;
}

static int get_capabilities(const struct device *device, can_mode_t *able) {
    ARG_UNUSED(device);
    *able = CAN_MODE_NORMAL | CAN_MODE_MANUAL_RECOVERY;
    return 0;
}

static int set_mode(const struct device *device, can_mode_t mode) {
    ARG_UNUSED(device);
    return (mode == CAN_MODE_MANUAL_RECOVERY) ? can_set_mode(test_wire, CAN_MODE_LOOPBACK) : -ENOTSUP;
}

static int set_timing(const struct device *device, const struct can_timing *timing) {
    ARG_UNUSED(device);
    return can_set_timing(test_wire, timing);
}

static int get_core_clock(const struct device *device, uint32_t *rate) {
    ARG_UNUSED(device);
    return can_get_core_clock(test_wire, rate);
}

static int get_state(const struct device *device, enum can_state *state, struct can_bus_err_cnt *errors) {
    ARG_UNUSED(device);
    const int status = can_get_state(test_wire, state, errors);
    if (self.is_off && (state != NULL)) {
        *state = CAN_STATE_BUS_OFF;
    }
    if (self.is_stopped && (state != NULL)) {
        *state = CAN_STATE_STOPPED;
    }
    return status;
}

/* Runs in an interrupt, as for a real controller. */
static void tell_state(struct k_timer *unused) {
    ARG_UNUSED(unused);
    self.state_changed(node, self.is_off ? CAN_STATE_BUS_OFF : CAN_STATE_ERROR_ACTIVE, (struct can_bus_err_cnt){0},
                       self.state_data);
}

static K_TIMER_DEFINE(interrupt, tell_state, NULL);

static int recover(const struct device *device, k_timeout_t timeout) {
    ARG_UNUSED(device);
    ARG_UNUSED(timeout);
    self.recoveries++;
    self.is_off = false;
    k_timer_start(&interrupt, K_TICKS(1), K_NO_WAIT);
    return 0;
}

void test_node_goes_bus_off(void) {
    self.is_off = true;
    k_timer_start(&interrupt, K_TICKS(1), K_NO_WAIT);
}

static void set_state_change_callback(const struct device *device, can_state_change_callback_t callback, void *data) {
    ARG_UNUSED(device);
    self.state_changed = callback;
    self.state_data = data;
}

static int init(const struct device *device) {
    ARG_UNUSED(device);
    return device_is_ready(test_wire) ? 0 : -ENODEV;
}

static const struct can_driver_api api = {
    .get_capabilities = get_capabilities,
    .start = start,
    .stop = stop,
    .set_mode = set_mode,
    .set_timing = set_timing,
    .send = send,
    .add_rx_filter = add_rx_filter,
    .get_state = get_state,
    .recover = recover,
    .set_state_change_callback = set_state_change_callback,
    .get_core_clock = get_core_clock,
    .timing_min = {.sjw = 1, .phase_seg1 = 2, .phase_seg2 = 2, .prescaler = 1},
    .timing_max = {.sjw = 128, .phase_seg1 = 256, .phase_seg2 = 128, .prescaler = 32},
};

static const struct node_config config = {.common = CAN_DT_DRIVER_CONFIG_INST_GET(0, 0, BITRATE_MAX)};
static struct node_data data;

/* After the loopback driver, which has the priority of all controllers. */
CAN_DEVICE_DT_INST_DEFINE(0, init, NULL, &data, &config, POST_KERNEL, 85, &api);

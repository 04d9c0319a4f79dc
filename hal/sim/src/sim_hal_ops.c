/* The functions of hal/include, behind hal_ops.h. Each is counted, and can be made to fail. */
#include "sim_hal_internal.h"

static bool is_to_fail(const hal_t *hal, sim_hal_op_t op) {
    return hal->calls >= hal->fail_first && hal->calls - hal->fail_first < hal->fail_count &&
           (hal->fail_ops >> op & 1) != 0;
}

/* Count the call. @return false: the call has to fail, or the MCU is held in reset. */
static bool enter(hal_t *hal, sim_hal_op_t op) {
    hal->calls += (hal->calls < UINT32_MAX) ? 1 : 0; /* what fails for good does so in a loop without an end, too */
    hal->op_calls[op]++;
    if (is_to_fail(hal, op)) {
        hal->failures++;
        hal->last_failed = op;
        return false;
    }
    return !hal->held;
}

static bool send_direct(hal_t *hal, sim_hal_can_t *can, hal_can_side_t side, const hal_can_frame_t *frame) {
    if (can->status.state == HAL_CAN_BUS_OFF) {
        return false;
    }
    if (hal->sink != NULL) {
        hal->sink(hal->sink_ctx, side, frame);
    }
    return true;
}

static bool can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame) {
    const bool works = enter(hal, SIM_HAL_OP_CAN_SEND);
    sim_hal_can_t *can = sim_hal_controller(hal, side);
    if (can == NULL) {
        return false;
    }
    bool taken = works && !can->full;
    if (taken && !can->swallows) {
        taken = hal->direct ? send_direct(hal, can, side, frame) : sim_bus_send(can->bus, can->node, frame);
    }
    can->sent += taken ? 1 : 0;
    can->refused += taken ? 0 : 1;
    return taken;
}

static void can_purge(hal_t *hal, hal_can_side_t side) {
    const bool works = enter(hal, SIM_HAL_OP_CAN_PURGE);
    sim_hal_can_t *can = sim_hal_controller(hal, side);
    if (!works || can == NULL) {
        return;
    }
    can->purges++;
    can->status.tx_pending_ms = 0;
    if (can->bus != NULL) {
        sim_bus_purge(can->bus, can->node);
    }
}

static void can_recover(hal_t *hal, hal_can_side_t side) {
    const bool works = enter(hal, SIM_HAL_OP_CAN_RECOVER);
    sim_hal_can_t *can = sim_hal_controller(hal, side);
    if (!works || can == NULL) {
        return;
    }
    hal_can_status_t status = can->status;
    if (can->bus != NULL) {
        sim_bus_status(can->bus, can->node, &status);
        sim_bus_recover(can->bus, can->node);
    }
    if (status.state == HAL_CAN_BUS_OFF) {
        can->recover_requests++;
    }
}

static void can_status(hal_t *hal, hal_can_side_t side, hal_can_status_t *status) {
    const bool works = enter(hal, SIM_HAL_OP_CAN_STATUS);
    sim_hal_can_t *can = sim_hal_controller(hal, side);
    if (can == NULL) {
        *status = (hal_can_status_t){.state = HAL_CAN_ERROR_ACTIVE};
        return;
    }
    if (works && can->bus != NULL) {
        sim_bus_status(can->bus, can->node, &can->status);
    }
    *status = can->status;
}

static uint32_t clock_now_ms(hal_t *hal) {
    if (enter(hal, SIM_HAL_OP_CLOCK_NOW)) {
        hal->last_now_ms = sim_hal_now_ms(hal);
    }
    return hal->last_now_ms;
}

static void led_set(hal_t *hal, bool on) {
    if (enter(hal, SIM_HAL_OP_LED_SET)) {
        sim_hal_set_pin(&hal->led, on, sim_hal_now_ms(hal));
    }
}

static void safety_output_set(hal_t *hal, bool closed) {
    if (enter(hal, SIM_HAL_OP_SAFETY_OUTPUT_SET)) {
        sim_hal_set_pin(&hal->safety_output, closed, sim_hal_now_ms(hal));
    }
}

static hal_reset_cause_t reset_cause(hal_t *hal) {
    return enter(hal, SIM_HAL_OP_RESET_CAUSE) ? hal->config.reset_cause : HAL_RESET_UNKNOWN;
}

static void watchdog_feed(hal_t *hal) {
    const bool works = enter(hal, SIM_HAL_OP_WATCHDOG_FEED);
    const uint32_t now_ms = sim_hal_now_ms(hal);
    if (works && !sim_hal_watch(hal, now_ms)) {
        hal->feeds++;
        hal->fed_ms = now_ms;
    }
}

static size_t store_read_latch(hal_t *hal, void *record, size_t size) {
    const bool works = enter(hal, SIM_HAL_OP_STORE_READ_LATCH) && hal->config.store != NULL;
    return works ? sim_store_read_latch(hal->config.store, record, size) : 0;
}

static bool store_write_latch(hal_t *hal, const void *record, size_t size) {
    const bool works = enter(hal, SIM_HAL_OP_STORE_WRITE_LATCH) && hal->config.store != NULL;
    return works && sim_store_write_latch(hal->config.store, record, size);
}

static bool store_append(hal_t *hal, const void *record, size_t size) {
    const bool works = enter(hal, SIM_HAL_OP_STORE_APPEND) && hal->config.store != NULL;
    return works && sim_store_append(hal->config.store, record, size);
}

static size_t store_read_record(hal_t *hal, uint32_t index, void *record, size_t size) {
    const bool works = enter(hal, SIM_HAL_OP_STORE_READ_RECORD) && hal->config.store != NULL;
    return works ? sim_store_read_record(hal->config.store, index, record, size) : 0;
}

static void inputs_read(hal_t *hal, hal_inputs_t *inputs) {
    if (enter(hal, SIM_HAL_OP_INPUTS_READ)) {
        hal->last_inputs = sim_board_inputs(hal, sim_hal_now_ms(hal));
    }
    *inputs = hal->last_inputs;
}

static bool clock_second_ms(hal_t *hal, uint32_t *time_ms) {
    if (enter(hal, SIM_HAL_OP_CLOCK_SECOND)) {
        hal->last_second_ms = sim_board_second_ms(hal, sim_hal_now_ms(hal));
    }
    *time_ms = hal->last_second_ms;
    return hal->board.has_second_clock;
}

static uint32_t self_test(hal_t *hal) {
    return enter(hal, SIM_HAL_OP_SELF_TEST) ? hal->board.failed : 0;
}

const hal_ops_t sim_hal_ops = {
    .can_send = can_send,
    .can_purge = can_purge,
    .can_recover = can_recover,
    .can_status = can_status,
    .clock_now_ms = clock_now_ms,
    .led_set = led_set,
    .safety_output_set = safety_output_set,
    .reset_cause = reset_cause,
    .watchdog_feed = watchdog_feed,
    .store_read_latch = store_read_latch,
    .store_write_latch = store_write_latch,
    .store_append = store_append,
    .store_read_record = store_read_record,
    .inputs_read = inputs_read,
    .clock_second_ms = clock_second_ms,
    .self_test = self_test,
};

/* Building and running the simulated port. */
#include <string.h>

#include "sim_hal_internal.h"

static sim_bus_t *clock_bus(const hal_t *hal) {
    sim_bus_t *vehicle = hal->can[HAL_CAN_VEHICLE].bus;
    return vehicle != NULL ? vehicle : hal->can[HAL_CAN_AI].bus;
}

uint32_t sim_hal_clock_at(const hal_t *hal, uint64_t bus_us) {
    if (hal->direct) {
        return hal->direct_now_ms;
    }
    return hal->config.clock_start_ms + (uint32_t)((bus_us + hal->config.clock_phase_us) / 1000);
}

uint32_t sim_hal_now_ms(const hal_t *hal) {
    const sim_bus_t *bus = clock_bus(hal);
    return sim_hal_clock_at(hal, bus != NULL ? sim_bus_now_us(bus) : 0);
}

void sim_hal_init(hal_t *hal, const sim_hal_config_t *config) {
    memset(hal, 0, sizeof *hal);
    hal->ops = &sim_hal_ops;
    if (config != NULL) {
        hal->config = *config;
    }
    if (hal->config.watchdog_ms == 0) {
        hal->config.watchdog_ms = SIM_HAL_WATCHDOG_DEFAULT_MS;
    }
    hal->direct_now_ms = hal->config.clock_start_ms;
    hal->fed_ms = sim_hal_now_ms(hal);
    hal->last_now_ms = hal->fed_ms;
}

bool sim_hal_attach(hal_t *hal, hal_can_side_t side, sim_bus_t *bus, const sim_bus_node_config_t *config) {
    static const sim_bus_node_config_t with_queue = {.rx_slots = SIM_BUS_RX_SLOTS_MAX};
    if (hal->direct || (unsigned)side >= HAL_CAN_SIDES || hal->can[side].exists) {
        return false;
    }
    sim_hal_can_t *can = &hal->can[side];
    can->node = sim_bus_attach(bus, config != NULL ? config : &with_queue);
    if (can->node == SIM_BUS_NO_NODE) {
        return false;
    }
    can->bus = bus;
    can->exists = true;
    hal->fed_ms = sim_hal_now_ms(hal);
    hal->last_now_ms = hal->fed_ms;
    return true;
}

void sim_hal_init_direct(hal_t *hal, const sim_hal_config_t *config, unsigned sides, sim_hal_sink_fn *sink, void *ctx) {
    sim_hal_init(hal, config);
    hal->direct = true;
    hal->sink = sink;
    hal->sink_ctx = ctx;
    hal->can[HAL_CAN_VEHICLE].exists = sides >= 1;
    hal->can[HAL_CAN_AI].exists = sides >= 2;
}

bool sim_hal_receive(hal_t *hal, hal_can_side_t side, hal_can_frame_t *frame) {
    if (hal->held || (unsigned)side >= HAL_CAN_SIDES || hal->can[side].bus == NULL) {
        return false;
    }
    sim_hal_can_t *can = &hal->can[side];
    uint64_t time_us = 0;
    if (!sim_bus_receive(can->bus, can->node, frame, &time_us)) {
        return false;
    }
    frame->time_ms = sim_hal_clock_at(hal, time_us);
    frame->time_us = (uint16_t)((time_us + hal->config.clock_phase_us) % 1000);
    can->received++;
    return true;
}

static void set_power(hal_t *hal, bool on) {
    for (unsigned side = 0; side < HAL_CAN_SIDES; side++) {
        if (hal->can[side].bus != NULL) {
            sim_bus_set_power(hal->can[side].bus, hal->can[side].node, on);
        }
    }
}

static void hold_in_reset(hal_t *hal, uint32_t time_ms) {
    hal->held = true;
    sim_hal_set_pin(&hal->safety_output, false, time_ms);
    sim_hal_set_pin(&hal->led, false, time_ms);
    set_power(hal, false);
}

void sim_hal_hold(hal_t *hal) {
    hold_in_reset(hal, sim_hal_now_ms(hal));
}

bool sim_hal_watch(hal_t *hal, uint32_t now_ms) {
    if (!hal->held && hal->config.watchdog_ms != SIM_HAL_WATCHDOG_OFF &&
        now_ms - hal->fed_ms > hal->config.watchdog_ms) {
        hal->bites++;
        hold_in_reset(hal, hal->fed_ms + hal->config.watchdog_ms);
    }
    return hal->held;
}

bool sim_hal_poll(hal_t *hal) {
    return sim_hal_watch(hal, sim_hal_now_ms(hal));
}

void sim_hal_reset(hal_t *hal, hal_reset_cause_t cause) {
    const uint32_t now_ms = sim_hal_now_ms(hal);
    hold_in_reset(hal, now_ms);
    hal->held = false;
    hal->resets++;
    hal->config.reset_cause = cause;
    set_power(hal, true);
    for (unsigned side = 0; side < HAL_CAN_SIDES; side++) {
        hal->can[side].status = (hal_can_status_t){.state = HAL_CAN_ERROR_ACTIVE};
    }
    if (cause == HAL_RESET_POWER_ON && hal->config.store != NULL && !hal->config.store->keep_latch) {
        hal->config.store->latch_size = 0;
    }
    hal->fed_ms = now_ms;
    hal->last_now_ms = now_ms;
}

void sim_hal_fail_at(hal_t *hal, uint32_t first, uint32_t count, uint32_t ops) {
    hal->fail_first = first;
    hal->fail_count = first == 0 ? 0 : count;
    hal->fail_ops = ops;
}

void sim_hal_set_now_ms(hal_t *hal, uint32_t now_ms) {
    hal->direct_now_ms = now_ms;
}

void sim_hal_set_can_state(hal_t *hal, hal_can_side_t side, hal_can_state_t state) {
    sim_hal_can_t *can = sim_hal_controller(hal, side);
    if (can == NULL || !hal->direct) {
        return;
    }
    if (state == HAL_CAN_BUS_OFF && can->status.state != HAL_CAN_BUS_OFF) {
        can->status.bus_off_count++;
        can->status.tx_pending_ms = 0;
    }
    can->status.state = state;
}

void sim_hal_add_overrun(hal_t *hal, hal_can_side_t side) {
    sim_hal_can_t *can = sim_hal_controller(hal, side);
    if (can == NULL) {
        return;
    }
    if (hal->direct) {
        can->status.overrun_count++;
    } else {
        sim_bus_inject_overrun(can->bus, can->node);
    }
}

void sim_hal_set_tx_pending_ms(hal_t *hal, hal_can_side_t side, uint32_t tx_pending_ms) {
    sim_hal_can_t *can = sim_hal_controller(hal, side);
    if (can != NULL && hal->direct) {
        can->status.tx_pending_ms = tx_pending_ms;
    }
}

void sim_hal_set_swallowing(hal_t *hal, hal_can_side_t side, bool swallows) {
    sim_hal_can_t *can = sim_hal_controller(hal, side);
    if (can != NULL) {
        can->swallows = swallows;
    }
}

void sim_hal_set_full(hal_t *hal, hal_can_side_t side, bool full) {
    sim_hal_can_t *can = sim_hal_controller(hal, side);
    if (can != NULL) {
        can->full = full;
    }
}

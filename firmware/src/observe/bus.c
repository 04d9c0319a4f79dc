#include "observe/bus.h"

static uint32_t timer_of(hal_can_side_t side) {
    return (side == HAL_CAN_VEHICLE) ? (uint32_t)AGV_TIMER_BUS_OFF : (uint32_t)AGV_TIMER_AI_BUS_OFF;
}

/* Store the controller's counters. */
static void store_counters(agv_bus_t *bus, const hal_can_status_t *status) {
    bus->bus_offs = status->bus_off_count;
    bus->overruns = status->overrun_count;
}

void agv_bus_start(agv_bus_t *bus, hal_t *hal, hal_can_side_t side) {
    hal_can_status_t status;
    hal_can_status(hal, side, &status);
    store_counters(bus, &status);
}

bool agv_bus_is_off(const agv_timers_t *timers, hal_can_side_t side) {
    return agv_timer_is_started(timers, timer_of(side));
}

uint32_t agv_bus_tick(agv_bus_t *bus, agv_timers_t *timers, const agv_config_t *config, hal_t *hal,
                      hal_can_side_t side) {
    uint32_t report = agv_bus_is_off(timers, side) ? AGV_BUS_RECOVERED : 0u;
    hal_can_status_t status;
    hal_can_status(hal, side, &status);
    const bool is_off = status.state == HAL_CAN_BUS_OFF;
    if (status.bus_off_count != bus->bus_offs) {
        report = AGV_BUS_OFF | AGV_BUS_RECOVERED;
    }
    if (status.tx_pending_ms != 0u) {
        report |= AGV_BUS_WAITING;
    }
    if (status.tx_pending_ms > config->tx_stalled_ms) {
        report |= AGV_BUS_STALLED;
    }
    if (is_off) {
        report = AGV_BUS_OFF; /* not recovered, and no frame is waiting */
    }
    if (status.state == HAL_CAN_ERROR_PASSIVE) {
        report |= AGV_BUS_PASSIVE;
    }
    if (status.overrun_count != bus->overruns) {
        report |= AGV_BUS_OVERRUN;
    }
    if (agv_timer_while(timers, timer_of(side), is_off)) {
        agv_timer_start(timers, timer_of(side));
        report |= AGV_BUS_ASK_RECOVERY;
    }
    store_counters(bus, &status);
    return report;
}

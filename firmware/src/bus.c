#include "agv/bus.h"

#include "agv/core.h"

static uint32_t watch_of(hal_can_side_t side) {
    return (uint32_t)AGV_WATCH_BUS_OFF + (uint32_t)side;
}

/* Keeps what the controller has counted. */
static void follow(agv_bus_t *bus, const hal_can_status_t *status) {
    bus->bus_offs = status->bus_off_count;
    bus->overruns = status->overrun_count;
}

void agv_bus_start(agv_core_t *core, hal_can_side_t side) {
    hal_can_status_t status;
    hal_can_status(core->hal, side, &status);
    follow(&core->buses[side], &status);
}

bool agv_bus_is_off(const agv_core_t *core, hal_can_side_t side) {
    return agv_watch_runs(core, watch_of(side));
}

uint32_t agv_bus_tick(agv_core_t *core, hal_can_side_t side) {
    agv_bus_t *const bus = &core->buses[side];
    uint32_t report = agv_bus_is_off(core, side) ? AGV_BUS_RECOVERED : 0u;
    hal_can_status_t status;
    hal_can_status(core->hal, side, &status);
    const bool is_off = status.state == HAL_CAN_BUS_OFF;
    if (status.bus_off_count != bus->bus_offs) {
        report = AGV_BUS_OFF | AGV_BUS_RECOVERED;
    }
    if (status.tx_pending_ms > core->config.tx_stalled_ms) {
        report |= AGV_BUS_STALLED;
    }
    if (is_off) {
        report = AGV_BUS_OFF; /* not recovered, and what waits is gone */
    }
    if (status.state == HAL_CAN_ERROR_PASSIVE) {
        report |= AGV_BUS_PASSIVE;
    }
    if (status.overrun_count != bus->overruns) {
        report |= AGV_BUS_OVERRUN;
    }
    if (agv_watch_while(core, watch_of(side), is_off)) {
        agv_watch_start(core, watch_of(side));
        report |= AGV_BUS_ASK_RECOVERY;
    }
    follow(bus, &status);
    return report;
}

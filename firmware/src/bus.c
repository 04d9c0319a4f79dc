#include "agv/bus.h"

void agv_bus_start(agv_bus_t *bus, const hal_can_status_t *status) {
    *bus = (agv_bus_t){.bus_offs = status->bus_off_count, .overruns = status->overrun_count};
}

bool agv_bus_is_off(const agv_bus_t *bus) {
    return bus->off.phase != (uint8_t)AGV_TIMER_STOPPED;
}

agv_bus_report_t agv_bus_tick(agv_bus_t *bus, const hal_can_status_t *status, uint16_t recovery_ms, uint16_t stalled_ms,
                              uint32_t now_ms) {
    const bool was_off = agv_bus_is_off(bus);
    const bool is_off = status->state == HAL_CAN_BUS_OFF;
    const bool again = status->bus_off_count != bus->bus_offs;
    agv_timer_while(&bus->off, is_off, now_ms);
    const agv_bus_report_t report = {
        .off = is_off || again,
        .recovered = (was_off || again) && !is_off,
        .ask_recovery = agv_timer_reached(&bus->off, now_ms, recovery_ms),
        .passive = status->state == HAL_CAN_ERROR_PASSIVE,
        .overrun = status->overrun_count != bus->overruns,
        .stalled = !is_off && (status->tx_pending_ms > stalled_ms),
    };
    if (report.ask_recovery) {
        agv_timer_start(&bus->off, now_ms);
    }
    bus->bus_offs = status->bus_off_count;
    bus->overruns = status->overrun_count;
    return report;
}

/**
 * @file bus.h
 * The state of one CAN controller as the supervisor follows it (SUP-7).
 */
#ifndef AGV_BUS_H
#define AGV_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/timer.h"
#include "hal/can.h"

/** One controller. */
typedef struct {
    agv_timer_t off;   /**< since bus-off, or since its recovery was last asked for */
    uint16_t bus_offs; /**< as last read */
    uint16_t overruns; /**< as last read */
} agv_bus_t;

/** What a look at the controller showed. */
typedef struct {
    bool off;          /**< bus-off now, or it was since the last look */
    bool recovered;    /**< left bus-off since the last look */
    bool ask_recovery; /**< purge and ask for recovery now */
    bool passive;      /**< error-passive */
    bool overrun;      /**< received frames were lost since the last look */
    bool stalled;      /**< a frame taken does not leave for too long */
} agv_bus_report_t;

/** Take the controller's counters as the starting point. */
void agv_bus_start(agv_bus_t *bus, const hal_can_status_t *status);

/** Look at the controller. Call at every tick. */
agv_bus_report_t agv_bus_tick(agv_bus_t *bus, const hal_can_status_t *status, uint16_t recovery_ms, uint16_t stalled_ms,
                              uint32_t now_ms);

/** Whether the controller was in bus-off at the last look. */
bool agv_bus_is_off(const agv_bus_t *bus);

#endif

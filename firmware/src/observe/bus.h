/**
 * @file bus.h
 * The state of one CAN controller (SUP-7).
 */
#ifndef AGV_BUS_H
#define AGV_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/timers.h"
#include "hal/can.h"

/** One controller. Its timer (AGV_TIMER_BUS_OFF, AGV_TIMER_AI_BUS_OFF) holds whether and since when it is in bus-off. */
typedef struct {
    uint16_t bus_offs; /**< as last read */
    uint16_t overruns; /**< as last read */
} agv_bus_t;

/** Result of agv_bus_tick: bits. "Since the last tick" is since the last call. */
#define AGV_BUS_OFF 0x01u          /**< in bus-off now, or at some time since the last tick */
#define AGV_BUS_RECOVERED 0x02u    /**< left bus-off since the last tick */
#define AGV_BUS_ASK_RECOVERY 0x04u /**< purge the controller and request its recovery now */
#define AGV_BUS_PASSIVE 0x08u      /**< error-passive */
#define AGV_BUS_OVERRUN 0x10u      /**< received frames were lost since the last tick */
#define AGV_BUS_STALLED 0x20u      /**< an accepted frame has been waiting for too long */
#define AGV_BUS_WAITING 0x40u      /**< an accepted frame is waiting */

/** Take the controller's counters as the reference for later ticks. */
void agv_bus_start(agv_bus_t *bus, hal_t *hal, hal_can_side_t side);

/** Read the state of the controller. Call at every tick. @return AGV_BUS_* bits */
uint32_t agv_bus_tick(agv_bus_t *bus, agv_timers_t *timers, const agv_config_t *config, hal_t *hal,
                      hal_can_side_t side);

/** Whether the controller was in bus-off at the last tick. */
bool agv_bus_is_off(const agv_timers_t *timers, hal_can_side_t side);

#endif

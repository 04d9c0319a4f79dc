/**
 * @file motion_checks.h
 * Whether the vehicle does what it was told, as far as that takes time to see (SUP-5): steering that does not follow its
 * command, throttle above 0 in gear P.
 */
#ifndef AGV_MOTION_CHECKS_H
#define AGV_MOTION_CHECKS_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "decide/fault_monitor.h"
#include "observe/vehicle.h"

/** State of the checks. */
typedef struct {
    uint16_t command_raw;       /**< steering command that counts, raw (P5) */
    uint16_t steering_off_ddeg; /**< difference from which a gain is counted */
    bool command_known;
} agv_motion_checks_t;

/** The steering command that counts, while engaged (SUP-5): as received, or as the gateway sent it on. */
void agv_motion_checks_steering_commanded(agv_motion_checks_t *checks, uint32_t angle_raw, bool engaged);

/** The autopilot was disengaged: no command counts. */
void agv_motion_checks_disengage(agv_motion_checks_t *checks);

/**
 * Evaluate. Call at every tick.
 * @param settled engaged for engaged_grace_ms
 * @param in_park fresh 0A3h reports P
 */
void agv_motion_checks_tick(agv_motion_checks_t *checks, agv_fault_monitor_t *faults, agv_timers_t *timers,
                            const agv_config_t *config, const agv_vehicle_t *vehicle, bool settled, bool in_park);

#endif

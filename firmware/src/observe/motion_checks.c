#include "observe/motion_checks.h"

void agv_motion_checks_steering_commanded(agv_motion_checks_t *checks, uint32_t angle_raw, bool engaged) {
    checks->command_raw = (uint16_t)angle_raw;
    checks->command_known = engaged;
}

void agv_motion_checks_disengage(agv_motion_checks_t *checks) {
    checks->command_known = false;
}

/* The difference must shrink by steering_gain_ddeg in every steering_deviation_ms; each such gain starts them anew. */
static void check_steering(agv_motion_checks_t *checks, agv_fault_monitor_t *faults, agv_timers_t *timers,
                           const agv_config_t *config, const agv_vehicle_t *vehicle, bool settled) {
    const int32_t signed_ddeg = (int32_t)vehicle->angle_raw - (int32_t)checks->command_raw;
    const int32_t ddeg = (signed_ddeg < 0) ? -signed_ddeg : signed_ddeg;
    const bool known = checks->command_known && vehicle->angle_known;
    const bool off = settled && known && (ddeg > (int32_t)config->steering_deviation_ddeg);
    const bool gained = ddeg <= ((int32_t)checks->steering_off_ddeg - (int32_t)config->steering_gain_ddeg);
    if (gained) {
        agv_timer_stop(timers, AGV_TIMER_STEERING_OFF);
    }
    if (off && (!agv_timer_runs(timers, AGV_TIMER_STEERING_OFF) || (ddeg > (int32_t)checks->steering_off_ddeg))) {
        checks->steering_off_ddeg = (uint16_t)ddeg;
    }
    agv_fault_monitor_set(faults, AGV_FAULT_STEERING_DEVIATION, agv_timer_while(timers, AGV_TIMER_STEERING_OFF, off));
}

void agv_motion_checks_tick(agv_motion_checks_t *checks, agv_fault_monitor_t *faults, agv_timers_t *timers,
                            const agv_config_t *config, const agv_vehicle_t *vehicle, bool settled, bool in_park) {
    check_steering(checks, faults, timers, config, vehicle, settled);
    agv_fault_monitor_set(faults, AGV_FAULT_THROTTLE_IN_PARK,
                          agv_timer_while(timers, AGV_TIMER_THROTTLE_IN_PARK,
                                          settled && (vehicle->throttle > 0u) && in_park));
}

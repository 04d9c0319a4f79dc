/* What programs read of a supervisor; see supervisor.h. */
#include "agv/supervisor.h"

agv_state_t agv_supervisor_state(const agv_supervisor_t *supervisor) {
    return agv_core_state(&supervisor->core);
}

agv_fault_t agv_supervisor_first_reason(const agv_supervisor_t *supervisor) {
    return (agv_fault_t)supervisor->core.machine.first_reason;
}

agv_fault_set_t agv_supervisor_active_faults(const agv_supervisor_t *supervisor) {
    return agv_faults_marked(&supervisor->core.faults, AGV_MARK_ACTIVE);
}

agv_fault_set_t agv_supervisor_active_trips(const agv_supervisor_t *supervisor) {
    return agv_faults_marked(&supervisor->core.faults, AGV_MARK_ACTIVE | AGV_MARK_TRIPPING);
}

bool agv_supervisor_output_closed(const agv_supervisor_t *supervisor) {
    return supervisor->core.machine.output_closed;
}

int8_t agv_supervisor_led_code(const agv_supervisor_t *supervisor) {
    return supervisor->core.led_code;
}

const agv_counters_t *agv_supervisor_counters(const agv_supervisor_t *supervisor) {
    return &supervisor->core.counters;
}

const agv_config_t *agv_supervisor_config(const agv_supervisor_t *supervisor) {
    return &supervisor->core.config;
}

/* The functions with which programs read a supervisor; see supervisor.h. */
#include "supervisor/core.h"

agv_state_t agv_supervisor_state(const agv_supervisor_t *supervisor) {
    return (agv_state_t)agv_core_read(supervisor)->machine.state;
}

agv_fault_t agv_supervisor_first_reason(const agv_supervisor_t *supervisor) {
    return (agv_fault_t)agv_core_read(supervisor)->machine.first_reason;
}

agv_fault_set_t agv_supervisor_active_faults(const agv_supervisor_t *supervisor) {
    return agv_core_read(supervisor)->faults.active;
}

agv_fault_set_t agv_supervisor_active_trips(const agv_supervisor_t *supervisor) {
    return agv_core_read(supervisor)->faults.tripping;
}

agv_fault_t agv_supervisor_first_active(const agv_supervisor_t *supervisor) {
    return (agv_fault_t)agv_fault_first(&agv_core_read(supervisor)->faults.active);
}

bool agv_supervisor_has_fault(const agv_supervisor_t *supervisor, agv_fault_t fault) {
    return agv_fault_monitor_is_active(&agv_core_read(supervisor)->faults, fault);
}

uint32_t agv_supervisor_age_ms(const agv_supervisor_t *supervisor, agv_message_t message) {
    const agv_core_t *const core = agv_core_read(supervisor);
    if ((uint32_t)message >= (uint32_t)AGV_MSG_COUNT) {
        return UINT32_MAX;
    }
    return agv_liveness_age_ms(&core->liveness, &core->timers, message);
}

bool agv_supervisor_is_fresh(const agv_supervisor_t *supervisor, agv_message_t message) {
    const agv_core_t *const core = agv_core_read(supervisor);
    return ((uint32_t)message < (uint32_t)AGV_MSG_COUNT) && agv_liveness_fresh(&core->liveness, &core->timers, message);
}

uint32_t agv_supervisor_tick_ms(const agv_supervisor_t *supervisor) {
    return agv_core_read(supervisor)->last_tick_ms;
}

bool agv_supervisor_output_closed(const agv_supervisor_t *supervisor) {
    return agv_core_read(supervisor)->machine.output_closed;
}

bool agv_supervisor_is_at_standstill(const agv_supervisor_t *supervisor) {
    return agv_vehicle_is_at_standstill(&agv_core_read(supervisor)->timers);
}

int8_t agv_supervisor_led_code(const agv_supervisor_t *supervisor) {
    return agv_core_read(supervisor)->led_code;
}

const agv_counters_t *agv_supervisor_counters(const agv_supervisor_t *supervisor) {
    return &agv_core_read(supervisor)->counters;
}

const agv_config_t *agv_supervisor_config(const agv_supervisor_t *supervisor) {
    return &agv_core_read(supervisor)->config;
}

#include "observe/status_checks.h"

#include "agv/codec.h"

/* The fault of each bit of 363h byte 5; NONE: reserved, or depends on the engagement. */
static const uint8_t alarm_faults[8] = {
    AGV_FAULT_REMOTE_SIGNAL_LOST,     AGV_FAULT_REMOTE_POWER_LOST,     AGV_FAULT_NONE, AGV_FAULT_NONE,
    AGV_FAULT_VCU_EPS_HARDWARE_FAULT, AGV_FAULT_VCU_EPS_CAN_BUS_FAULT, AGV_FAULT_NONE, AGV_FAULT_S_DRIVER_ALARM};

/* The fault of each bit of 167h byte 8; the first ones are scored. */
static const uint8_t eps_faults[8] = {AGV_FAULT_EPS_UNDER_VOLTAGE,     AGV_FAULT_EPS_OVER_VOLTAGE,
                                      AGV_FAULT_EPS_EXCESSIVE_CURRENT, AGV_FAULT_EPS_OVER_CURRENT_SHUTDOWN,
                                      AGV_FAULT_EPS_TEMP_ABOVE_110,    AGV_FAULT_EPS_TEMP_ABOVE_120,
                                      AGV_FAULT_EPS_MOTOR_ENCODER,     AGV_FAULT_EPS_POSITION_ENCODER};

/* The fault of each scored value. */
static const uint8_t value_faults[AGV_SCORED_VALUES] = {
    AGV_FAULT_GEAR_STATUS_INVALID, AGV_FAULT_THROTTLE_STATUS_INVALID, AGV_FAULT_STEERING_ANGLE_INVALID};

void agv_status_checks_vehicle(agv_status_checks_t *checks, agv_fault_monitor_t *faults, const uint8_t data[AGV_DLC],
                               bool ai_alive) {
    const uint32_t alarms = data[4];
    checks->ai_alarm = (alarms & AGV_VCU_ALARM_AI_CAN_LOST) != 0u;
    if (!checks->ai_alarm && ai_alive) {
        checks->ai_alarm_armed = true;
    }
    for (uint32_t bit = 0u; bit < 8u; bit++) {
        agv_fault_monitor_set(faults, alarm_faults[bit], ((alarms >> bit) & 1u) != 0u);
    }
    agv_fault_monitor_set(faults, AGV_FAULT_VCU_LEVEL2_ALARM, data[5] != 0u);
}

/* The last bad mode decides which fault it is. */
static void check_eps_mode(agv_status_checks_t *checks, const agv_config_t *config, uint8_t mode, bool valid) {
    const bool bad = mode != (uint8_t)AGV_EPS_MODE_ANGLE;
    agv_score_add(&checks->eps_mode, bad, config->eps_mode_frames);
    if (mode == (uint8_t)AGV_EPS_MODE_OFF) {
        checks->eps_mode_fault = AGV_FAULT_EPS_MODE_OFF;
    } else if (bad) {
        checks->eps_mode_fault = (uint8_t)(valid ? AGV_FAULT_EPS_MODE_NOT_ANGLE : AGV_FAULT_EPS_MODE_INVALID);
    } else {
        /* keeps its name */
    }
}

void agv_status_checks_eps(agv_status_checks_t *checks, agv_fault_monitor_t *faults, const agv_config_t *config,
                           const uint8_t data[AGV_DLC], bool valid, bool judged) {
    if (judged) {
        check_eps_mode(checks, config, data[3], valid);
    }
    for (uint32_t bit = 0u; bit < 8u; bit++) {
        bool bad = (((uint32_t)data[7] >> bit) & 1u) != 0u;
        if (bit < AGV_SCORED_EPS_BITS) {
            agv_score_add(&checks->eps_bits[bit], bad, config->eps_supply_fault_frames);
            bad = checks->eps_bits[bit].present;
        }
        agv_fault_monitor_set(faults, eps_faults[bit], bad);
    }
}

void agv_status_checks_value(agv_status_checks_t *checks, const agv_config_t *config, uint32_t message, bool valid,
                             bool judged) {
    if (judged) {
        agv_score_add(&checks->values[message - (uint32_t)AGV_MSG_GEAR_STATUS], !valid, config->status_invalid_frames);
    }
    if (message == (uint32_t)AGV_MSG_STEERING_STATUS) {
        agv_score_add(&checks->hold_angle, !valid, config->status_invalid_frames);
    }
}

/* Whether a fault that depends on the engagement may be present. */
static bool has_fault_of_engagement(const agv_status_checks_t *checks) {
    bool present = checks->reported || checks->eps_mode.present || checks->ai_alarm;
    for (uint32_t i = 0u; i < AGV_SCORED_VALUES; i++) {
        present = present || checks->values[i].present;
    }
    return present;
}

void agv_status_checks_evaluate(agv_status_checks_t *checks, agv_fault_monitor_t *faults, bool engaged, bool judged) {
    if (!has_fault_of_engagement(checks)) {
        return;
    }
    const bool ai_alarm = engaged && checks->ai_alarm && checks->ai_alarm_armed;
    for (uint32_t i = 0u; i < AGV_SCORED_VALUES; i++) {
        agv_fault_monitor_set(faults, value_faults[i], judged && checks->values[i].present);
    }
    for (uint32_t fault = AGV_FAULT_EPS_MODE_OFF; fault <= (uint32_t)AGV_FAULT_EPS_MODE_NOT_ANGLE; fault++) {
        agv_fault_monitor_set(faults, fault,
                              judged && checks->eps_mode.present && (checks->eps_mode_fault == (uint8_t)fault));
    }
    agv_fault_monitor_set(faults, AGV_FAULT_VCU_AI_CAN_LOST, ai_alarm);
    checks->reported = false;
    checks->reported = has_fault_of_engagement(checks);
}

void agv_status_checks_engage(agv_status_checks_t *checks) {
    checks->eps_mode = (agv_score_t){0};
    for (uint32_t i = 0u; i < AGV_SCORED_VALUES; i++) {
        checks->values[i] = (agv_score_t){0};
    }
}

bool agv_status_checks_angle_is_usable(const agv_status_checks_t *checks) {
    return !checks->hold_angle.present;
}

#include "observe/status_checks.h"

#include "agv/codec.h"

/* A row that counts goes on counting until a good frame, whatever gaps there are. */
#define COUNTS UINT8_MAX

/* Counts bad frames in a row. Returns whether they are enough. */
static bool in_a_row(agv_status_checks_t *checks, uint32_t row, bool bad, uint32_t needed) {
    uint32_t count = checks->in_a_row[row];
    if (!bad) {
        count = 0u;
    } else if (count != COUNTS) {
        count = checks->after_gap ? 1u : (count + 1u);
        count = (count < needed) ? count : COUNTS;
    } else {
        /* goes on counting */
    }
    checks->in_a_row[row] = (uint8_t)count;
    return count == COUNTS;
}

void agv_status_checks_frame(agv_status_checks_t *checks, uint32_t message, uint32_t gap_ms) {
    checks->after_gap = gap_ms > (2u * agv_message_cycle_ms(message));
}

/* Eight bits, one fault and one row each. Those of the supply of the EPS are counted. */
static void check_bits(agv_status_checks_t *checks, agv_fault_monitor_t *faults, const agv_config_t *config,
                       const uint8_t fault_of[8], uint32_t first_row, uint32_t bits) {
    for (uint32_t bit = 0u; bit < 8u; bit++) {
        const uint32_t row = first_row + bit;
        const uint32_t needed = (row <= (uint32_t)AGV_ROW_EPS_SUPPLY_LAST) ? config->eps_supply_fault_frames : 1u;
        agv_fault_monitor_set(faults, fault_of[bit], in_a_row(checks, row, ((bits >> bit) & 1u) != 0u, needed));
    }
}

/* Bit 3 counts while engaged, after it was once clear with the AI alive (SUP-8). */
static bool ai_alarm_counts(agv_status_checks_t *checks, const agv_status_facts_t *facts, bool alarm) {
    if (!alarm && facts->ai_alive) {
        checks->ai_alarm_armed = true;
    }
    return checks->ai_alarm_armed && facts->engaged;
}

void agv_status_checks_vehicle(agv_status_checks_t *checks, agv_fault_monitor_t *faults,
                               const agv_status_facts_t *facts, const uint8_t data[AGV_DLC]) {
    /* By bit of 363h byte 5. */
    static const uint8_t fault_of[8] = {
        AGV_FAULT_REMOTE_SIGNAL_LOST,     AGV_FAULT_REMOTE_POWER_LOST,     AGV_FAULT_NONE, AGV_FAULT_VCU_AI_CAN_LOST,
        AGV_FAULT_VCU_EPS_HARDWARE_FAULT, AGV_FAULT_VCU_EPS_CAN_BUS_FAULT, AGV_FAULT_NONE, AGV_FAULT_S_DRIVER_ALARM};
    uint32_t alarms = data[4];
    if (!ai_alarm_counts(checks, facts, (alarms & AGV_VCU_ALARM_AI_CAN_LOST) != 0u)) {
        alarms &= ~AGV_VCU_ALARM_AI_CAN_LOST;
    }
    check_bits(checks, faults, facts->config, fault_of, AGV_ROW_VCU_ALARMS, alarms);
    agv_fault_monitor_set(faults, AGV_FAULT_VCU_LEVEL2_ALARM, data[5] != 0u);
}

/* Named after the last of the frames that count. */
static void check_eps_mode(agv_status_checks_t *checks, agv_fault_monitor_t *faults, const agv_status_facts_t *facts,
                           uint8_t mode, bool valid) {
    const bool bad = (mode != (uint8_t)AGV_EPS_MODE_ANGLE) && facts->settled;
    uint32_t named = valid ? AGV_FAULT_EPS_MODE_NOT_ANGLE : AGV_FAULT_EPS_MODE_INVALID;
    if (mode == (uint8_t)AGV_EPS_MODE_OFF) {
        named = AGV_FAULT_EPS_MODE_OFF;
    }
    if (!in_a_row(checks, AGV_ROW_EPS_MODE, bad, facts->config->eps_mode_frames)) {
        named = AGV_FAULT_NONE;
    }
    for (uint32_t fault = AGV_FAULT_EPS_MODE_OFF; fault <= (uint32_t)AGV_FAULT_EPS_MODE_NOT_ANGLE; fault++) {
        agv_fault_monitor_set(faults, fault, fault == named);
    }
}

void agv_status_checks_eps(agv_status_checks_t *checks, agv_fault_monitor_t *faults, const agv_status_facts_t *facts,
                           const uint8_t data[AGV_DLC], bool valid) {
    /* By bit of 167h byte 8; the first three are those of the supply. */
    static const uint8_t fault_of[8] = {AGV_FAULT_EPS_UNDER_VOLTAGE,     AGV_FAULT_EPS_OVER_VOLTAGE,
                                        AGV_FAULT_EPS_EXCESSIVE_CURRENT, AGV_FAULT_EPS_OVER_CURRENT_SHUTDOWN,
                                        AGV_FAULT_EPS_TEMP_ABOVE_110,    AGV_FAULT_EPS_TEMP_ABOVE_120,
                                        AGV_FAULT_EPS_MOTOR_ENCODER,     AGV_FAULT_EPS_POSITION_ENCODER};
    check_eps_mode(checks, faults, facts, data[3], valid);
    check_bits(checks, faults, facts->config, fault_of, AGV_ROW_EPS_FAULTS, data[7]);
}

void agv_status_checks_value(agv_status_checks_t *checks, agv_fault_monitor_t *faults, const agv_status_facts_t *facts,
                             uint32_t message, bool valid) {
    const uint32_t which = message - (uint32_t)AGV_MSG_GEAR_STATUS;
    agv_fault_monitor_set(faults, (uint32_t)AGV_FAULT_GEAR_STATUS_INVALID + which,
                          in_a_row(checks, (uint32_t)AGV_ROW_GEAR_STATUS + which, !valid && facts->settled,
                                   facts->config->status_invalid_frames));
}

void agv_status_checks_rate(agv_status_checks_t *checks, agv_fault_monitor_t *faults, agv_timers_t *timers,
                            const agv_config_t *config, uint32_t command, uint32_t gap_ms) {
    const bool fast = gap_ms < ((agv_message_cycle_ms(command) + 1u) / 2u);
    if (in_a_row(checks, (uint32_t)AGV_ROW_FAST_GAPS + command, fast, config->command_too_fast_gaps)) {
        agv_fault_monitor_event(faults, timers, AGV_FAULT_COMMAND_TOO_FAST);
    }
}

void agv_status_checks_disengage(agv_status_checks_t *checks, agv_fault_monitor_t *faults) {
    for (uint32_t fault = AGV_FAULT_EPS_MODE_OFF; fault <= (uint32_t)AGV_FAULT_STEERING_ANGLE_INVALID; fault++) {
        agv_fault_monitor_set(faults, fault, false);
    }
    agv_fault_monitor_set(faults, AGV_FAULT_VCU_AI_CAN_LOST, false);
    for (uint32_t row = AGV_ROW_EPS_MODE; row <= (uint32_t)AGV_ROW_STEERING_ANGLE; row++) {
        checks->in_a_row[row] = 0u;
    }
}

void agv_status_checks_forget_ai(agv_status_checks_t *checks) {
    checks->ai_alarm_armed = false;
}

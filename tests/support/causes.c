#include "causes.h"

const fault_row_t FAULT_ROW[FAULT_ROWS] = {
    {"SELF_TEST_FAILED", true, 0},
    {"MEMORY_CORRUPTED", true, 0},
    {"CONFIG_INVALID", true, 0},
    {"OUTPUT_FEEDBACK", true, 0},
    {"SUPERVISOR_RESET", true, 0},
    {"EMERGENCY_STOP", true, 0},
    {"TX_GATE_REFUSED", true, 0},
    {"STEP_OVERRUN", true, 0},
    {"CLOCK_DEVIATION", true, 0},
    {"BUS_OFF", true, 14},
    {"TX_STALLED", true, 14},
    {"VCU_HEARTBEAT_LOST", true, 0},
    {"VCU_HEARTBEAT_STUCK", true, 0},
    {"EPS_HEARTBEAT_LOST", true, 12},
    {"EPS_HEARTBEAT_STUCK", true, 12},
    {"AI_HEARTBEAT_LOST", true, 14},
    {"AI_HEARTBEAT_STUCK", true, 14},
    {"EPS_OVER_CURRENT_SHUTDOWN", true, 13},
    {"EPS_TEMP_ABOVE_120", true, 13},
    {"EPS_MOTOR_ENCODER", true, 13},
    {"EPS_POSITION_ENCODER", true, 13},
    {"EPS_UNDER_VOLTAGE", true, 13},
    {"EPS_OVER_VOLTAGE", true, 13},
    {"EPS_EXCESSIVE_CURRENT", true, 13},
    {"EPS_TEMP_ABOVE_110", false, 13},
    {"VCU_EPS_HARDWARE_FAULT", true, 13},
    {"VCU_EPS_CAN_BUS_FAULT", true, 12},
    {"S_DRIVER_ALARM", true, 8},
    {"REMOTE_SIGNAL_LOST", true, 17},
    {"REMOTE_POWER_LOST", true, 16},
    {"VCU_AI_CAN_LOST", true, 14},
    {"VCU_LEVEL2_ALARM", false, 0},
    {"MODE_INVALID", true, 0},
    {"MODE_FLAPPING", true, 0},
    {"MODE_NONE", true, 0},
    {"EPS_STATUS_TIMEOUT", true, 12},
    {"GEAR_STATUS_TIMEOUT", true, 8},
    {"THROTTLE_STATUS_TIMEOUT", true, 7},
    {"WHEEL_SPEED_TIMEOUT", true, 8},
    {"STEERING_POSITION_TIMEOUT", false, 12},
    {"GEAR_COMMAND_TIMEOUT", true, 14},
    {"THROTTLE_COMMAND_TIMEOUT", true, 14},
    {"STEERING_COMMAND_TIMEOUT", true, 14},
    {"AI_COMMAND_OUT_OF_RANGE", true, 14},
    {"EPS_MODE_OFF", true, 13},
    {"EPS_MODE_INVALID", true, 13},
    {"EPS_MODE_NOT_ANGLE", true, 13},
    {"GEAR_STATUS_INVALID", true, 8},
    {"THROTTLE_STATUS_INVALID", true, 7},
    {"STEERING_ANGLE_INVALID", true, 13},
    {"STEERING_DEVIATION", true, 13},
    {"THROTTLE_DEVIATION", true, 7},
    {"GEAR_DEVIATION", true, 8},
    {"AUTOPILOT_OFF_IGNORED", true, 0},
    {"THROTTLE_IN_PARK", true, 7},
    {"FOREIGN_COMMAND_SENDER", true, 14},
    {"SAFE_STATE_UNCONFIRMED", true, 0},
    {"VEHICLE_NOT_STOPPING", true, 0},
    {"MOVING_WHILE_SAFE", true, 0},
    {"COMMAND_TOO_FAST", false, 14},
    {"SPEED_IMPLAUSIBLE", false, 8},
    {"STATUS_ID_IN_USE", false, 0},
    {"STARTUP_TIMEOUT", false, 0},
    {"RX_OVERRUN", false, 14},
    {"ERROR_PASSIVE", false, 14},
    {"AI_BUS_OFF", false, 14},
    {"WRONG_ID_SET", false, 0},
    {"STORE_INVALID", false, 0},
};

const cause_t CAUSE[CAUSES] = {
    {AGV_FAULT_VCU_HEARTBEAT_LOST, BY_SILENCE, M_VEHICLE, 50, 0, 0, true},
    {AGV_FAULT_VCU_HEARTBEAT_STUCK, BY_FREEZE, M_VEHICLE, 50, 0, 0, true},
    {AGV_FAULT_EPS_HEARTBEAT_LOST, BY_SILENCE, M_STEERING_STATUS, 50, 0, 0, false},
    {AGV_FAULT_EPS_HEARTBEAT_STUCK, BY_FREEZE, M_STEERING_STATUS, 50, 0, 0, false},
    {AGV_FAULT_AI_HEARTBEAT_LOST, BY_SILENCE_ENGAGED, M_SIGNALS, 350, 0, 0, true},
    {AGV_FAULT_EPS_OVER_CURRENT_SHUTDOWN, BY_BITS, M_EPS_STATUS, 1, 8, 0x08, false},
    {AGV_FAULT_EPS_TEMP_ABOVE_120, BY_BITS, M_EPS_STATUS, 1, 8, 0x20, false},
    {AGV_FAULT_EPS_MOTOR_ENCODER, BY_BITS, M_EPS_STATUS, 1, 8, 0x40, false},
    {AGV_FAULT_EPS_POSITION_ENCODER, BY_BITS, M_EPS_STATUS, 1, 8, 0x80, false},
    {AGV_FAULT_EPS_UNDER_VOLTAGE, BY_BITS, M_EPS_STATUS, 3, 8, 0x01, false},
    {AGV_FAULT_EPS_OVER_VOLTAGE, BY_BITS, M_EPS_STATUS, 3, 8, 0x02, false},
    {AGV_FAULT_EPS_EXCESSIVE_CURRENT, BY_BITS, M_EPS_STATUS, 3, 8, 0x04, false},
    {AGV_FAULT_EPS_TEMP_ABOVE_110, BY_BITS, M_EPS_STATUS, 1, 8, 0x10, true},
    {AGV_FAULT_VCU_EPS_HARDWARE_FAULT, BY_BITS, M_VEHICLE, 1, 5, 0x10, false},
    {AGV_FAULT_VCU_EPS_CAN_BUS_FAULT, BY_BITS, M_VEHICLE, 1, 5, 0x20, false},
    {AGV_FAULT_S_DRIVER_ALARM, BY_BITS, M_VEHICLE, 1, 5, 0x80, true},
    {AGV_FAULT_REMOTE_SIGNAL_LOST, BY_BITS, M_VEHICLE, 1, 5, 0x01, true},
    {AGV_FAULT_REMOTE_POWER_LOST, BY_BITS, M_VEHICLE, 1, 5, 0x02, true},
    {AGV_FAULT_VCU_AI_CAN_LOST, BY_BITS_ENGAGED, M_VEHICLE, 1, 5, 0x08, true},
    {AGV_FAULT_VCU_LEVEL2_ALARM, BY_BITS, M_VEHICLE, 1, 6, 0x01, true},
    {AGV_FAULT_VCU_LEVEL2_ALARM, BY_BITS, M_VEHICLE, 1, 6, 0x80, true},
    {AGV_FAULT_VCU_LEVEL2_ALARM, BY_BITS, M_VEHICLE, 1, 6, 0xFF, true},
    {AGV_FAULT_EPS_STATUS_TIMEOUT, BY_SILENCE, M_EPS_STATUS, 60, 0, 0, false},
    {AGV_FAULT_GEAR_STATUS_TIMEOUT, BY_SILENCE, M_GEAR_STATUS, 125, 0, 0, true},
    {AGV_FAULT_THROTTLE_STATUS_TIMEOUT, BY_SILENCE, M_THROTTLE_STATUS, 60, 0, 0, true},
    {AGV_FAULT_WHEEL_SPEED_TIMEOUT, BY_SILENCE, M_WHEELS, 60, 0, 0, true},
    {AGV_FAULT_STEERING_POSITION_TIMEOUT, BY_SILENCE, M_POSITION, 60, 0, 0, true},
    {AGV_FAULT_GEAR_COMMAND_TIMEOUT, BY_SILENCE_ENGAGED, M_GEAR, 350, 0, 0, true},
    {AGV_FAULT_THROTTLE_COMMAND_TIMEOUT, BY_SILENCE_ENGAGED, M_THROTTLE, 350, 0, 0, true},
    {AGV_FAULT_STEERING_COMMAND_TIMEOUT, BY_SILENCE_ENGAGED, M_STEERING, 125, 0, 0, true},
    {AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, BY_VALUE, M_GEAR, 100, 1, 3, true},
    {AGV_FAULT_EPS_MODE_OFF, BY_VALUE, M_EPS_STATUS, 60, 4, 0xFF, false},
    {AGV_FAULT_EPS_MODE_INVALID, BY_VALUE, M_EPS_STATUS, 60, 4, 0x04, false},
    {AGV_FAULT_EPS_MODE_NOT_ANGLE, BY_VALUE, M_EPS_STATUS, 60, 4, 0x02, false},
    {AGV_FAULT_GEAR_STATUS_INVALID, BY_VALUE, M_GEAR_STATUS, 90, 1, 3, true},
    {AGV_FAULT_THROTTLE_STATUS_INVALID, BY_VALUE, M_THROTTLE_STATUS, 40, 1, 251, true},
    {AGV_FAULT_THROTTLE_DEVIATION, BY_VALUE, M_THROTTLE_STATUS, 600, 1, 26, true},
    {AGV_FAULT_AUTOPILOT_OFF_IGNORED, BY_VALUE, M_SIGNALS, 1200, 5, 0xC0, true},
};

void cause_set(traffic_message_t traffic[TRAFFIC_MESSAGES], const cause_t *cause, bool on) {
    traffic_message_t *m = &traffic[cause->message];
    switch (cause->how) {
    case BY_SILENCE:
    case BY_SILENCE_ENGAGED:
        m->muted = on;
        break;
    case BY_FREEZE:
        m->frozen = on;
        break;
    case BY_VALUE:
        m->data[cause->byte - 1u] = on ? cause->bits : TRAFFIC[cause->message].data[cause->byte - 1u];
        break;
    default:
        m->data[cause->byte - 1u] =
            (uint8_t)(on ? m->data[cause->byte - 1u] | cause->bits : m->data[cause->byte - 1u] & ~cause->bits);
        break;
    }
}

#include "campaign/campaign_rows.h"

#include "agv/supervisor.h"
#include "text/units.h"

enum { BITS_PER_BYTE = 8, CONFIRM_LEAD_MS = 2, CLOCKS_COMPARED_MS = 1000 };

/** The longest frames that the wire may take, all in all: all messages twice, two rows of collisions, and some. */
enum { ALLOWED_BITS = 40 * 138 };

#define NONE AGV_MSG_NONE
#define NO_SETTING AGV_SETTING_COUNT
#define NOTHING 0u, 0u, ""
#define BITS_OF_CORE (AGV_SUPERVISOR_MEMORY * (uint32_t)BITS_PER_BYTE)
/* A VCU that reports nothing of the EPS by itself: its alarm would come first. */
#define MUTE_VCU "vcu: set, field: alarms, value: 00h|"

#define ROW(name, kind, message, setting, flags, ...)                                                                  \
    {AGV_FAULT_##name, AGV_FAULT_##name, (kind), (message), (setting), (flags), __VA_ARGS__}
/* The first reason is another fault. */
#define ROW_AFTER(name, first, kind, message, setting, flags, ...)                                                     \
    {AGV_FAULT_##name, AGV_FAULT_##first, (kind), (message), (setting), (flags), __VA_ARGS__}

const campaign_row_t CAMPAIGN_ROWS[] = {
    ROW(SELF_TEST_FAILED, CAMPAIGN_AT_ONCE, NONE, NO_SETTING, CAMPAIGN_START | CAMPAIGN_NO_OUTPUT, 0, 0,
        "self_test: failed\n", ""),
    ROW(MEMORY_CORRUPTED, CAMPAIGN_TICK, NONE, NO_SETTING, 0, 0, BITS_OF_CORE - 1, "", "supervisor: flip_bit, bit: $n"),
    ROW(CONFIG_INVALID, CAMPAIGN_AT_ONCE, NONE, NO_SETTING, CAMPAIGN_START | CAMPAIGN_NO_OUTPUT | CAMPAIGN_SHARED, 0, 0,
        "config_unchecked: true\n", ""),
    ROW(OUTPUT_FEEDBACK, CAMPAIGN_CONTACT, NONE, AGV_SETTING_output_feedback_ms, 0, 0, 0, "board: [output_feedback]\n",
        "board: invert_feedback"),
    ROW(SUPERVISOR_RESET, CAMPAIGN_AT_ONCE, NONE, NO_SETTING, CAMPAIGN_LATER, 0, 300, "",
        "supervisor: restart, cause: watchdog, off_ms: $n/supervisor: restart, cause: brown-out, off_ms: "
        "$n/supervisor: restart, cause: lock-up, off_ms: $n/supervisor: restart, cause: software, off_ms: "
        "$n/supervisor: restart, cause: unknown, off_ms: $n"),
    ROW(EMERGENCY_STOP, CAMPAIGN_TICK, NONE, NO_SETTING, 0, 0, 0, "board: [emergency_stop]\n",
        "board: open_emergency_stop"),
    ROW(STEP_OVERRUN, CAMPAIGN_AT_ONCE, NONE, NO_SETTING, CAMPAIGN_LATER, 102, 400, "hardware_watchdog: none\n",
        "supervisor: hang, for_ms: $n"),
    ROW(CLOCK_DEVIATION, CAMPAIGN_CLOCKS, NONE, NO_SETTING, 0, 60, 900, "board: [second_clock]\n",
        "board: slow_clock, permille: $n/board: fast_clock, permille: $n"),
    ROW(BUS_OFF, CAMPAIGN_TICK, NONE, NO_SETTING, CAMPAIGN_BY_OUTPUT | CAMPAIGN_NO_WIRE, NOTHING,
        "supervisor: bus_off"),
    ROW(TX_STALLED, CAMPAIGN_STALL, AGV_MSG_STEERING_COMMAND, AGV_SETTING_tx_stalled_ms,
        CAMPAIGN_GATEWAY | CAMPAIGN_ENGAGED | CAMPAIGN_BY_OUTPUT | CAMPAIGN_NO_WIRE, NOTHING,
        "supervisor: stall_tx|+1500 supervisor: free_tx"),
    ROW(VCU_HEARTBEAT_LOST, CAMPAIGN_SILENCE, AGV_MSG_VEHICLE_STATUS, AGV_SETTING_vcu_heartbeat_timeout_ms,
        CAMPAIGN_LIES, NOTHING, "vcu: mute, message: vehicle_status"),
    ROW(VCU_HEARTBEAT_STUCK, CAMPAIGN_SILENCE, AGV_MSG_VEHICLE_STATUS, AGV_SETTING_vcu_heartbeat_timeout_ms,
        CAMPAIGN_LIES, NOTHING, "vcu: freeze_counter"),
    ROW(EPS_HEARTBEAT_LOST, CAMPAIGN_SILENCE, AGV_MSG_STEERING_STATUS, AGV_SETTING_eps_heartbeat_timeout_ms, 0, NOTHING,
        "eps: mute, message: steering_status"),
    ROW(EPS_HEARTBEAT_STUCK, CAMPAIGN_SILENCE, AGV_MSG_STEERING_STATUS, AGV_SETTING_eps_heartbeat_timeout_ms, 0,
        NOTHING, "eps: freeze_counter"),
    ROW(AI_HEARTBEAT_LOST, CAMPAIGN_SILENCE, AGV_MSG_TURN_SIGNAL_COMMAND, AGV_SETTING_ai_heartbeat_timeout_ms,
        CAMPAIGN_ENGAGED, NOTHING, "ai: mute, message: turn_signal_command"),
    ROW(AI_HEARTBEAT_STUCK, CAMPAIGN_SILENCE, AGV_MSG_TURN_SIGNAL_COMMAND, AGV_SETTING_ai_heartbeat_timeout_ms,
        CAMPAIGN_ENGAGED, NOTHING, "ai: freeze_counter"),
    ROW(EPS_OVER_CURRENT_SHUTDOWN, CAMPAIGN_FRAMES, AGV_MSG_EPS_STATUS, NO_SETTING, 0, NOTHING,
        MUTE_VCU "eps: set, field: faults, value: 08h"),
    ROW(EPS_TEMP_ABOVE_120, CAMPAIGN_FRAMES, AGV_MSG_EPS_STATUS, NO_SETTING, 0, NOTHING,
        MUTE_VCU "eps: set, field: faults, value: 20h"),
    ROW(EPS_MOTOR_ENCODER, CAMPAIGN_FRAMES, AGV_MSG_EPS_STATUS, NO_SETTING, 0, NOTHING,
        MUTE_VCU "eps: set, field: faults, value: 40h"),
    ROW(EPS_POSITION_ENCODER, CAMPAIGN_FRAMES, AGV_MSG_EPS_STATUS, NO_SETTING, 0, NOTHING,
        MUTE_VCU "eps: set, field: faults, value: 80h"),
    ROW(EPS_UNDER_VOLTAGE, CAMPAIGN_FRAMES, AGV_MSG_EPS_STATUS, AGV_SETTING_eps_supply_fault_frames, 0, NOTHING,
        MUTE_VCU "eps: set, field: faults, value: 01h"),
    ROW(EPS_OVER_VOLTAGE, CAMPAIGN_FRAMES, AGV_MSG_EPS_STATUS, AGV_SETTING_eps_supply_fault_frames, 0, NOTHING,
        MUTE_VCU "eps: set, field: faults, value: 02h"),
    ROW(EPS_EXCESSIVE_CURRENT, CAMPAIGN_FRAMES, AGV_MSG_EPS_STATUS, AGV_SETTING_eps_supply_fault_frames, 0, NOTHING,
        MUTE_VCU "eps: set, field: faults, value: 04h"),
    ROW(EPS_TEMP_ABOVE_110, CAMPAIGN_FRAMES, AGV_MSG_EPS_STATUS, NO_SETTING, CAMPAIGN_AS_TRIP, NOTHING,
        "eps: set, field: faults, value: 10h"),
    ROW(VCU_EPS_HARDWARE_FAULT, CAMPAIGN_FRAMES, AGV_MSG_VEHICLE_STATUS, NO_SETTING, 0, NOTHING,
        "vcu: set, field: alarms, value: 10h"),
    ROW(VCU_EPS_CAN_BUS_FAULT, CAMPAIGN_FRAMES, AGV_MSG_VEHICLE_STATUS, NO_SETTING, 0, NOTHING,
        "vcu: set, field: alarms, value: 20h"),
    ROW(S_DRIVER_ALARM, CAMPAIGN_FRAMES, AGV_MSG_VEHICLE_STATUS, NO_SETTING, 0, NOTHING,
        "vcu: set, field: alarms, value: 80h"),
    ROW(REMOTE_SIGNAL_LOST, CAMPAIGN_FRAMES, AGV_MSG_VEHICLE_STATUS, NO_SETTING, 0, NOTHING,
        "vcu: set, field: alarms, value: 01h"),
    ROW(REMOTE_POWER_LOST, CAMPAIGN_FRAMES, AGV_MSG_VEHICLE_STATUS, NO_SETTING, 0, NOTHING,
        "vcu: set, field: alarms, value: 02h"),
    ROW(VCU_AI_CAN_LOST, CAMPAIGN_FRAMES, AGV_MSG_VEHICLE_STATUS, NO_SETTING, CAMPAIGN_ENGAGED, NOTHING,
        "vcu: set, field: alarms, value: 08h"),
    ROW(VCU_LEVEL2_ALARM, CAMPAIGN_FRAMES, AGV_MSG_VEHICLE_STATUS, NO_SETTING, CAMPAIGN_AS_TRIP, NOTHING,
        "vcu: set, field: level2_alarms, value: 01h"),
    ROW(MODE_INVALID, CAMPAIGN_LASTS, AGV_MSG_VEHICLE_STATUS, AGV_SETTING_mode_invalid_ms, CAMPAIGN_LIES, NOTHING,
        "vcu: set, field: mode_bits, value: 3h"),
    ROW(MODE_FLAPPING, CAMPAIGN_FRAMES, AGV_MSG_VEHICLE_STATUS, NO_SETTING,
        CAMPAIGN_ENGAGED | CAMPAIGN_LATER | CAMPAIGN_AGAIN, 1500, 1500, "",
        "operator: disengage|+300 operator: engage|+600 operator: disengage|+900 operator: engage|+1200 operator: "
        "disengage|+1500 operator: engage"),
    ROW(MODE_NONE, CAMPAIGN_LASTS, AGV_MSG_VEHICLE_STATUS, AGV_SETTING_mode_none_ms, CAMPAIGN_MANUAL | CAMPAIGN_LIES,
        NOTHING, "vcu: set, field: mode_bits, value: 0h"),
    ROW(EPS_STATUS_TIMEOUT, CAMPAIGN_SILENCE, AGV_MSG_EPS_STATUS, AGV_SETTING_eps_status_timeout_ms, 0, NOTHING,
        "eps: mute, message: eps_status"),
    ROW(GEAR_STATUS_TIMEOUT, CAMPAIGN_SILENCE, AGV_MSG_GEAR_STATUS, AGV_SETTING_gear_status_timeout_ms, CAMPAIGN_LIES,
        NOTHING, "vcu: mute, message: gear_status"),
    ROW(THROTTLE_STATUS_TIMEOUT, CAMPAIGN_SILENCE, AGV_MSG_THROTTLE_STATUS, AGV_SETTING_throttle_status_timeout_ms, 0,
        NOTHING, "vcu: mute, message: throttle_status"),
    ROW(WHEEL_SPEED_TIMEOUT, CAMPAIGN_SILENCE, AGV_MSG_WHEEL_SPEED, AGV_SETTING_wheel_speed_timeout_ms, 0, NOTHING,
        "vcu: mute, message: wheel_speed"),
    ROW(STEERING_POSITION_TIMEOUT, CAMPAIGN_SILENCE, AGV_MSG_STEERING_POSITION,
        AGV_SETTING_steering_position_timeout_ms, CAMPAIGN_AS_TRIP, NOTHING, "eps: mute, message: steering_position"),
    ROW(GEAR_COMMAND_TIMEOUT, CAMPAIGN_SILENCE, AGV_MSG_GEAR_COMMAND, AGV_SETTING_gear_command_timeout_ms,
        CAMPAIGN_ENGAGED, NOTHING, "ai: mute, message: gear_command"),
    ROW(THROTTLE_COMMAND_TIMEOUT, CAMPAIGN_SILENCE, AGV_MSG_THROTTLE_COMMAND, AGV_SETTING_throttle_command_timeout_ms,
        CAMPAIGN_ENGAGED, NOTHING, "ai: mute, message: throttle_command"),
    ROW(STEERING_COMMAND_TIMEOUT, CAMPAIGN_SILENCE, AGV_MSG_STEERING_COMMAND, AGV_SETTING_steering_command_timeout_ms,
        CAMPAIGN_ENGAGED, NOTHING, "ai: mute, message: steering_command/ai: stop"),
    ROW(AI_COMMAND_OUT_OF_RANGE, CAMPAIGN_FRAMES, AGV_MSG_GEAR_COMMAND, NO_SETTING, CAMPAIGN_ENGAGED, NOTHING,
        "ai: set, field: gear, value: 03h/ai: set, field: throttle, value: FBh/ai: set, field: angle, value: 4651h"),
    ROW(EPS_MODE_OFF, CAMPAIGN_FRAMES, AGV_MSG_EPS_STATUS, AGV_SETTING_eps_mode_frames, CAMPAIGN_ENGAGED, NOTHING,
        "eps: set, field: mode, value: FFh"),
    ROW(EPS_MODE_INVALID, CAMPAIGN_FRAMES, AGV_MSG_EPS_STATUS, AGV_SETTING_eps_mode_frames, CAMPAIGN_ENGAGED, NOTHING,
        "eps: set, field: mode, value: 07h"),
    ROW(EPS_MODE_NOT_ANGLE, CAMPAIGN_FRAMES, AGV_MSG_EPS_STATUS, AGV_SETTING_eps_mode_frames, CAMPAIGN_ENGAGED, NOTHING,
        "eps: set, field: mode, value: 02h"),
    ROW(GEAR_STATUS_INVALID, CAMPAIGN_FRAMES, AGV_MSG_GEAR_STATUS, AGV_SETTING_status_invalid_frames,
        CAMPAIGN_ENGAGED | CAMPAIGN_LIES, NOTHING, "vcu: set, field: gear, value: 03h"),
    ROW(THROTTLE_STATUS_INVALID, CAMPAIGN_FRAMES, AGV_MSG_THROTTLE_STATUS, AGV_SETTING_status_invalid_frames,
        CAMPAIGN_ENGAGED, NOTHING, "vcu: set, field: throttle, value: FBh"),
    ROW(STEERING_ANGLE_INVALID, CAMPAIGN_FRAMES, AGV_MSG_STEERING_STATUS, AGV_SETTING_status_invalid_frames,
        CAMPAIGN_ENGAGED, NOTHING, "eps: set, field: angle, value: 4651h"),
    ROW(STEERING_DEVIATION, CAMPAIGN_LASTS, AGV_MSG_STEERING_COMMAND, AGV_SETTING_steering_deviation_ms,
        CAMPAIGN_ENGAGED, 90, 300, "", "eps: stick|ai: drive, gear: D, throttle_pct: 20, steer_deg: $n"),
    ROW(THROTTLE_DEVIATION, CAMPAIGN_LASTS, AGV_MSG_THROTTLE_STATUS, AGV_SETTING_throttle_deviation_ms,
        CAMPAIGN_ENGAGED, NOTHING, "vcu: set, field: throttle, value: FAh"),
    ROW(GEAR_DEVIATION, CAMPAIGN_LASTS, AGV_MSG_GEAR_STATUS, AGV_SETTING_gear_deviation_ms,
        CAMPAIGN_ENGAGED | CAMPAIGN_LIES, NOTHING, "vcu: set, field: gear, value: 02h"),
    ROW(AUTOPILOT_OFF_IGNORED, CAMPAIGN_LASTS, AGV_MSG_TURN_SIGNAL_COMMAND, AGV_SETTING_autopilot_off_ms,
        CAMPAIGN_ENGAGED | CAMPAIGN_LIES, NOTHING, "vcu: set, field: mode_bits, value: 2h|ai: ask_autopilot_off"),
    ROW(THROTTLE_IN_PARK, CAMPAIGN_LASTS, AGV_MSG_GEAR_STATUS, AGV_SETTING_throttle_in_park_ms,
        CAMPAIGN_ENGAGED | CAMPAIGN_LIES | CAMPAIGN_IN_GEAR, NOTHING, "vcu: set, field: gear, value: 08h"),
    ROW(FOREIGN_COMMAND_SENDER, CAMPAIGN_FRAME, AGV_MSG_GEAR_COMMAND, NO_SETTING, CAMPAIGN_GATEWAY, NOTHING,
        "bus: send, side: vehicle, message: gear_command, bytes: \"02 00 00 00 00 00 00 00\""),
    ROW_AFTER(SAFE_STATE_UNCONFIRMED, STEERING_COMMAND_TIMEOUT, CAMPAIGN_UNCONFIRMED, AGV_MSG_STEERING_COMMAND,
              AGV_SETTING_confirm_timeout_ms,
              CAMPAIGN_ENGAGED | CAMPAIGN_BY_OUTPUT | CAMPAIGN_LIES | CAMPAIGN_AT_ONCE_P, NOTHING,
              "vcu: set, field: gear, value: 01h|ai: mute, message: steering_command"),
    ROW_AFTER(VEHICLE_NOT_STOPPING, STEERING_COMMAND_TIMEOUT, CAMPAIGN_UNCONFIRMED, AGV_MSG_STEERING_COMMAND,
              AGV_SETTING_stop_timeout_ms, CAMPAIGN_ENGAGED | CAMPAIGN_BY_OUTPUT, NOTHING,
              "vcu: set_bytes, message: wheel_speed, bytes: \"2C 01 00 00 2C 01 00 00\"|ai: mute, message: "
              "steering_command"),
    ROW(COMMAND_TOO_FAST, CAMPAIGN_GAPS, AGV_MSG_GEAR_COMMAND, AGV_SETTING_command_too_fast_gaps, CAMPAIGN_AS_TRIP, 10,
        35, "", "ai: send_every, message: gear_command, every_ms: $n"),
    ROW(SPEED_IMPLAUSIBLE, CAMPAIGN_LASTS, AGV_MSG_WHEEL_SPEED, AGV_SETTING_speed_implausible_ms, CAMPAIGN_AS_TRIP,
        NOTHING, "vcu: set_bytes, message: wheel_speed, bytes: \"B8 0B 00 00 B8 0B 00 00\""),
    ROW(STATUS_ID_IN_USE, CAMPAIGN_TICK, NONE, NO_SETTING, CAMPAIGN_AS_TRIP, NOTHING,
        "bus: deliver, side: vehicle, kind: fd, id: 7F0h, bytes: \"00 00 00 00 00 00 00 00\""),
    ROW(RX_OVERRUN, CAMPAIGN_TICK, NONE, NO_SETTING, CAMPAIGN_AS_TRIP, NOTHING, "supervisor: overrun"),
    ROW(ERROR_PASSIVE, CAMPAIGN_TICK, NONE, NO_SETTING, CAMPAIGN_AS_TRIP | CAMPAIGN_LATE_AI, NOTHING,
        "supervisor: error_passive"),
    ROW(AI_BUS_OFF, CAMPAIGN_TICK, NONE, NO_SETTING, CAMPAIGN_GATEWAY | CAMPAIGN_AS_TRIP, NOTHING,
        "supervisor: bus_off, side: ai"),
    ROW(WRONG_ID_SET, CAMPAIGN_SILENCE, AGV_MSG_TURN_SIGNAL_COMMAND, AGV_SETTING_wrong_id_set_ms,
        CAMPAIGN_MANUAL | CAMPAIGN_AS_TRIP, NOTHING,
        "ai: mute, message: turn_signal_command|bus: send, side: $s, id: $o, bytes: \"00 00 00 00 10 00 00 00\", "
        "every_ms: 100"),
    ROW_AFTER(STORE_INVALID, SUPERVISOR_RESET, CAMPAIGN_AT_ONCE, NONE, NO_SETTING, 0, NOTHING,
              "supervisor: corrupt_latch|supervisor: restart, cause: watchdog"),
};

const size_t CAMPAIGN_ROW_COUNT = sizeof CAMPAIGN_ROWS / sizeof CAMPAIGN_ROWS[0];

const campaign_engagement_t CAMPAIGN_ENGAGEMENTS[] = {
    {AGV_FAULT_AI_HEARTBEAT_LOST, AGV_SETTING_ai_never_seen_timeout_ms, true},
    {AGV_FAULT_GEAR_COMMAND_TIMEOUT, NO_SETTING, false},
    {AGV_FAULT_THROTTLE_COMMAND_TIMEOUT, NO_SETTING, false},
    {AGV_FAULT_STEERING_COMMAND_TIMEOUT, NO_SETTING, false},
    {AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, NO_SETTING, false},
    {AGV_FAULT_EPS_MODE_OFF, AGV_SETTING_engaged_grace_ms, false},
    {AGV_FAULT_EPS_MODE_INVALID, AGV_SETTING_engaged_grace_ms, false},
    {AGV_FAULT_EPS_MODE_NOT_ANGLE, AGV_SETTING_engaged_grace_ms, false},
    {AGV_FAULT_GEAR_STATUS_INVALID, AGV_SETTING_engaged_grace_ms, false},
    {AGV_FAULT_THROTTLE_STATUS_INVALID, AGV_SETTING_engaged_grace_ms, false},
    {AGV_FAULT_STEERING_ANGLE_INVALID, AGV_SETTING_engaged_grace_ms, false},
    {AGV_FAULT_STEERING_DEVIATION, AGV_SETTING_engaged_grace_ms, false},
    {AGV_FAULT_THROTTLE_DEVIATION, AGV_SETTING_engaged_grace_ms, false},
    {AGV_FAULT_AUTOPILOT_OFF_IGNORED, AGV_SETTING_engaged_grace_ms, false},
    {AGV_FAULT_THROTTLE_IN_PARK, AGV_SETTING_engaged_grace_ms, false},
};

const size_t CAMPAIGN_ENGAGEMENT_COUNT = sizeof CAMPAIGN_ENGAGEMENTS / sizeof CAMPAIGN_ENGAGEMENTS[0];

const campaign_engagement_t *campaign_engagement(agv_fault_t fault) {
    for (size_t i = 0; i < CAMPAIGN_ENGAGEMENT_COUNT; i++) {
        if (CAMPAIGN_ENGAGEMENTS[i].fault == fault) {
            return &CAMPAIGN_ENGAGEMENTS[i];
        }
    }
    return NULL;
}

const campaign_row_t *campaign_row(agv_fault_t fault) {
    for (size_t i = 0; i < CAMPAIGN_ROW_COUNT; i++) {
        if (CAMPAIGN_ROWS[i].fault == fault) {
            return &CAMPAIGN_ROWS[i];
        }
    }
    return NULL;
}

/** The value of a setting; 0: none. */
static uint32_t value_of(const agv_config_t *config, uint16_t setting) {
    return (setting == NO_SETTING) ? 0 : agv_config_get(config, setting);
}

uint32_t campaign_decision_ms(const campaign_row_t *row, const agv_config_t *config) {
    const uint32_t cycle_ms = agv_message_cycle_ms(row->message);
    const uint32_t value = value_of(config, row->setting);

    switch (row->kind) {
    case CAMPAIGN_TICK:
        return 1;
    case CAMPAIGN_FRAMES:
        return cycle_ms * ((row->setting != NO_SETTING) ? value : 1);
    case CAMPAIGN_SILENCE:
        return value + 1;
    case CAMPAIGN_LASTS:
        return cycle_ms + value + 2;
    case CAMPAIGN_GAPS:
        return row->highest * (value + 1);
    case CAMPAIGN_STALL:
        return cycle_ms + value + 2;
    case CAMPAIGN_UNCONFIRMED:
        return config->steering_command_timeout_ms + value + CONFIRM_LEAD_MS;
    case CAMPAIGN_CONTACT:
        return value + 1;
    case CAMPAIGN_CLOCKS:
        return 2 * (uint32_t)CLOCKS_COMPARED_MS;
    default:
        return 0;
    }
}

uint32_t campaign_engaged_decision_ms(const campaign_row_t *row, const campaign_engagement_t *engagement,
                                      const agv_config_t *config) {
    const uint32_t known_ms = agv_message_cycle_ms(AGV_MSG_VEHICLE_STATUS) + value_of(config, engagement->wait);
    if (engagement->never_seen) {
        return known_ms + 1;
    }
    return known_ms + campaign_decision_ms(row, config);
}

uint32_t campaign_wire_us(uint32_t bitrate) {
    return (uint32_t)(((uint64_t)ALLOWED_BITS * US_PER_S) / bitrate);
}

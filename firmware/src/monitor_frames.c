#include "agv/codec.h"
#include "agv/core.h"

/* Returns false when the frame is a command with a value out of range. */
typedef bool (*handler_t)(agv_core_t *core, const hal_can_frame_t *frame);

/* Counts bad frames in a row. What is active already stays so until a good frame. */
static bool in_a_row(agv_core_t *core, uint32_t row, bool bad, uint16_t needed, bool is_active) {
    uint8_t *const count = &core->monitor.in_a_row[row];
    if (!bad || core->monitor.after_gap) {
        *count = 0u;
    }
    if (bad && (*count < UINT8_MAX)) {
        (*count)++;
    }
    return bad && (is_active || (*count >= needed));
}

static void judge_row(agv_core_t *core, agv_fault_t fault, uint32_t row, bool bad, uint16_t needed) {
    agv_faults_t *const faults = &core->monitor.faults;
    agv_faults_level(faults, fault, in_a_row(core, row, bad, needed, agv_faults_is_active(faults, fault)));
}

/* A status value that the protocol does not know counts once the engagement has settled (SUP-5). */
static void judge_value(agv_core_t *core, agv_fault_t fault, uint32_t row, bool valid) {
    judge_row(core, fault, row, !valid && agv_monitor_settled(core), core->config.status_invalid_frames);
}

static bool on_turn_signal_command(agv_core_t *core, const hal_can_frame_t *frame) {
    agv_turn_signal_command_t command;
    (void)agv_unpack_turn_signal_command(&command, frame->data);
    agv_liveness_beat(&core->monitor.liveness, AGV_NODE_AI, command.alive_counter, frame->time_ms);
    return true;
}

/* SUP-5: while engaged a command out of range trips; it refreshes no deadline in any case. */
static bool judge_command(agv_core_t *core, agv_message_t message, const hal_can_frame_t *frame, bool valid) {
    if (valid) {
        agv_liveness_refresh(&core->monitor.liveness, message, frame->time_ms);
    } else if (agv_monitor_engaged(core)) {
        agv_faults_event(&core->monitor.faults, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, core->now_ms);
    } else {
        /* dropped */
    }
    return valid;
}

static bool on_gear_command(agv_core_t *core, const hal_can_frame_t *frame) {
    agv_gear_command_t command;
    return judge_command(core, AGV_MSG_GEAR_COMMAND, frame, agv_unpack_gear_command(&command, frame->data));
}

static bool on_throttle_command(agv_core_t *core, const hal_can_frame_t *frame) {
    agv_throttle_command_t command;
    return judge_command(core, AGV_MSG_THROTTLE_COMMAND, frame, agv_unpack_throttle_command(&command, frame->data));
}

static bool on_steering_command(agv_core_t *core, const hal_can_frame_t *frame) {
    agv_steering_command_t command;
    const bool valid = agv_unpack_steering_command(&command, frame->data);
    if (valid && (core->config.topology == (uint16_t)AGV_TOPOLOGY_SHARED)) {
        agv_monitor_steering_commanded(core, command.angle_ddeg);
    }
    return judge_command(core, AGV_MSG_STEERING_COMMAND, frame, valid);
}

static void engage(agv_core_t *core, uint32_t stamp_ms) {
    agv_monitor_t *const monitor = &core->monitor;
    for (uint32_t command = AGV_MSG_GEAR_COMMAND; command < AGV_COMMAND_COUNT; command++) {
        agv_liveness_refresh(&monitor->liveness, (agv_message_t)command, stamp_ms);
    }
    agv_timer_start(&monitor->engaged, core->now_ms);
    monitor->faults.changed = true; /* the class of AI_HEARTBEAT_* */
}

static void update_mode(agv_core_t *core, const agv_vehicle_status_t *status, uint32_t stamp_ms) {
    agv_vehicle_t *const vehicle = &core->monitor.vehicle;
    const bool was_engaged = agv_monitor_engaged(core);
    const bool both = status->manual_mode && status->autopilot_mode;
    agv_timer_while(&vehicle->both_modes, both, core->now_ms);
    if (both) {
        return; /* the mode before stands, until MODE_INVALID */
    }
    if (status->autopilot_mode) {
        vehicle->mode = (uint8_t)AGV_MODE_ENGAGED;
    } else {
        vehicle->mode = (uint8_t)(status->manual_mode ? AGV_MODE_MANUAL : AGV_MODE_NONE);
    }
    if (status->autopilot_mode && !was_engaged) {
        engage(core, stamp_ms);
    } else if (!status->autopilot_mode && was_engaged) {
        agv_monitor_disengage(core);
    } else {
        /* as before */
    }
}

/* Bit 3 counts while engaged, after it was once clear with the AI alive (SUP-8). */
static bool ai_alarm_counts(agv_core_t *core, bool alarm) {
    agv_monitor_t *const monitor = &core->monitor;
    const bool alive = agv_liveness_alive(&monitor->liveness, AGV_NODE_AI);
    monitor->ai_alarm_armed = alive && (monitor->ai_alarm_armed || !alarm);
    return monitor->ai_alarm_armed && agv_monitor_engaged(core);
}

static void judge_vcu_alarms(agv_core_t *core, const agv_vehicle_status_t *status) {
    /* By bit of 363h byte 5. */
    static const uint8_t faults[8] = {
        AGV_FAULT_REMOTE_SIGNAL_LOST,     AGV_FAULT_REMOTE_POWER_LOST,     AGV_FAULT_NONE, AGV_FAULT_VCU_AI_CAN_LOST,
        AGV_FAULT_VCU_EPS_HARDWARE_FAULT, AGV_FAULT_VCU_EPS_CAN_BUS_FAULT, AGV_FAULT_NONE, AGV_FAULT_S_DRIVER_ALARM};
    uint32_t alarms = status->level1_alarms;
    if (!ai_alarm_counts(core, (alarms & AGV_VCU_ALARM_AI_CAN_LOST) != 0u)) {
        alarms &= ~AGV_VCU_ALARM_AI_CAN_LOST;
    }
    for (uint32_t bit = 0u; bit < 8u; bit++) {
        agv_faults_level(&core->monitor.faults, (agv_fault_t)faults[bit], ((alarms >> bit) & 1u) != 0u);
    }
    agv_faults_level(&core->monitor.faults, AGV_FAULT_VCU_LEVEL2_ALARM, status->level2_alarms != 0u);
}

static bool on_vehicle_status(agv_core_t *core, const hal_can_frame_t *frame) {
    agv_vehicle_status_t status;
    (void)agv_unpack_vehicle_status(&status, frame->data);
    agv_liveness_beat(&core->monitor.liveness, AGV_NODE_VCU, status.alive_counter, frame->time_ms);
    update_mode(core, &status, frame->time_ms);
    core->monitor.vehicle.button_pressed = status.button_1;
    judge_vcu_alarms(core, &status);
    return true;
}

static bool on_gear_status(agv_core_t *core, const hal_can_frame_t *frame) {
    agv_gear_status_t status;
    const bool valid = agv_unpack_gear_status(&status, frame->data);
    core->monitor.vehicle.gear = valid ? status.gear : 0u;
    judge_value(core, AGV_FAULT_GEAR_STATUS_INVALID, AGV_ROW_GEAR_STATUS, valid);
    return true;
}

static bool on_throttle_status(agv_core_t *core, const hal_can_frame_t *frame) {
    agv_throttle_status_t status;
    const bool valid = agv_unpack_throttle_status(&status, frame->data);
    core->monitor.vehicle.throttle_on = valid && (status.throttle_permille > 0u);
    judge_value(core, AGV_FAULT_THROTTLE_STATUS_INVALID, AGV_ROW_THROTTLE_STATUS, valid);
    return true;
}

static bool on_steering_status(agv_core_t *core, const hal_can_frame_t *frame) {
    agv_steering_status_t status;
    const bool valid = agv_unpack_steering_status(&status, frame->data);
    if (valid) {
        core->monitor.vehicle.angle_ddeg = (int16_t)status.angle_ddeg;
        core->monitor.vehicle.angle_known = true;
    }
    judge_value(core, AGV_FAULT_STEERING_ANGLE_INVALID, AGV_ROW_STEERING_ANGLE, valid);
    agv_liveness_beat(&core->monitor.liveness, AGV_NODE_EPS, status.alive_counter, frame->time_ms);
    return true;
}

/* Named after the last of the frames that count. */
static void judge_eps_mode(agv_core_t *core, const agv_eps_status_t *status, bool valid) {
    agv_faults_t *const faults = &core->monitor.faults;
    const bool in_angle_mode = status->mode == (uint8_t)AGV_EPS_MODE_ANGLE;
    const bool bad = !in_angle_mode && agv_monitor_settled(core);
    agv_fault_t named = AGV_FAULT_EPS_MODE_NOT_ANGLE;
    if (status->mode == (uint8_t)AGV_EPS_MODE_OFF) {
        named = AGV_FAULT_EPS_MODE_OFF;
    } else if (!valid) {
        named = AGV_FAULT_EPS_MODE_INVALID;
    } else {
        /* a mode that exists, but not the one that steers */
    }
    const bool active = agv_faults_is_active(faults, AGV_FAULT_EPS_MODE_OFF) ||
                        agv_faults_is_active(faults, AGV_FAULT_EPS_MODE_INVALID) ||
                        agv_faults_is_active(faults, AGV_FAULT_EPS_MODE_NOT_ANGLE);
    const bool counts = in_a_row(core, AGV_ROW_EPS_MODE, bad, core->config.eps_mode_frames, active);
    core->monitor.vehicle.eps_in_angle_mode = in_angle_mode;
    for (uint32_t fault = AGV_FAULT_EPS_MODE_OFF; fault <= (uint32_t)AGV_FAULT_EPS_MODE_NOT_ANGLE; fault++) {
        agv_faults_level(faults, (agv_fault_t)fault, counts && (fault == (uint32_t)named));
    }
}

static bool on_eps_status(agv_core_t *core, const hal_can_frame_t *frame) {
    /* By bit of 167h byte 8; the first three are those of the supply. */
    static const uint8_t faults[8] = {AGV_FAULT_EPS_UNDER_VOLTAGE,     AGV_FAULT_EPS_OVER_VOLTAGE,
                                      AGV_FAULT_EPS_EXCESSIVE_CURRENT, AGV_FAULT_EPS_OVER_CURRENT_SHUTDOWN,
                                      AGV_FAULT_EPS_TEMP_ABOVE_110,    AGV_FAULT_EPS_TEMP_ABOVE_120,
                                      AGV_FAULT_EPS_MOTOR_ENCODER,     AGV_FAULT_EPS_POSITION_ENCODER};
    const uint32_t supply_bits = 3u;
    agv_eps_status_t status;
    const bool valid = agv_unpack_eps_status(&status, frame->data);
    judge_eps_mode(core, &status, valid);
    for (uint32_t bit = 0u; bit < 8u; bit++) {
        const uint16_t needed = (bit < supply_bits) ? core->config.eps_supply_fault_frames : 1u;
        judge_row(core, (agv_fault_t)faults[bit], bit, (((uint32_t)status.faults >> bit) & 1u) != 0u, needed);
    }
    return true;
}

static bool on_steering_position(agv_core_t *core, const hal_can_frame_t *frame) {
    (void)core;
    (void)frame;
    return true; /* only its coming counts */
}

static bool is_slow(const agv_core_t *core, int32_t speed_mm_s) {
    const int32_t limit_mm_s = (int32_t)core->config.standstill_speed_mm_s;
    return (speed_mm_s < limit_mm_s) && (speed_mm_s > -limit_mm_s);
}

static bool on_wheel_speed(agv_core_t *core, const hal_can_frame_t *frame) {
    agv_wheel_speed_t wheels;
    (void)agv_unpack_wheel_speed(&wheels, frame->data);
    agv_timer_while(&core->monitor.vehicle.slow, is_slow(core, wheels.left_mm_s) && is_slow(core, wheels.right_mm_s),
                    core->now_ms);
    return true;
}

/* One row a message, in the order of agv_message_t. */
static const handler_t handlers[AGV_MSG_COUNT] = {on_turn_signal_command, on_gear_command,    on_throttle_command,
                                                  on_steering_command,    on_vehicle_status,  on_gear_status,
                                                  on_throttle_status,     on_steering_status, on_eps_status,
                                                  on_steering_position,   on_wheel_speed};

/* Under half a cycle, so many gaps in a row (SUP-6). */
static void judge_rate(agv_core_t *core, agv_message_t command, uint32_t gap_ms, uint32_t cycle_ms) {
    const bool fast = gap_ms < ((cycle_ms + 1u) / 2u);
    if (in_a_row(core, (uint32_t)AGV_ROW_FAST_GAPS + (uint32_t)command, fast, core->config.command_too_fast_gaps,
                 false)) {
        agv_faults_event(&core->monitor.faults, AGV_FAULT_COMMAND_TOO_FAST, core->now_ms);
    }
}

bool agv_monitor_frame(agv_core_t *core, agv_message_t message, const hal_can_frame_t *frame) {
    agv_liveness_t *const liveness = &core->monitor.liveness;
    const uint32_t cycle_ms = agv_message_cycle_ms(message);
    const uint32_t gap_ms = agv_liveness_arrived(liveness, message, frame->time_ms);
    core->monitor.after_gap = gap_ms > (2u * cycle_ms);
    if ((uint32_t)message < AGV_COMMAND_COUNT) {
        judge_rate(core, message, gap_ms, cycle_ms);
    } else {
        agv_liveness_refresh(liveness, message, frame->time_ms);
    }
    return handlers[message](core, frame);
}

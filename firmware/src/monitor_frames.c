#include "agv/codec.h"
#include "agv/core.h"

/* A row that counts goes on counting until a good frame, whatever gaps there are. */
#define COUNTS UINT8_MAX

/* Counts bad frames in a row. Returns whether they are enough. */
static bool in_a_row(agv_core_t *core, uint32_t row, bool bad, uint32_t needed) {
    uint32_t count = core->monitor.in_a_row[row];
    if (!bad) {
        count = 0u;
    } else if (count != COUNTS) {
        count = core->monitor.after_gap ? 1u : (count + 1u);
        count = (count < needed) ? count : COUNTS;
    } else {
        /* goes on counting */
    }
    core->monitor.in_a_row[row] = (uint8_t)count;
    return count == COUNTS;
}

/* Eight bits, one fault and one row each. Those of the supply of the EPS are counted. */
static void judge_bits(agv_core_t *core, const uint8_t faults[8], uint32_t first_row, uint32_t bits) {
    for (uint32_t bit = 0u; bit < 8u; bit++) {
        const uint32_t row = first_row + bit;
        const uint32_t needed = (row <= (uint32_t)AGV_ROW_EPS_SUPPLY_LAST) ? core->config.eps_supply_fault_frames : 1u;
        agv_faults_level(core, faults[bit], in_a_row(core, row, ((bits >> bit) & 1u) != 0u, needed));
    }
}

static void engage(agv_core_t *core, uint32_t stamp_ms) {
    for (uint32_t command = AGV_MSG_GEAR_COMMAND; command < AGV_COMMAND_COUNT; command++) {
        agv_watch_start_at(core, (uint32_t)AGV_WATCH_MESSAGE + command, stamp_ms);
    }
    agv_watch_start_at(core, AGV_WATCH_AI_AWAITED, stamp_ms);
    agv_watch_start(core, AGV_WATCH_ENGAGED);
    core->summary.changed = true; /* the class of AI_HEARTBEAT_* */
}

static void update_mode(agv_core_t *core, uint32_t flags, uint32_t stamp_ms) {
    const uint32_t both = (uint32_t)AGV_MODE_MANUAL | (uint32_t)AGV_MODE_ENGAGED;
    const uint32_t mode = (flags >> 1u) & both;
    const bool was_engaged = agv_core_engaged(core);
    (void)agv_watch_while(core, AGV_WATCH_BOTH_MODES, mode == both);
    if (mode == both) {
        return; /* the mode before stands, until MODE_INVALID */
    }
    core->vehicle.mode = (uint8_t)mode;
    if (agv_core_engaged(core) == was_engaged) {
        return;
    }
    if (was_engaged) {
        agv_monitor_disengage(core);
    } else {
        engage(core, stamp_ms);
    }
}

/* Bit 3 counts while engaged, after it was once clear with the AI alive (SUP-8). */
static bool ai_alarm_counts(agv_core_t *core, bool alarm) {
    agv_monitor_t *const monitor = &core->monitor;
    if (!alarm && agv_core_alive(core, AGV_NODE_AI)) {
        monitor->ai_alarm_armed = true;
    }
    return monitor->ai_alarm_armed && agv_core_engaged(core);
}

static void on_vehicle_status(agv_core_t *core, const hal_can_frame_t *frame) {
    /* By bit of 363h byte 5. */
    static const uint8_t faults[8] = {
        AGV_FAULT_REMOTE_SIGNAL_LOST,     AGV_FAULT_REMOTE_POWER_LOST,     AGV_FAULT_NONE, AGV_FAULT_VCU_AI_CAN_LOST,
        AGV_FAULT_VCU_EPS_HARDWARE_FAULT, AGV_FAULT_VCU_EPS_CAN_BUS_FAULT, AGV_FAULT_NONE, AGV_FAULT_S_DRIVER_ALARM};
    uint32_t alarms = frame->data[4];
    update_mode(core, frame->data[6], frame->time_ms);
    core->vehicle.button =
        (uint8_t)(((frame->data[6] & AGV_VCU_FLAG_BUTTON_1) != 0u) ? AGV_BUTTON_DOWN : AGV_BUTTON_UP);
    if (!ai_alarm_counts(core, (alarms & AGV_VCU_ALARM_AI_CAN_LOST) != 0u)) {
        alarms &= ~AGV_VCU_ALARM_AI_CAN_LOST;
    }
    judge_bits(core, faults, AGV_ROW_VCU_ALARMS, alarms);
    agv_faults_level(core, AGV_FAULT_VCU_LEVEL2_ALARM, frame->data[5] != 0u);
}

static void on_steering_angle(agv_core_t *core, const uint8_t data[AGV_DLC]) {
    core->vehicle.angle_raw = (uint16_t)agv_angle_read(&data[2]);
    core->vehicle.angle_known = true;
}

/* Named after the last of the frames that count. */
static void judge_eps_mode(agv_core_t *core, uint8_t mode, bool valid) {
    const bool in_angle_mode = mode == (uint8_t)AGV_EPS_MODE_ANGLE;
    const bool counts =
        in_a_row(core, AGV_ROW_EPS_MODE, !in_angle_mode && agv_monitor_settled(core), core->config.eps_mode_frames);
    uint32_t named = valid ? AGV_FAULT_EPS_MODE_NOT_ANGLE : AGV_FAULT_EPS_MODE_INVALID;
    if (mode == (uint8_t)AGV_EPS_MODE_OFF) {
        named = AGV_FAULT_EPS_MODE_OFF;
    }
    if (!counts) {
        named = AGV_FAULT_NONE;
    }
    core->vehicle.eps_in_angle_mode = in_angle_mode;
    for (uint32_t fault = AGV_FAULT_EPS_MODE_OFF; fault <= (uint32_t)AGV_FAULT_EPS_MODE_NOT_ANGLE; fault++) {
        agv_faults_level(core, fault, fault == named);
    }
}

static void on_eps_status(agv_core_t *core, const uint8_t data[AGV_DLC], bool valid) {
    /* By bit of 167h byte 8; the first three are those of the supply. */
    static const uint8_t faults[8] = {AGV_FAULT_EPS_UNDER_VOLTAGE,     AGV_FAULT_EPS_OVER_VOLTAGE,
                                      AGV_FAULT_EPS_EXCESSIVE_CURRENT, AGV_FAULT_EPS_OVER_CURRENT_SHUTDOWN,
                                      AGV_FAULT_EPS_TEMP_ABOVE_110,    AGV_FAULT_EPS_TEMP_ABOVE_120,
                                      AGV_FAULT_EPS_MOTOR_ENCODER,     AGV_FAULT_EPS_POSITION_ENCODER};
    judge_eps_mode(core, data[3], valid);
    judge_bits(core, faults, AGV_ROW_EPS_FAULTS, data[7]);
}

static void on_steering_command(agv_core_t *core, const uint8_t data[AGV_DLC], bool valid) {
    if (valid && !agv_core_is_gateway(core)) {
        agv_monitor_steering_commanded(core, agv_angle_read(data));
    }
}

static bool is_slow(const agv_core_t *core, int32_t speed_mm_s) {
    const int32_t limit_mm_s = (int32_t)core->config.standstill_speed_mm_s;
    return (speed_mm_s < limit_mm_s) && (speed_mm_s > -limit_mm_s);
}

static void on_wheel_speed(agv_core_t *core, const uint8_t data[AGV_DLC]) {
    agv_wheel_speed_t wheels;
    (void)agv_unpack_wheel_speed(&wheels, data);
    (void)agv_watch_while(core, AGV_WATCH_STANDSTILL,
                          is_slow(core, wheels.left_mm_s) && is_slow(core, wheels.right_mm_s));
}

/* A gear, throttle or angle that the protocol does not know counts once the engagement has settled (SUP-5). */
static void on_value(agv_core_t *core, uint32_t message, const uint8_t data[AGV_DLC], bool valid) {
    const uint32_t which = message - (uint32_t)AGV_MSG_GEAR_STATUS;
    if (message == (uint32_t)AGV_MSG_GEAR_STATUS) {
        core->vehicle.gear = valid ? data[0] : 0u;
    } else if (!valid) {
        /* the throttle or angle before stands */
    } else if (message == (uint32_t)AGV_MSG_THROTTLE_STATUS) {
        core->vehicle.throttle = data[0];
    } else {
        on_steering_angle(core, data);
    }
    agv_faults_level(core, (uint32_t)AGV_FAULT_GEAR_STATUS_INVALID + which,
                     in_a_row(core, (uint32_t)AGV_ROW_GEAR_STATUS + which, !valid && agv_monitor_settled(core),
                              core->config.status_invalid_frames));
}

/* Of 43Fh, 168h, 075h and 267h nothing more counts than their coming. */
static void judge_content(agv_core_t *core, uint32_t message, const hal_can_frame_t *frame, bool valid) {
    switch (message) {
    case AGV_MSG_STEERING_COMMAND:
        on_steering_command(core, frame->data, valid);
        break;
    case AGV_MSG_VEHICLE_STATUS:
        on_vehicle_status(core, frame);
        break;
    case AGV_MSG_GEAR_STATUS:
    case AGV_MSG_THROTTLE_STATUS:
    case AGV_MSG_STEERING_STATUS:
        on_value(core, message, frame->data, valid);
        break;
    case AGV_MSG_EPS_STATUS:
        on_eps_status(core, frame->data, valid);
        break;
    case AGV_MSG_WHEEL_SPEED:
        on_wheel_speed(core, frame->data);
        break;
    default:
        break;
    }
}

/* Under half a cycle, so many gaps in a row (SUP-6). */
static void judge_rate(agv_core_t *core, uint32_t command, uint32_t gap_ms, uint32_t cycle_ms) {
    const bool fast = gap_ms < ((cycle_ms + 1u) / 2u);
    if (in_a_row(core, (uint32_t)AGV_ROW_FAST_GAPS + command, fast, core->config.command_too_fast_gaps)) {
        agv_faults_event(core, AGV_FAULT_COMMAND_TOO_FAST);
    }
}

bool agv_monitor_frame(agv_core_t *core, uint32_t message, const hal_can_frame_t *frame) {
    const bool command = message < AGV_COMMAND_COUNT;
    const uint32_t cycle_ms = agv_message_cycle_ms(message);
    const uint32_t gap_ms = agv_liveness_arrived(core, message, frame->time_ms);
    const bool valid = agv_value_is_valid(message, frame->data);
    const bool usable = valid || !command;
    core->monitor.after_gap = gap_ms > (2u * cycle_ms);
    if (command) {
        judge_rate(core, message, gap_ms, cycle_ms);
    }
    if (usable) {
        agv_liveness_refresh(core, message, frame);
    } else if (agv_core_engaged(core)) {
        agv_faults_event(core, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE); /* SUP-5 */
    } else {
        /* dropped */
    }
    judge_content(core, message, frame, valid);
    return usable;
}

#include "agv/codec.h"
#include "agv/monitor.h"

#define BIT(name) agv_fault_bit(AGV_FAULT_##name)
#define WHEN(condition, name) agv_fault_when((condition), AGV_FAULT_##name)

typedef bool (*handler_t)(agv_monitor_t *monitor, const agv_config_t *config, const agv_monitor_frame_t *frame);

/* Counts bad frames in a row. A fault that is active stays so until a good frame. */
static bool bad_in_a_row(uint8_t *count, bool bad, const agv_monitor_frame_t *frame, uint16_t needed, bool is_active) {
    if (!bad) {
        *count = 0u;
        return false;
    }
    if (frame->after_gap) {
        *count = 0u;
    }
    if (*count < UINT8_MAX) {
        (*count)++;
    }
    return is_active || (*count >= needed);
}

static bool is_active(const agv_monitor_t *monitor, agv_fault_set_t set) {
    return (monitor->faults.active & set) != 0u;
}

static bool is_engaged(const agv_monitor_t *monitor) {
    return monitor->vehicle.mode == (uint8_t)AGV_MODE_ENGAGED;
}

static bool out_of_range(agv_monitor_t *monitor, const agv_monitor_frame_t *frame) {
    if (is_engaged(monitor)) {
        agv_faults_event(&monitor->faults, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, frame->now_ms);
    }
    return false;
}

static bool on_turn_signal_command(agv_monitor_t *monitor, const agv_config_t *config,
                                   const agv_monitor_frame_t *frame) {
    agv_turn_signal_command_t command;
    (void)config;
    (void)agv_unpack_turn_signal_command(&command, frame->data);
    agv_liveness_beat(&monitor->liveness, AGV_NODE_AI, command.alive_counter, frame->stamp_ms);
    return true;
}

static bool on_gear_command(agv_monitor_t *monitor, const agv_config_t *config, const agv_monitor_frame_t *frame) {
    agv_gear_command_t command;
    (void)config;
    if (!agv_unpack_gear_command(&command, frame->data)) {
        return out_of_range(monitor, frame);
    }
    agv_liveness_refresh(&monitor->liveness, AGV_MSG_GEAR_COMMAND, frame->stamp_ms);
    return true;
}

static bool on_throttle_command(agv_monitor_t *monitor, const agv_config_t *config, const agv_monitor_frame_t *frame) {
    agv_throttle_command_t command;
    (void)config;
    if (!agv_unpack_throttle_command(&command, frame->data)) {
        return out_of_range(monitor, frame);
    }
    agv_liveness_refresh(&monitor->liveness, AGV_MSG_THROTTLE_COMMAND, frame->stamp_ms);
    return true;
}

static bool on_steering_command(agv_monitor_t *monitor, const agv_config_t *config, const agv_monitor_frame_t *frame) {
    agv_steering_command_t command;
    if (!agv_unpack_steering_command(&command, frame->data)) {
        return out_of_range(monitor, frame);
    }
    agv_liveness_refresh(&monitor->liveness, AGV_MSG_STEERING_COMMAND, frame->stamp_ms);
    if (is_engaged(monitor) && (config->topology == (uint16_t)AGV_TOPOLOGY_SHARED)) {
        agv_monitor_steering_sent(monitor, (int16_t)command.angle_ddeg);
    }
    return true;
}

static void engage(agv_monitor_t *monitor, const agv_monitor_frame_t *frame) {
    static const agv_message_t commands[] = {AGV_MSG_GEAR_COMMAND, AGV_MSG_THROTTLE_COMMAND, AGV_MSG_STEERING_COMMAND};
    for (uint32_t i = 0u; i < (sizeof commands / sizeof commands[0]); i++) {
        agv_liveness_refresh(&monitor->liveness, commands[i], frame->stamp_ms);
    }
    agv_timer_start(&monitor->engaged, frame->now_ms);
    monitor->vehicle.command_known = false;
    monitor->in_a_row.eps_mode = 0u;
    monitor->in_a_row.gear_status = 0u;
    monitor->in_a_row.throttle_status = 0u;
    monitor->in_a_row.steering_angle = 0u;
}

static void disengage(agv_monitor_t *monitor) {
    static const uint32_t none = 0u;
    agv_faults_levels(&monitor->faults,
                      BIT(EPS_MODE_OFF) | BIT(EPS_MODE_INVALID) | BIT(EPS_MODE_NOT_ANGLE) | BIT(GEAR_STATUS_INVALID) |
                          BIT(THROTTLE_STATUS_INVALID) | BIT(STEERING_ANGLE_INVALID) | BIT(VCU_AI_CAN_LOST),
                      none);
    agv_timer_stop(&monitor->engaged);
}

static void update_mode(agv_monitor_t *monitor, const agv_vehicle_status_t *status, const agv_monitor_frame_t *frame) {
    agv_vehicle_t *vehicle = &monitor->vehicle;
    const bool was_engaged = is_engaged(monitor);
    const bool both = status->manual_mode && status->autopilot_mode;
    agv_timer_while(&vehicle->both_modes, both, frame->now_ms);
    if (!both) {
        vehicle->mode = (uint8_t)AGV_MODE_NONE;
        if (status->autopilot_mode) {
            vehicle->mode = (uint8_t)AGV_MODE_ENGAGED;
        } else if (status->manual_mode) {
            vehicle->mode = (uint8_t)AGV_MODE_MANUAL;
        } else {
            /* neither is reported */
        }
    }
    if (is_engaged(monitor) && !was_engaged) {
        engage(monitor, frame);
    }
    if (!is_engaged(monitor) && was_engaged) {
        disengage(monitor);
    }
}

static void judge_vcu_alarms(agv_monitor_t *monitor, const agv_vehicle_status_t *status) {
    const uint8_t alarms = status->level1_alarms;
    const bool ai_alarm = (alarms & AGV_VCU_ALARM_AI_CAN_LOST) != 0u;
    if (!agv_monitor_alive(monitor, AGV_NODE_AI)) {
        monitor->ai_alarm_armed = false;
    } else if (!ai_alarm) {
        monitor->ai_alarm_armed = true;
    } else {
        /* as it was */
    }
    agv_faults_levels(&monitor->faults,
                      BIT(REMOTE_SIGNAL_LOST) | BIT(REMOTE_POWER_LOST) | BIT(VCU_AI_CAN_LOST) |
                          BIT(VCU_EPS_HARDWARE_FAULT) | BIT(VCU_EPS_CAN_BUS_FAULT) | BIT(S_DRIVER_ALARM) |
                          BIT(VCU_LEVEL2_ALARM),
                      WHEN((alarms & AGV_VCU_ALARM_REMOTE_SIGNAL_LOST) != 0u, REMOTE_SIGNAL_LOST) |
                          WHEN((alarms & AGV_VCU_ALARM_REMOTE_POWER_LOST) != 0u, REMOTE_POWER_LOST) |
                          WHEN(ai_alarm && monitor->ai_alarm_armed && is_engaged(monitor), VCU_AI_CAN_LOST) |
                          WHEN((alarms & AGV_VCU_ALARM_EPS_HARDWARE) != 0u, VCU_EPS_HARDWARE_FAULT) |
                          WHEN((alarms & AGV_VCU_ALARM_EPS_CAN_BUS) != 0u, VCU_EPS_CAN_BUS_FAULT) |
                          WHEN((alarms & AGV_VCU_ALARM_S_DRIVER) != 0u, S_DRIVER_ALARM) |
                          WHEN(status->level2_alarms != 0u, VCU_LEVEL2_ALARM));
}

static bool on_vehicle_status(agv_monitor_t *monitor, const agv_config_t *config, const agv_monitor_frame_t *frame) {
    agv_vehicle_status_t status;
    (void)config;
    (void)agv_unpack_vehicle_status(&status, frame->data);
    agv_liveness_beat(&monitor->liveness, AGV_NODE_VCU, status.alive_counter, frame->stamp_ms);
    update_mode(monitor, &status, frame);
    monitor->vehicle.button_pressed = status.button_1;
    judge_vcu_alarms(monitor, &status);
    return true;
}

static bool on_gear_status(agv_monitor_t *monitor, const agv_config_t *config, const agv_monitor_frame_t *frame) {
    agv_gear_status_t status;
    const bool valid = agv_unpack_gear_status(&status, frame->data);
    const bool bad = !valid && agv_monitor_settled(monitor, config, frame->now_ms);
    monitor->vehicle.gear = valid ? status.gear : 0u;
    agv_faults_levels(&monitor->faults, BIT(GEAR_STATUS_INVALID),
                      WHEN(bad_in_a_row(&monitor->in_a_row.gear_status, bad, frame, config->status_invalid_frames,
                                        is_active(monitor, BIT(GEAR_STATUS_INVALID))),
                           GEAR_STATUS_INVALID));
    agv_liveness_refresh(&monitor->liveness, AGV_MSG_GEAR_STATUS, frame->stamp_ms);
    return true;
}

static bool on_throttle_status(agv_monitor_t *monitor, const agv_config_t *config, const agv_monitor_frame_t *frame) {
    agv_throttle_status_t status;
    const bool valid = agv_unpack_throttle_status(&status, frame->data);
    const bool bad = !valid && agv_monitor_settled(monitor, config, frame->now_ms);
    monitor->vehicle.throttle_on = valid && (status.throttle_permille > 0u);
    agv_faults_levels(&monitor->faults, BIT(THROTTLE_STATUS_INVALID),
                      WHEN(bad_in_a_row(&monitor->in_a_row.throttle_status, bad, frame, config->status_invalid_frames,
                                        is_active(monitor, BIT(THROTTLE_STATUS_INVALID))),
                           THROTTLE_STATUS_INVALID));
    agv_liveness_refresh(&monitor->liveness, AGV_MSG_THROTTLE_STATUS, frame->stamp_ms);
    return true;
}

static bool on_steering_status(agv_monitor_t *monitor, const agv_config_t *config, const agv_monitor_frame_t *frame) {
    agv_steering_status_t status;
    const bool valid = agv_unpack_steering_status(&status, frame->data);
    const bool bad = !valid && agv_monitor_settled(monitor, config, frame->now_ms);
    if (valid) {
        monitor->vehicle.angle_ddeg = (int16_t)status.angle_ddeg;
        monitor->vehicle.angle_known = true;
    }
    agv_faults_levels(&monitor->faults, BIT(STEERING_ANGLE_INVALID),
                      WHEN(bad_in_a_row(&monitor->in_a_row.steering_angle, bad, frame, config->status_invalid_frames,
                                        is_active(monitor, BIT(STEERING_ANGLE_INVALID))),
                           STEERING_ANGLE_INVALID));
    agv_liveness_beat(&monitor->liveness, AGV_NODE_EPS, status.alive_counter, frame->stamp_ms);
    return true;
}

static agv_fault_t mode_fault(uint8_t mode, bool valid) {
    if (!valid) {
        return AGV_FAULT_EPS_MODE_INVALID;
    }
    return (mode == (uint8_t)AGV_EPS_MODE_OFF) ? AGV_FAULT_EPS_MODE_OFF : AGV_FAULT_EPS_MODE_NOT_ANGLE;
}

static void judge_eps_mode(agv_monitor_t *monitor, const agv_config_t *config, const agv_eps_status_t *status,
                           bool valid, const agv_monitor_frame_t *frame) {
    const agv_fault_set_t any = BIT(EPS_MODE_OFF) | BIT(EPS_MODE_INVALID) | BIT(EPS_MODE_NOT_ANGLE);
    const bool in_angle_mode = status->mode == (uint8_t)AGV_EPS_MODE_ANGLE;
    const bool bad = !in_angle_mode && agv_monitor_settled(monitor, config, frame->now_ms);
    const bool counts =
        bad_in_a_row(&monitor->in_a_row.eps_mode, bad, frame, config->eps_mode_frames, is_active(monitor, any));
    monitor->vehicle.eps_in_angle_mode = in_angle_mode;
    agv_faults_levels(&monitor->faults, any, agv_fault_when(counts, mode_fault(status->mode, valid)));
}

static void judge_eps_faults(agv_monitor_t *monitor, const agv_config_t *config, uint8_t bits,
                             const agv_monitor_frame_t *frame) {
    agv_in_a_row_t *row = &monitor->in_a_row;
    const uint16_t needed = config->eps_supply_fault_frames;
    const bool under = bad_in_a_row(&row->under_voltage, (bits & AGV_EPS_FAULT_UNDER_VOLTAGE) != 0u, frame, needed,
                                    is_active(monitor, BIT(EPS_UNDER_VOLTAGE)));
    const bool over = bad_in_a_row(&row->over_voltage, (bits & AGV_EPS_FAULT_OVER_VOLTAGE) != 0u, frame, needed,
                                   is_active(monitor, BIT(EPS_OVER_VOLTAGE)));
    const bool current = bad_in_a_row(&row->excessive_current, (bits & AGV_EPS_FAULT_EXCESSIVE_CURRENT) != 0u, frame,
                                      needed, is_active(monitor, BIT(EPS_EXCESSIVE_CURRENT)));
    agv_faults_levels(
        &monitor->faults,
        BIT(EPS_UNDER_VOLTAGE) | BIT(EPS_OVER_VOLTAGE) | BIT(EPS_EXCESSIVE_CURRENT) | BIT(EPS_OVER_CURRENT_SHUTDOWN) |
            BIT(EPS_TEMP_ABOVE_110) | BIT(EPS_TEMP_ABOVE_120) | BIT(EPS_MOTOR_ENCODER) | BIT(EPS_POSITION_ENCODER),
        WHEN(under, EPS_UNDER_VOLTAGE) | WHEN(over, EPS_OVER_VOLTAGE) | WHEN(current, EPS_EXCESSIVE_CURRENT) |
            WHEN((bits & AGV_EPS_FAULT_OVER_CURRENT_SHUTDOWN) != 0u, EPS_OVER_CURRENT_SHUTDOWN) |
            WHEN((bits & AGV_EPS_FAULT_TEMP_ABOVE_110) != 0u, EPS_TEMP_ABOVE_110) |
            WHEN((bits & AGV_EPS_FAULT_TEMP_ABOVE_120) != 0u, EPS_TEMP_ABOVE_120) |
            WHEN((bits & AGV_EPS_FAULT_MOTOR_ENCODER) != 0u, EPS_MOTOR_ENCODER) |
            WHEN((bits & AGV_EPS_FAULT_POSITION_ENCODER) != 0u, EPS_POSITION_ENCODER));
}

static bool on_eps_status(agv_monitor_t *monitor, const agv_config_t *config, const agv_monitor_frame_t *frame) {
    agv_eps_status_t status;
    const bool valid = agv_unpack_eps_status(&status, frame->data);
    judge_eps_mode(monitor, config, &status, valid, frame);
    judge_eps_faults(monitor, config, status.faults, frame);
    agv_liveness_refresh(&monitor->liveness, AGV_MSG_EPS_STATUS, frame->stamp_ms);
    return true;
}

static bool on_steering_position(agv_monitor_t *monitor, const agv_config_t *config, const agv_monitor_frame_t *frame) {
    (void)config;
    agv_liveness_refresh(&monitor->liveness, AGV_MSG_STEERING_POSITION, frame->stamp_ms);
    return true;
}

static bool is_slow(int32_t speed_mm_s, uint16_t limit_mm_s) {
    return (speed_mm_s < (int32_t)limit_mm_s) && (speed_mm_s > -(int32_t)limit_mm_s);
}

static bool on_wheel_speed(agv_monitor_t *monitor, const agv_config_t *config, const agv_monitor_frame_t *frame) {
    agv_wheel_speed_t wheels;
    (void)agv_unpack_wheel_speed(&wheels, frame->data);
    const bool slow = is_slow(wheels.left_mm_s, config->standstill_speed_mm_s) &&
                      is_slow(wheels.right_mm_s, config->standstill_speed_mm_s);
    agv_timer_while(&monitor->vehicle.slow, slow, frame->now_ms);
    agv_liveness_refresh(&monitor->liveness, AGV_MSG_WHEEL_SPEED, frame->stamp_ms);
    return true;
}

/* One row a message, in the order of agv_message_t. */
static const handler_t handlers[AGV_MSG_COUNT] = {on_turn_signal_command, on_gear_command,    on_throttle_command,
                                                  on_steering_command,    on_vehicle_status,  on_gear_status,
                                                  on_throttle_status,     on_steering_status, on_eps_status,
                                                  on_steering_position,   on_wheel_speed};

static void judge_command_rate(agv_monitor_t *monitor, const agv_config_t *config, agv_message_t message,
                               uint32_t gap_ms, uint32_t now_ms) {
    uint8_t *fast_gaps = &monitor->in_a_row.fast_gaps[message];
    const uint32_t half_cycle_ms = ((uint32_t)agv_message_cycle_ms(message) + 1u) / 2u;
    if (gap_ms >= half_cycle_ms) {
        *fast_gaps = 0u;
    } else if (*fast_gaps < UINT8_MAX) {
        (*fast_gaps)++;
    } else {
        /* as many as can be counted */
    }
    if (*fast_gaps >= config->command_too_fast_gaps) {
        agv_faults_event(&monitor->faults, AGV_FAULT_COMMAND_TOO_FAST, now_ms);
    }
}

bool agv_monitor_frame(agv_monitor_t *monitor, const agv_config_t *config, agv_message_t message,
                       const agv_monitor_frame_t *frame) {
    agv_monitor_frame_t handed_on = *frame;
    const uint32_t gap_ms = agv_liveness_arrived(&monitor->liveness, message, frame->stamp_ms);
    handed_on.after_gap = gap_ms > (2u * (uint32_t)agv_message_cycle_ms(message));
    if ((uint32_t)message < AGV_COMMAND_COUNT) {
        judge_command_rate(monitor, config, message, gap_ms, frame->now_ms);
    }
    return handlers[message](monitor, config, &handed_on);
}

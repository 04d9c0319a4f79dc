#include <stddef.h>

#include "observe/deadlines.h"
#include "supervisor/supervisor_internal.h"

/* Classification of a frame, and what to do with it. */
typedef struct {
    hal_can_side_t side;
    const hal_can_frame_t *frame;
    uint32_t message;  /* agv_message_t */
    uint32_t rejected; /* agv_rejected_t; AGV_REJECTED_KINDS: not rejected */
    bool decides;      /* faults and state are evaluated */
    bool passes;       /* gateway: it may be forwarded */
} intake_t;

static bool is_command(uint32_t message) {
    return message < AGV_COMMAND_COUNT;
}

/* P15: why a frame is rejected; the last of several reasons. Other identifiers may have any length. */
static uint32_t reason_to_reject(const hal_can_frame_t *frame, uint32_t message) {
    uint32_t why = AGV_REJECTED_KINDS;
    if ((frame->length != AGV_DLC) && (message != (uint32_t)AGV_MSG_NONE)) {
        why = AGV_REJECTED_LENGTH;
    }
    if ((frame->flags & HAL_CAN_FD) != 0u) {
        why = AGV_REJECTED_FD;
    }
    if ((frame->flags & HAL_CAN_REMOTE) != 0u) {
        why = AGV_REJECTED_REMOTE;
    }
    if ((frame->flags & HAL_CAN_EXTENDED) != 0u) {
        why = AGV_REJECTED_EXTENDED;
    }
    if ((frame->flags & HAL_CAN_ERROR) != 0u) {
        why = AGV_REJECTED_ERROR;
    }
    return why;
}

static bool vcu_is_alive(const agv_core_t *core) {
    return agv_liveness_alive(&core->liveness, AGV_NODE_VCU);
}

/* Standstill depends on 101h, 363h and the time. */
void agv_core_evaluate_standstill(agv_core_t *core) {
    agv_vehicle_evaluate(&core->vehicle, &core->timers, &core->config,
                         agv_liveness_fresh(&core->liveness, &core->timers, AGV_MSG_WHEEL_SPEED), vcu_is_alive(core));
}

static bool is_judged(const agv_core_t *core) {
    return agv_mode_is_judged(&core->mode, &core->timers);
}

/* A new engagement restarts deadlines, grace time and counts. A continued one keeps them. */
static void begin_engagement(agv_core_t *core, uint32_t time_ms) {
    agv_liveness_restart_commands(&core->timers, time_ms);
    agv_commands_forget(&core->commands);
    agv_status_checks_engage(&core->status_checks);
    agv_motion_checks_engage(&core->motion_checks);
}

void agv_core_follow_mode(agv_core_t *core, agv_mode_change_t change, uint32_t time_ms) {
    if ((change != AGV_MODE_BEGAN) && (change != AGV_MODE_CONTINUED)) {
        return;
    }
    if (change == AGV_MODE_BEGAN) {
        begin_engagement(core, time_ms);
    }
    if (agv_core_is_supervising(core)) {
        agv_mode_count_engagement(&core->mode, &core->timers, &core->faults);
    }
    agv_liveness_tick(&core->liveness, &core->timers, true);
    agv_deadlines_heartbeats(&core->faults, &core->timers, &core->liveness, true);
}

static void observe_vehicle_status(agv_core_t *core, const hal_can_frame_t *frame) {
    const bool down = (frame->data[6] & AGV_VCU_FLAG_BUTTON_1) != 0u;
    const bool remote_lost =
        (frame->data[4] & (AGV_VCU_ALARM_REMOTE_SIGNAL_LOST | AGV_VCU_ALARM_REMOTE_POWER_LOST)) != 0u;
    const agv_mode_change_t change =
        agv_mode_report(&core->mode, &core->timers, &core->config, frame->data[6], vcu_is_alive(core), frame->time_ms);
    agv_core_follow_mode(core, change, frame->time_ms);
    agv_vehicle_status(&core->vehicle, frame->data);
    agv_core_evaluate_standstill(core);
    if (core->config.reset_input != (uint16_t)AGV_RESET_INPUT_PIN) {
        agv_reset_button_report(&core->reset_button, vcu_is_alive(core), remote_lost, down);
    }
    agv_status_checks_vehicle(&core->status_checks, &core->faults, frame->data,
                              agv_liveness_alive(&core->liveness, AGV_NODE_AI));
}

static void observe_throttle(agv_core_t *core, const uint8_t data[AGV_DLC], bool valid) {
    const uint32_t before = core->vehicle.throttle;
    agv_vehicle_throttle(&core->vehicle, data, valid);
    if (valid) {
        const agv_motion_facts_t facts = agv_core_motion_facts(core);
        agv_motion_checks_throttle(&core->motion_checks, &facts, before);
    }
}

static void observe_steering(agv_core_t *core, const hal_can_frame_t *frame, bool valid) {
    const uint32_t before_raw = core->vehicle.angle_raw;
    const bool known = core->vehicle.angle_known;
    agv_vehicle_steering(&core->vehicle, &core->timers, frame, valid);
    if (valid && known) {
        const agv_motion_facts_t facts = agv_core_motion_facts(core);
        agv_motion_checks_angle(&core->motion_checks, &facts, before_raw);
    }
    const bool latched = agv_state_is_latched((agv_state_t)core->machine.state);
    if (valid && latched && !agv_mode_is_manual(&core->mode)) {
        agv_hold_take(&core->hold, &core->vehicle);
    }
}

static void observe_command(agv_core_t *core, uint32_t command, const uint8_t data[AGV_DLC], bool valid) {
    if (valid && !agv_core_is_gateway(core)) {
        agv_commands_take(&core->commands, command, data);
    }
}

static void observe_value(agv_core_t *core, uint32_t message, bool valid) {
    agv_status_checks_value(&core->status_checks, &core->config, message, valid, is_judged(core));
}

/* One handler for each message. The content of 267h is not used, only its arrival. */
static void observe_content(agv_core_t *core, uint32_t message, const hal_can_frame_t *frame, bool valid) {
    switch (message) {
    case AGV_MSG_VEHICLE_STATUS:
        observe_vehicle_status(core, frame);
        break;
    case AGV_MSG_GEAR_STATUS:
        agv_vehicle_gear(&core->vehicle, frame->data, valid);
        observe_value(core, message, valid);
        break;
    case AGV_MSG_THROTTLE_STATUS:
        observe_throttle(core, frame->data, valid);
        observe_value(core, message, valid);
        break;
    case AGV_MSG_STEERING_STATUS:
        observe_steering(core, frame, valid);
        observe_value(core, message, valid);
        break;
    case AGV_MSG_EPS_STATUS:
        agv_vehicle_eps(&core->vehicle, frame->data);
        agv_status_checks_eps(&core->status_checks, &core->faults, &core->config, frame->data, valid, is_judged(core));
        break;
    case AGV_MSG_WHEEL_SPEED:
        agv_vehicle_wheels(&core->vehicle, frame->data);
        agv_core_evaluate_standstill(core);
        break;
    case AGV_MSG_STEERING_POSITION:
        break;
    default:
        observe_command(core, message, frame->data, valid);
        break;
    }
}

/* While engaged, an invalid command trips at once (SUP-5). */
static void observe_bad_command(agv_core_t *core) {
    if (agv_mode_is_engaged(&core->mode)) {
        agv_fault_monitor_event(&core->faults, &core->timers, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE);
    }
}

/* Gateway: a command of motion that is dropped because 363h does not report autopilot does not reach the vehicle. */
static bool is_withheld(const agv_core_t *core, uint32_t message) {
    return agv_core_is_gateway(core) && is_command(message) && (message != (uint32_t)AGV_MSG_TURN_SIGNAL_COMMAND) &&
           agv_mode_is_engaged(&core->mode) && !agv_mode_reports_autopilot(&core->mode);
}

/* Handle a well-formed frame from the expected side. */
static void observe_message(agv_core_t *core, const agv_ports_t *ports, intake_t *intake) {
    const hal_can_frame_t *const frame = intake->frame;
    const uint32_t message = intake->message;
    const uint32_t gap_ms = agv_liveness_arrived(&core->liveness, message, frame->time_ms);
    const bool valid = agv_value_is_valid(message, frame->data);
    agv_recorder_frame(ports->recorder, message, frame->data);
    if (is_command(message)) {
        agv_intrusion_command(&core->intrusion, &core->config, message, gap_ms);
        agv_intrusion_evaluate(&core->intrusion, &core->faults, &core->timers, &core->config, &core->liveness);
    }
    intake->passes = valid || !is_command(message);
    if (!intake->passes) {
        core->counters.dropped++;
        observe_bad_command(core);
    } else if (!is_withheld(core, message)) {
        agv_liveness_refresh(&core->liveness, &core->timers, &core->config, message, frame);
    } else {
        /* its deadline runs on */
    }
    observe_content(core, message, frame, valid);
    intake->decides = true;
}

/* The side from which a message is accepted: in a gateway, commands come from the AI side. */
static hal_can_side_t side_of(const agv_core_t *core, uint32_t message) {
    return (is_command(message) && agv_core_is_gateway(core)) ? HAL_CAN_AI : HAL_CAN_VEHICLE;
}

/* Gateway: a command on the vehicle side comes from a rogue node (SUP-6). */
static void observe_wrong_side(agv_core_t *core, intake_t *intake) {
    core->counters.dropped++;
    if (intake->side == HAL_CAN_VEHICLE) {
        agv_fault_monitor_event(&core->faults, &core->timers, AGV_FAULT_FOREIGN_COMMAND_SENDER);
        intake->decides = true;
    }
}

/* A data frame with an 11-bit identifier, of any length and format: a VCU may obey it. */
static bool is_data_frame(const intake_t *intake) {
    return (intake->rejected <= (uint32_t)AGV_REJECTED_FD) || (intake->rejected == (uint32_t)AGV_REJECTED_KINDS);
}

/* Malformed frames are only counted, except commands (SUP-5, SUP-6). */
static void observe_malformed(agv_core_t *core, intake_t *intake) {
    core->counters.rejected[intake->rejected]++;
    if (!is_command(intake->message) || !is_data_frame(intake)) {
        return;
    }
    if (intake->side == side_of(core, intake->message)) {
        observe_bad_command(core);
    } else {
        agv_fault_monitor_event(&core->faults, &core->timers, AGV_FAULT_FOREIGN_COMMAND_SENDER);
    }
    intake->decides = true;
}

/* Another sender of the status frame's identifier (TOP-3). */
static void observe_status_id(agv_core_t *core, intake_t *intake) {
    if ((core->config.status_frame_id != 0u) && (intake->frame->id == core->config.status_frame_id) &&
        (intake->side == HAL_CAN_VEHICLE) && is_data_frame(intake)) {
        agv_fault_monitor_event(&core->faults, &core->timers, AGV_FAULT_STATUS_ID_IN_USE);
        intake->decides = true;
    }
}

/* Unknown identifier: a message may have it in the other set (P1). */
static void observe_unknown(agv_core_t *core, const intake_t *intake) {
    const uint32_t other_set = (uint32_t)AGV_ID_SET_TABLE - core->config.id_set;
    const uint32_t message = agv_message_from_id(intake->frame->id, other_set);
    const bool moved = agv_message_id(message, AGV_ID_SET_HEADING) != agv_message_id(message, AGV_ID_SET_TABLE);
    if (moved && (intake->frame->length == AGV_DLC) && (intake->side == side_of(core, message))) {
        agv_deadlines_other_id_set(&core->timers, message);
    }
    core->counters.dropped += agv_core_is_gateway(core) ? 1u : 0u;
}

static void observe(agv_core_t *core, const agv_ports_t *ports, intake_t *intake) {
    core->counters.received++;
    if ((intake->side != HAL_CAN_VEHICLE) && !agv_core_is_gateway(core)) {
        core->counters.dropped++;
    } else if (intake->rejected != (uint32_t)AGV_REJECTED_KINDS) {
        observe_malformed(core, intake);
    } else if (intake->message == (uint32_t)AGV_MSG_NONE) {
        observe_unknown(core, intake);
    } else if (intake->side == side_of(core, intake->message)) {
        observe_message(core, ports, intake);
    } else {
        observe_wrong_side(core, intake);
    }
    observe_status_id(core, intake);
}

/* Gateway: forward the frame to the other side, commands within their limits. */
static void pass_on(agv_core_t *core, const agv_tx_orders_t *orders, const intake_t *intake) {
    hal_can_frame_t frame = *intake->frame;
    if (is_command(intake->message)) {
        const agv_gateway_facts_t facts = agv_core_gateway_facts(core);
        agv_gateway_follow_gear(&core->gateway, &facts, intake->message, frame.data);
        if (!agv_gateway_passes(&core->gateway, &facts, intake->message, frame.data)) {
            core->counters.dropped++;
            return;
        }
        core->counters.limited += agv_gateway_limit(&core->gateway, &facts, intake->message, frame.data) ? 1u : 0u;
    }
    agv_transmitter_pass(&core->transmitter, orders, intake->message, frame.data);
}

/* Override a command that the vehicle may have received and obeyed (TOP-1). */
static bool may_be_obeyed(const intake_t *intake) {
    return is_command(intake->message) && (intake->side == HAL_CAN_VEHICLE) && is_data_frame(intake);
}

static void transmit(agv_core_t *core, const agv_ports_t *ports, const intake_t *intake, bool all_sent) {
    const agv_tx_orders_t orders = agv_core_orders(core, ports);
    if (intake->passes && agv_core_is_gateway(core)) {
        pass_on(core, &orders, intake);
    }
    if (!all_sent && may_be_obeyed(intake)) {
        const bool whole = intake->rejected == (uint32_t)AGV_REJECTED_KINDS;
        agv_transmitter_answer(&core->transmitter, &orders, intake->message, whole ? intake->frame->data : NULL);
    }
}

void agv_core_frame(agv_core_t *core, const agv_ports_t *ports, hal_can_side_t side, const hal_can_frame_t *frame) {
    intake_t intake = {.side = side, .frame = frame, .message = agv_ids_find(&core->ids, frame->id)};
    intake.rejected = reason_to_reject(frame, intake.message);
    observe(core, ports, &intake);
    if (intake.decides) {
        const agv_pass_t pass = agv_core_decide(core, ports, 0u);
        transmit(core, ports, &intake, (pass.actions.what & AGV_ACTION_TRIP) != 0u);
        agv_core_conclude(core, ports, &pass);
    } else {
        transmit(core, ports, &intake, false);
        agv_core_take_tx_report(core);
    }
}

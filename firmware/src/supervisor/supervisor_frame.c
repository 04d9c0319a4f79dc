#include <stddef.h>

#include "observe/deadlines.h"
#include "supervisor/supervisor_internal.h"

/* What a frame is, and what becomes of it. */
typedef struct {
    hal_can_side_t side;
    const hal_can_frame_t *frame;
    uint32_t message;  /* agv_message_t */
    uint32_t rejected; /* agv_rejected_t; AGV_REJECTED_KINDS: it is not */
    bool decides;      /* faults and state are evaluated */
    bool passes;       /* gateway: it may go to the other side */
} intake_t;

static bool is_command(uint32_t message) {
    return message < AGV_COMMAND_COUNT;
}

/* P15: why a frame is rejected, of several reasons the last. Identifiers that are not ours may have any length. */
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

static agv_status_facts_t status_facts(const agv_core_t *core) {
    return (agv_status_facts_t){.config = &core->config,
                                .engaged = agv_mode_is_engaged(&core->mode),
                                .settled = agv_mode_is_settled(&core->timers),
                                .ai_alive = agv_liveness_alive(&core->liveness, AGV_NODE_AI)};
}

void agv_core_follow_mode(agv_core_t *core, agv_mode_change_t change, uint32_t time_ms) {
    if (change == AGV_MODE_BEGAN) {
        agv_liveness_restart_commands(&core->timers, time_ms);
    } else if (change == AGV_MODE_ENDED) {
        agv_status_checks_disengage(&core->status_checks, &core->faults);
        agv_motion_checks_disengage(&core->motion_checks);
    } else {
        /* as before */
    }
}

static void observe_vehicle_status(agv_core_t *core, const hal_can_frame_t *frame) {
    agv_core_follow_mode(core, agv_mode_report(&core->mode, &core->timers, frame->data[6], frame->time_ms),
                         frame->time_ms);
    agv_vehicle_status(&core->vehicle, frame->data);
    const agv_status_facts_t facts = status_facts(core);
    agv_status_checks_vehicle(&core->status_checks, &core->faults, &facts, frame->data);
}

static void observe_steering_command(agv_core_t *core, const uint8_t data[AGV_DLC], bool valid) {
    if (valid && !agv_core_is_gateway(core)) {
        agv_motion_checks_steering_commanded(&core->motion_checks, agv_angle_read(data),
                                             agv_mode_is_engaged(&core->mode));
    }
}

static void observe_value(agv_core_t *core, uint32_t message, bool valid) {
    const agv_status_facts_t facts = status_facts(core);
    agv_status_checks_value(&core->status_checks, &core->faults, &facts, message, valid);
}

static void observe_eps_status(agv_core_t *core, const uint8_t data[AGV_DLC], bool valid) {
    const agv_status_facts_t facts = status_facts(core);
    agv_vehicle_eps(&core->vehicle, data);
    agv_status_checks_eps(&core->status_checks, &core->faults, &facts, data, valid);
}

/* One handler a message. Of 43Fh, 168h, 075h and 267h nothing more counts than that they come. */
static void observe_content(agv_core_t *core, uint32_t message, const hal_can_frame_t *frame, bool valid) {
    switch (message) {
    case AGV_MSG_STEERING_COMMAND:
        observe_steering_command(core, frame->data, valid);
        break;
    case AGV_MSG_VEHICLE_STATUS:
        observe_vehicle_status(core, frame);
        break;
    case AGV_MSG_GEAR_STATUS:
        agv_vehicle_gear(&core->vehicle, frame->data, valid);
        observe_value(core, message, valid);
        break;
    case AGV_MSG_THROTTLE_STATUS:
        agv_vehicle_throttle(&core->vehicle, frame->data, valid);
        observe_value(core, message, valid);
        break;
    case AGV_MSG_STEERING_STATUS:
        agv_vehicle_steering(&core->vehicle, frame->data, valid);
        observe_value(core, message, valid);
        break;
    case AGV_MSG_EPS_STATUS:
        observe_eps_status(core, frame->data, valid);
        break;
    case AGV_MSG_WHEEL_SPEED:
        agv_vehicle_wheels(&core->timers, &core->config, frame->data);
        break;
    default:
        break;
    }
}

/* A frame of the right shape from the right side. A command with a value out of range is dropped (SUP-5). */
static void observe_message(agv_core_t *core, const agv_ports_t *ports, intake_t *intake) {
    const hal_can_frame_t *const frame = intake->frame;
    const uint32_t message = intake->message;
    const uint32_t gap_ms = agv_liveness_arrived(&core->liveness, message, frame->time_ms);
    const bool valid = agv_value_is_valid(message, frame->data);
    agv_recorder_frame(ports->recorder, message, frame->data);
    agv_status_checks_frame(&core->status_checks, message, gap_ms);
    if (is_command(message)) {
        agv_status_checks_rate(&core->status_checks, &core->faults, &core->timers, &core->config, message, gap_ms);
    }
    intake->passes = valid || !is_command(message);
    if (intake->passes) {
        agv_liveness_refresh(&core->liveness, &core->timers, message, frame);
    } else {
        core->counters.dropped++;
        if (agv_mode_is_engaged(&core->mode)) {
            agv_fault_monitor_event(&core->faults, &core->timers, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE);
        }
    }
    observe_content(core, message, frame, valid);
    intake->decides = true;
}

/* The side that a message is taken from: commands come from the AI side where there is one. */
static hal_can_side_t side_of(const agv_core_t *core, uint32_t message) {
    return (is_command(message) && agv_core_is_gateway(core)) ? HAL_CAN_AI : HAL_CAN_VEHICLE;
}

/* Gateway: a command on the vehicle side comes from nobody who may send one (SUP-6). */
static void observe_wrong_side(agv_core_t *core, intake_t *intake) {
    core->counters.dropped++;
    if (intake->side == HAL_CAN_VEHICLE) {
        agv_fault_monitor_event(&core->faults, &core->timers, AGV_FAULT_FOREIGN_COMMAND_SENDER);
        intake->decides = true;
    }
}

/* Not one of ours: it may be the identifier that a message has in the other set (P1). */
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
        core->counters.rejected[intake->rejected]++;
    } else if (intake->message == (uint32_t)AGV_MSG_NONE) {
        observe_unknown(core, intake);
    } else if (intake->side == side_of(core, intake->message)) {
        observe_message(core, ports, intake);
    } else {
        observe_wrong_side(core, intake);
    }
}

/* Gateway: to the other side, a command as the limits leave it. */
static void pass_on(agv_core_t *core, const agv_tx_orders_t *orders, const intake_t *intake) {
    const agv_state_t state = (agv_state_t)core->machine.state;
    hal_can_frame_t frame = *intake->frame;
    if (is_command(intake->message)) {
        if (!agv_gateway_passes(&core->config, state, intake->message)) {
            core->counters.dropped++;
            return;
        }
        agv_gateway_limit(&core->gateway, &core->config, &core->vehicle, state, core->timers.now_ms, intake->message,
                          frame.data);
    }
    if (intake->message == (uint32_t)AGV_MSG_STEERING_COMMAND) {
        agv_motion_checks_steering_commanded(&core->motion_checks, agv_angle_read(frame.data),
                                             agv_mode_is_engaged(&core->mode));
    }
    agv_transmitter_pass(&core->transmitter, orders, intake->message, frame.data);
}

/* A VCU may obey a command of any length: what it may have heard is answered (TOP-1). */
static bool may_be_obeyed(const intake_t *intake) {
    return is_command(intake->message) && (intake->side == HAL_CAN_VEHICLE) &&
           ((intake->rejected <= (uint32_t)AGV_REJECTED_FD) || (intake->rejected == (uint32_t)AGV_REJECTED_KINDS));
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
        const agv_actions_t actions = agv_core_decide(core, ports);
        transmit(core, ports, &intake, (actions.what & AGV_ACTION_TRIP) != 0u);
        agv_core_conclude(core, ports, actions);
    } else {
        transmit(core, ports, &intake, false);
        agv_core_take_tx_report(core);
    }
}

#include <stddef.h>
#include <string.h>

#include "supervisor_internal.h"

static bool is_command(uint32_t message) {
    return message < AGV_COMMAND_COUNT;
}

/* P15: why a frame is rejected, of several reasons the last; REJECTED_KINDS: it is not. Others' may have any length. */
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

/* Gateway: to the other side. */
static void pass_on(agv_core_t *core, uint32_t message, const uint8_t data[AGV_DLC]) {
    if (is_command(message) && !agv_gateway_passes(core, message)) {
        core->counters.dropped++;
    } else {
        agv_transmitter_pass(core, message, data);
    }
}

/* Returns whether a trip sent all safe commands at once; so do the two below. */
static bool handle_message(agv_core_t *core, uint32_t message, const hal_can_frame_t *frame) {
    agv_recorder_frame(core->recorder, message, frame->data);
    const bool usable = agv_monitor_frame(core, message, frame);
    const bool all_sent = agv_core_react(core);
    if (!usable) {
        core->counters.dropped++;
    } else if (agv_core_is_gateway(core)) {
        pass_on(core, message, frame->data);
    } else {
        /* shared bus: everybody has heard it */
    }
    return all_sent;
}

/* Gateway: a command on the vehicle side comes from nobody who may send one (SUP-6). */
static bool handle_wrong_side(agv_core_t *core, hal_can_side_t side) {
    core->counters.dropped++;
    if (side != HAL_CAN_VEHICLE) {
        return false;
    }
    agv_faults_event(core, AGV_FAULT_FOREIGN_COMMAND_SENDER);
    return agv_core_react(core);
}

/* The side that a message is taken from: commands come from the AI side where there is one. */
static hal_can_side_t side_of(const agv_core_t *core, uint32_t message) {
    return (is_command(message) && agv_core_is_gateway(core)) ? HAL_CAN_AI : HAL_CAN_VEHICLE;
}

static void handle_other(agv_core_t *core, hal_can_side_t side, const hal_can_frame_t *frame) {
    const uint32_t other_set = (uint32_t)AGV_ID_SET_TABLE - core->config.id_set;
    const uint32_t message = agv_message_from_id(frame->id, other_set);
    if ((message != (uint32_t)AGV_MSG_NONE) && (frame->length == AGV_DLC) && (side == side_of(core, message))) {
        agv_monitor_other_id_set(core, message);
    }
    core->counters.dropped += agv_core_is_gateway(core) ? 1u : 0u;
}

static bool handle_well_formed(agv_core_t *core, hal_can_side_t side, uint32_t message, const hal_can_frame_t *frame) {
    if (message == (uint32_t)AGV_MSG_NONE) {
        handle_other(core, side, frame);
        return false;
    }
    if (side == side_of(core, message)) {
        return handle_message(core, message, frame);
    }
    return handle_wrong_side(core, side);
}

/* A VCU may obey a command of any length: what it may have heard is answered (TOP-1). */
static bool may_be_obeyed(hal_can_side_t side, uint32_t message, uint32_t why) {
    return is_command(message) && (side == HAL_CAN_VEHICLE) &&
           ((why <= (uint32_t)AGV_REJECTED_FD) || (why == (uint32_t)AGV_REJECTED_KINDS));
}

void agv_core_frame(agv_core_t *core, hal_can_side_t side, const hal_can_frame_t *frame) {
    const uint32_t message = agv_message_from_id(frame->id, core->config.id_set);
    const uint32_t why = reason_to_reject(frame, message);
    bool all_sent = false;
    core->counters.received++;
    if ((side != HAL_CAN_VEHICLE) && !agv_core_is_gateway(core)) {
        core->counters.dropped++;
    } else if (why != (uint32_t)AGV_REJECTED_KINDS) {
        core->counters.rejected[why]++;
    } else {
        all_sent = handle_well_formed(core, side, message, frame);
    }
    if (!all_sent && may_be_obeyed(side, message, why)) {
        agv_transmitter_answer(core, message, (why == (uint32_t)AGV_REJECTED_KINDS) ? frame->data : NULL);
    }
    if (core->summary.changed) {
        (void)agv_core_react(core); /* the gate refused a frame */
    }
}

#include <stddef.h>
#include <string.h>

#include "supervisor_internal.h"

static bool is_command(agv_message_t message) {
    return (uint32_t)message < AGV_COMMAND_COUNT;
}

/* P15: why a frame is rejected. Identifiers of others may have any length. */
static agv_rejected_t reason_to_reject(const hal_can_frame_t *frame, agv_message_t message) {
    if ((frame->flags & HAL_CAN_ERROR) != 0u) {
        return AGV_REJECTED_ERROR;
    }
    if ((frame->flags & HAL_CAN_EXTENDED) != 0u) {
        return AGV_REJECTED_EXTENDED;
    }
    if ((frame->flags & HAL_CAN_REMOTE) != 0u) {
        return AGV_REJECTED_REMOTE;
    }
    if ((frame->flags & HAL_CAN_FD) != 0u) {
        return AGV_REJECTED_FD;
    }
    return ((frame->length != AGV_DLC) && (message != AGV_MSG_NONE)) ? AGV_REJECTED_LENGTH : AGV_REJECTED_KINDS;
}

/* A VCU may obey a command of any length: it is answered all the same (TOP-1). */
static void handle_malformed(agv_core_t *core, hal_can_side_t side, agv_message_t message, agv_rejected_t why) {
    const bool has_data = (why == AGV_REJECTED_LENGTH) || (why == AGV_REJECTED_FD);
    core->counters.rejected[why]++;
    if (has_data && is_command(message) && (side == HAL_CAN_VEHICLE)) {
        agv_transmitter_answer(core, message, NULL);
    }
}

static void pass_command(agv_core_t *core, agv_message_t command, const uint8_t *received) {
    uint8_t data[AGV_DLC];
    if (!agv_gateway_passes(core, command)) {
        core->counters.dropped++;
        return;
    }
    (void)memcpy(data, received, AGV_DLC);
    agv_gateway_limit(core, command, data);
    agv_transmitter_pass(core, command, data);
}

static void handle_message(agv_core_t *core, agv_message_t message, const hal_can_frame_t *frame) {
    agv_recorder_frame(core->recorder, message, frame->data);
    const bool usable = agv_monitor_frame(core, message, frame);
    const bool all_sent = agv_core_react(core);
    if (!usable) {
        core->counters.dropped++;
    }
    if (!agv_core_is_gateway(core)) {
        if (is_command(message) && !all_sent) {
            agv_transmitter_answer(core, message, frame->data);
        }
    } else if (!is_command(message)) {
        agv_transmitter_pass(core, message, frame->data);
    } else if (usable) {
        pass_command(core, message, frame->data);
    } else {
        /* out of range */
    }
}

/* Gateway: a command on the vehicle side comes from nobody who may send one (SUP-6). */
static void handle_foreign_command(agv_core_t *core, agv_message_t message, const hal_can_frame_t *frame) {
    agv_faults_event(core, AGV_FAULT_FOREIGN_COMMAND_SENDER);
    if (!agv_core_react(core)) {
        agv_transmitter_answer(core, message, frame->data);
    }
}

/* The side that a message is taken from: commands come from the AI side where there is one. */
static hal_can_side_t side_of(const agv_core_t *core, agv_message_t message) {
    return (is_command(message) && agv_core_is_gateway(core)) ? HAL_CAN_AI : HAL_CAN_VEHICLE;
}

static void handle_other(agv_core_t *core, hal_can_side_t side, const hal_can_frame_t *frame) {
    const bool heading = core->config.id_set == (uint16_t)AGV_ID_SET_HEADING;
    const agv_message_t message = agv_message_from_id(frame->id, heading ? AGV_ID_SET_TABLE : AGV_ID_SET_HEADING);
    if ((message != AGV_MSG_NONE) && (frame->length == AGV_DLC) && (side == side_of(core, message))) {
        agv_monitor_other_id_set(core, message);
    }
    core->counters.dropped += agv_core_is_gateway(core) ? 1u : 0u;
}

void agv_core_frame(agv_core_t *core, hal_can_side_t side, const hal_can_frame_t *frame) {
    const agv_message_t message = agv_message_from_id(frame->id, (agv_id_set_t)core->config.id_set);
    const agv_rejected_t why = reason_to_reject(frame, message);
    core->counters.received++;
    if ((side != HAL_CAN_VEHICLE) && !agv_core_is_gateway(core)) {
        core->counters.dropped++;
    } else if (why != AGV_REJECTED_KINDS) {
        handle_malformed(core, side, message, why);
    } else if (message == AGV_MSG_NONE) {
        handle_other(core, side, frame);
    } else if (side == side_of(core, message)) {
        handle_message(core, message, frame);
    } else {
        core->counters.dropped++;
        if (side == HAL_CAN_VEHICLE) {
            handle_foreign_command(core, message, frame);
        }
    }
    if (core->faults.changed) {
        (void)agv_core_react(core); /* the gate refused a frame */
    }
}

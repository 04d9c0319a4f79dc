#include "supervisor_internal.h"

#include <string.h>

static bool is_command(agv_message_t message) {
    return (uint32_t)message < AGV_COMMAND_COUNT;
}

static bool is_gateway(const agv_core_t *core) {
    return core->config.topology == (uint16_t)AGV_TOPOLOGY_GATEWAY;
}

/* P15. Returns false when the frame is none of the protocol's shape; identifiers of others may have any length. */
static bool count_malformed(agv_core_t *core, const hal_can_frame_t *frame, agv_message_t message) {
    agv_rejected_t why = AGV_REJECTED_KINDS;
    if ((frame->flags & HAL_CAN_ERROR) != 0u) {
        why = AGV_REJECTED_ERROR;
    } else if ((frame->flags & HAL_CAN_EXTENDED) != 0u) {
        why = AGV_REJECTED_EXTENDED;
    } else if ((frame->flags & HAL_CAN_REMOTE) != 0u) {
        why = AGV_REJECTED_REMOTE;
    } else if ((frame->flags & HAL_CAN_FD) != 0u) {
        why = AGV_REJECTED_FD;
    } else if ((frame->length != AGV_DLC) && (message != AGV_MSG_NONE)) {
        why = AGV_REJECTED_LENGTH;
    } else {
        return false;
    }
    core->counters.rejected[why]++;
    return true;
}

static void answer_command(agv_core_t *core, const agv_ports_t *ports, agv_message_t command, const uint8_t *data) {
    agv_outlet_t outlet = agv_core_outlet(core, ports);
    if ((data == NULL) || !agv_transmitter_same_command(command, &outlet, data)) {
        agv_transmitter_override(&core->transmitter, &outlet, command);
        agv_core_after_sending(core, ports, &outlet);
    }
}

/* A VCU may obey a command of any length: it is answered all the same (TOP-1). */
static void handle_malformed(agv_core_t *core, const agv_ports_t *ports, hal_can_side_t side,
                             const hal_can_frame_t *frame, agv_message_t message) {
    const uint8_t no_data_frame = HAL_CAN_ERROR | HAL_CAN_EXTENDED | HAL_CAN_REMOTE;
    if ((side == HAL_CAN_VEHICLE) && is_command(message) && ((frame->flags & no_data_frame) == 0u)) {
        answer_command(core, ports, message, NULL);
    }
}

static void pass_command(agv_core_t *core, const agv_ports_t *ports, agv_message_t command, const uint8_t *received) {
    const agv_state_t state = (agv_state_t)core->machine.state;
    const agv_gateway_facts_t facts = {.now_ms = core->now_ms,
                                       .measured_ddeg = core->monitor.vehicle.angle_ddeg,
                                       .measured_known = core->monitor.vehicle.angle_known};
    uint8_t data[AGV_DLC];
    if (!agv_gateway_passes(&core->config, state, command)) {
        core->counters.dropped++;
        return;
    }
    (void)memcpy(data, received, AGV_DLC);
    const int16_t angle_ddeg = agv_gateway_limit(&core->gateway, &core->config, state, command, &facts, data);
    if ((command == AGV_MSG_STEERING_COMMAND) && (state == AGV_STATE_ACTIVE)) {
        agv_monitor_steering_sent(&core->monitor, angle_ddeg);
    }
    agv_outlet_t outlet = agv_core_outlet(core, ports);
    agv_transmitter_pass(&core->transmitter, &outlet, command, data);
    agv_core_after_sending(core, ports, &outlet);
}

static void pass_status(agv_core_t *core, const agv_ports_t *ports, agv_message_t message, const uint8_t *data) {
    agv_outlet_t outlet = agv_core_outlet(core, ports);
    agv_transmitter_pass(&core->transmitter, &outlet, message, data);
    agv_core_after_sending(core, ports, &outlet);
}

static bool take_in(agv_core_t *core, const agv_ports_t *ports, agv_message_t message, const hal_can_frame_t *frame) {
    const agv_monitor_frame_t seen = {.data = frame->data, .stamp_ms = frame->time_ms, .now_ms = core->now_ms};
    agv_recorder_frame(ports->recorder, message, frame->data);
    const bool usable = agv_monitor_frame(&core->monitor, &core->config, message, &seen);
    if (!usable) {
        core->counters.dropped++;
    }
    return usable;
}

/* Shared bus: listen, and have the last word where the safe commands are sent. */
static void handle_shared(agv_core_t *core, const agv_ports_t *ports, agv_message_t message,
                          const hal_can_frame_t *frame) {
    (void)take_in(core, ports, message, frame);
    const bool all_sent = agv_core_react(core, ports);
    if (is_command(message) && !all_sent) {
        answer_command(core, ports, message, frame->data);
    }
}

static void handle_foreign_command(agv_core_t *core, const agv_ports_t *ports, agv_message_t message,
                                   const hal_can_frame_t *frame) {
    agv_faults_event(&core->monitor.faults, AGV_FAULT_FOREIGN_COMMAND_SENDER, core->now_ms);
    core->counters.dropped++;
    if (!agv_core_react(core, ports)) {
        answer_command(core, ports, message, frame->data);
    }
}

static void handle_gateway(agv_core_t *core, const agv_ports_t *ports, hal_can_side_t side, agv_message_t message,
                           const hal_can_frame_t *frame) {
    if (is_command(message) && (side == HAL_CAN_VEHICLE)) {
        handle_foreign_command(core, ports, message, frame);
    } else if (!is_command(message) && (side == HAL_CAN_AI)) {
        core->counters.dropped++;
    } else {
        const bool usable = take_in(core, ports, message, frame);
        (void)agv_core_react(core, ports);
        if (!is_command(message)) {
            pass_status(core, ports, message, frame->data);
        } else if (usable) {
            pass_command(core, ports, message, frame->data);
        } else {
            /* out of range: dropped */
        }
    }
}

static void handle_unknown(agv_core_t *core, hal_can_side_t side, const hal_can_frame_t *frame) {
    const agv_id_set_t own = (agv_id_set_t)core->config.id_set;
    const agv_id_set_t other = (own == AGV_ID_SET_HEADING) ? AGV_ID_SET_TABLE : AGV_ID_SET_HEADING;
    const agv_message_t message = agv_message_from_id(frame->id, other);
    const hal_can_side_t expected = (is_command(message) && is_gateway(core)) ? HAL_CAN_AI : HAL_CAN_VEHICLE;
    if ((message != AGV_MSG_NONE) && (frame->length == AGV_DLC) && (side == expected)) {
        agv_monitor_other_id_set(&core->monitor, message, frame->time_ms);
    }
    if (is_gateway(core)) {
        core->counters.dropped++;
    }
}

void agv_core_frame(agv_core_t *core, const agv_ports_t *ports, hal_can_side_t side, const hal_can_frame_t *frame) {
    const agv_message_t message = agv_message_from_id(frame->id, (agv_id_set_t)core->config.id_set);
    core->counters.received++;
    if ((side != HAL_CAN_VEHICLE) && !is_gateway(core)) {
        core->counters.dropped++;
    } else if (count_malformed(core, frame, message)) {
        handle_malformed(core, ports, side, frame, message);
    } else if (message == AGV_MSG_NONE) {
        handle_unknown(core, side, frame);
    } else if (is_gateway(core)) {
        handle_gateway(core, ports, side, message, frame);
    } else {
        handle_shared(core, ports, message, frame);
    }
}

#include "agv/transmitter.h"

#include <stddef.h>
#include <string.h>

#include "agv/codec.h"
#include "agv/core.h"
#include "agv/gate.h"

static uint32_t bit_of(agv_message_t message) {
    return 1u << (uint32_t)message;
}

/* Since when the HAL does not take a command. */
static uint32_t wait_of(uint32_t command) {
    return (uint32_t)AGV_WATCH_TX + command;
}

void agv_transmitter_start(agv_core_t *core) {
    core->transmitter.status_due_ms = core->now_ms;
    agv_scheduler_restart(core);
}

void agv_transmitter_discard(agv_core_t *core, uint32_t messages) {
    agv_transmitter_t *const transmitter = &core->transmitter;
    for (uint32_t i = 0u; i < (uint32_t)AGV_MSG_COUNT; i++) {
        const uint32_t bit = messages & bit_of((agv_message_t)i);
        core->counters.dropped += ((transmitter->kept & bit) != 0u) ? 1u : 0u;
        if ((bit & AGV_SET_COMMANDS) != 0u) {
            agv_watch_stop(core, wait_of(i));
            transmitter->scheduler.slots[i].override_waits = false;
        }
    }
    transmitter->kept &= (uint16_t)~messages;
}

/* The own commands that are sent in this state (FSM-1, FSM-10). */
static uint32_t wanted_commands(const agv_core_t *core) {
    uint32_t wanted = 0u;
    if (agv_state_commands_safe(agv_core_state(core))) {
        wanted = bit_of(AGV_MSG_TURN_SIGNAL_COMMAND) | bit_of(AGV_MSG_THROTTLE_COMMAND);
        if (core->machine.park_released) {
            wanted |= bit_of(AGV_MSG_GEAR_COMMAND);
        }
        if (agv_core_holds_angle(core) && agv_monitor_steering_holdable(core)) {
            wanted |= bit_of(AGV_MSG_STEERING_COMMAND);
        }
    }
    return wanted;
}

/* The safe command: built-in constants, but for the alive counter and the held angle. */
static void build(const agv_core_t *core, agv_message_t command, uint8_t data[AGV_DLC]) {
    (void)memset(data, 0, AGV_DLC); /* throttle 0 */
    if (command == AGV_MSG_TURN_SIGNAL_COMMAND) {
        data[4] = AGV_SIGNAL_LEFT | AGV_SIGNAL_RIGHT | AGV_SIGNAL_AUTOPILOT_OFF;
        data[7] = core->transmitter.alive_counter;
    } else if (command == AGV_MSG_GEAR_COMMAND) {
        data[0] = AGV_GEAR_P;
    } else if (command == AGV_MSG_STEERING_COMMAND) {
        agv_angle_write(data, (int32_t)core->hold.raw - AGV_ANGLE_RAW_CENTRE);
    } else {
        /* throttle */
    }
}

/* Send a frame through the gate. Returns false when the HAL did not take it. */
static bool emit(agv_core_t *core, hal_can_side_t side, uint16_t id, const uint8_t data[AGV_DLC]) {
    const agv_gate_t gate = {.config = &core->config,
                             .hold_raw = core->hold.raw,
                             .hold_check = core->hold.check,
                             .state = core->machine.state};
    hal_can_frame_t frame = {.id = id, .time_ms = core->now_ms, .length = AGV_DLC};
    (void)memcpy(frame.data, data, AGV_DLC);
    switch (agv_gate_send(&gate, core->hal, side, &frame)) {
    case AGV_GATE_BUSY:
        return false;
    case AGV_GATE_SENT:
        core->counters.sent++;
        break;
    case AGV_GATE_SHADOWED:
        core->counters.shadowed++;
        break;
    default:
        core->counters.gate_refused++;
        agv_faults_event(core, AGV_FAULT_TX_GATE_REFUSED);
        break;
    }
    return true;
}

static bool emit_message(agv_core_t *core, hal_can_side_t side, agv_message_t message, const uint8_t data[AGV_DLC]) {
    return emit(core, side, agv_message_id(message, (agv_id_set_t)core->config.id_set), data);
}

/* A command that is not taken waits from then on. */
static bool emit_command(agv_core_t *core, agv_message_t command, const uint8_t data[AGV_DLC]) {
    const bool taken = emit_message(core, HAL_CAN_VEHICLE, command, data);
    (void)agv_watch_while(core, wait_of(command), !taken);
    return taken;
}

/* Send an own command. It answers whatever was heard before. In bus-off nothing is handed to the HAL. */
static void send_own(agv_core_t *core, agv_message_t command) {
    agv_transmitter_t *const transmitter = &core->transmitter;
    uint8_t data[AGV_DLC];
    if (agv_bus_is_off(core, HAL_CAN_VEHICLE)) {
        return;
    }
    build(core, command, data);
    if (!emit_command(core, command, data)) {
        return;
    }
    transmitter->scheduler.slots[command].override_waits = false;
    if (command == AGV_MSG_GEAR_COMMAND) {
        agv_state_machine_park_sent(core);
    }
    if ((command == AGV_MSG_TURN_SIGNAL_COMMAND) &&
        (core->config.own_heartbeat == (uint16_t)AGV_OWN_HEARTBEAT_RUNNING)) {
        transmitter->alive_counter++;
    }
}

void agv_transmitter_burst(agv_core_t *core) {
    const uint32_t wanted = wanted_commands(core);
    agv_scheduler_restart(core);
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        if ((wanted & bit_of((agv_message_t)i)) != 0u) {
            send_own(core, (agv_message_t)i);
        }
    }
    core->transmitter.wanted_before = (uint8_t)wanted;
}

/* Whether a payload commands what the own command does. Reserved bits and the alive counter command nothing. */
static bool is_same_command(const agv_core_t *core, agv_message_t command, const uint8_t data[AGV_DLC]) {
    uint8_t own[AGV_DLC];
    uint32_t differences = 0u;
    build(core, command, own);
    for (uint32_t i = 0u; i < (AGV_DLC - 1u); i++) {
        differences |= ((uint32_t)own[i] ^ data[i]) & agv_command_bits[command][i];
    }
    return differences == 0u;
}

static void override(agv_core_t *core, agv_message_t command) {
    send_own(core, command);
    agv_scheduler_overridden(core, command);
}

void agv_transmitter_answer(agv_core_t *core, agv_message_t command, const uint8_t *data) {
    const bool differs = (data == NULL) || !is_same_command(core, command, data);
    if (differs && ((wanted_commands(core) & bit_of(command)) != 0u) && agv_scheduler_override(core, command)) {
        override(core, command);
    }
}

/* Send a passed frame, or keep it until the HAL takes it. */
static void send_passed(agv_core_t *core, agv_message_t message) {
    agv_transmitter_t *const transmitter = &core->transmitter;
    const uint8_t *const data = transmitter->kept_data[message];
    const bool taken = ((uint32_t)message < AGV_COMMAND_COUNT) ? emit_command(core, message, data)
                                                               : emit_message(core, HAL_CAN_AI, message, data);
    if (taken) {
        transmitter->kept &= (uint16_t)~bit_of(message);
    } else {
        transmitter->kept |= (uint16_t)bit_of(message);
    }
}

void agv_transmitter_pass(agv_core_t *core, agv_message_t message, const uint8_t data[AGV_DLC]) {
    if ((core->transmitter.kept & bit_of(message)) != 0u) {
        core->counters.dropped++; /* the older one that waited */
    }
    (void)memcpy(core->transmitter.kept_data[message], data, AGV_DLC);
    send_passed(core, message);
}

static void tick_own(agv_core_t *core, agv_message_t command, uint32_t wanted) {
    const uint32_t slots = agv_scheduler_due(core, command);
    const bool foreign = agv_scheduler_override_due(core, command);
    if ((wanted & bit_of(command)) == 0u) {
        agv_watch_stop(core, wait_of(command));
        return;
    }
    core->counters.skipped_slots += (slots > 1u) ? (slots - 1u) : 0u;
    if (foreign) {
        override(core, command);
        return;
    }
    /* park: at_standstill held P back; 065h waits for its slot */
    const bool first_park =
        (command == AGV_MSG_GEAR_COMMAND) && ((core->transmitter.wanted_before & bit_of(command)) == 0u);
    if (first_park) {
        agv_scheduler_restart_slot(core, command);
    }
    if (first_park || (slots != 0u) || agv_watch_runs(core, wait_of(command))) {
        send_own(core, command);
    }
}

/* TOP-3: state, first reason, safety output, alive counter, configuration checksum. */
static void send_status_frame(agv_core_t *core) {
    agv_transmitter_t *const transmitter = &core->transmitter;
    const uint32_t late_ms = core->now_ms - transmitter->status_due_ms;
    const uint32_t period_ms = core->config.status_frame_period_ms;
    uint8_t data[AGV_DLC] = {core->machine.state, core->machine.first_reason,
                             (uint8_t)(core->machine.output_closed ? 1u : 0u), transmitter->status_counter};
    if ((core->config.status_frame_id == 0u) || (late_ms > (UINT32_MAX / 2u)) ||
        agv_bus_is_off(core, HAL_CAN_VEHICLE)) {
        return;
    }
    for (uint32_t i = 0u; i < 4u; i++) {
        data[4u + i] = (uint8_t)(core->config_checksum >> (8u * i));
    }
    transmitter->status_due_ms = (core->now_ms + period_ms) - (late_ms % period_ms);
    if (emit(core, HAL_CAN_VEHICLE, core->config.status_frame_id, data)) {
        transmitter->status_counter++;
    }
}

void agv_transmitter_tick(agv_core_t *core) {
    agv_transmitter_t *const transmitter = &core->transmitter;
    const uint32_t wanted = wanted_commands(core);
    for (uint32_t i = 0u; (transmitter->kept >> i) != 0u; i++) {
        if ((transmitter->kept & bit_of((agv_message_t)i)) != 0u) {
            send_passed(core, (agv_message_t)i);
        }
    }
    if ((wanted | transmitter->wanted_before) != 0u) {
        for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
            tick_own(core, (agv_message_t)i, wanted);
        }
    }
    transmitter->wanted_before = (uint8_t)wanted;
    send_status_frame(core);
}

bool agv_transmitter_stalled(agv_core_t *core) {
    bool stalled = false;
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        if (agv_watch_reached(core, wait_of(i))) {
            stalled = true;
        }
    }
    return stalled;
}

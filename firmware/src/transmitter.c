#include "agv/transmitter.h"

#include <stddef.h>
#include <string.h>

#include "agv/codec.h"
#include "agv/core.h"
#include "agv/gate.h"

static uint32_t bit_of(uint32_t message) {
    return 1u << message;
}

/* Since when the HAL does not take a command. */
static uint32_t wait_of(uint32_t command) {
    return (uint32_t)AGV_WATCH_TX + command;
}

void agv_transmitter_start(agv_core_t *core) {
    core->transmitter.status_due_ms = core->now_ms;
}

void agv_transmitter_discard(agv_core_t *core, hal_can_side_t side) {
    agv_transmitter_t *const transmitter = &core->transmitter;
    const uint32_t messages = (side == HAL_CAN_VEHICLE) ? AGV_SET_COMMANDS : AGV_SET_STATUS;
    for (uint32_t waiting = transmitter->kept & messages; waiting != 0u; waiting &= waiting - 1u) {
        core->counters.dropped++;
    }
    transmitter->kept &= ~messages;
    if (side == HAL_CAN_VEHICLE) {
        transmitter->scheduler.override_waits = 0u;
        for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
            agv_watch_stop(core, wait_of(i));
        }
    }
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
static void build(const agv_core_t *core, uint32_t command, uint8_t data[AGV_DLC]) {
    (void)memset(data, 0, AGV_DLC); /* throttle 0 */
    if (command == (uint32_t)AGV_MSG_TURN_SIGNAL_COMMAND) {
        data[4] = AGV_SIGNAL_LEFT | AGV_SIGNAL_RIGHT | AGV_SIGNAL_AUTOPILOT_OFF;
        data[7] = core->transmitter.alive_counter;
    } else if (command == (uint32_t)AGV_MSG_GEAR_COMMAND) {
        data[0] = AGV_GEAR_P;
    } else if (command == (uint32_t)AGV_MSG_STEERING_COMMAND) {
        agv_angle_write(data, core->hold.raw);
    } else {
        /* throttle */
    }
}

/* Send a frame through the gate. Returns whether it has to wait: the HAL did not take it. */
static bool emit(agv_core_t *core, hal_can_side_t side, uint32_t id, const uint8_t data[AGV_DLC]) {
    const agv_gate_t gate = {.config = &core->config,
                             .hold_raw = core->hold.raw,
                             .hold_check = core->hold.check,
                             .state = core->machine.state};
    hal_can_frame_t frame = {.id = id, .time_ms = core->now_ms, .length = AGV_DLC};
    (void)memcpy(frame.data, data, AGV_DLC);
    switch (agv_gate_send(&gate, core->hal, side, &frame)) {
    case AGV_GATE_BUSY:
        return true;
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
    return false;
}

/* To the side that a message goes to. Returns whether it has to wait; how long a command does is watched. */
static bool send_message(agv_core_t *core, uint32_t message, const uint8_t data[AGV_DLC]) {
    const bool command = message < AGV_COMMAND_COUNT;
    const bool waits =
        emit(core, command ? HAL_CAN_VEHICLE : HAL_CAN_AI, agv_message_id(message, core->config.id_set), data);
    if (command) {
        (void)agv_watch_while(core, wait_of(message), waits);
    }
    return waits;
}

/* Send an own command. It answers whatever was heard before. In bus-off nothing is handed to the HAL. */
static void send_own(agv_core_t *core, uint32_t command) {
    agv_transmitter_t *const transmitter = &core->transmitter;
    uint8_t data[AGV_DLC];
    if (agv_bus_is_off(core, HAL_CAN_VEHICLE)) {
        return;
    }
    build(core, command, data);
    if (send_message(core, command, data)) {
        return;
    }
    transmitter->scheduler.override_waits &= ~bit_of(command);
    if (command == (uint32_t)AGV_MSG_GEAR_COMMAND) {
        agv_state_machine_park_sent(core);
    }
    if ((command == (uint32_t)AGV_MSG_TURN_SIGNAL_COMMAND) &&
        (core->config.own_heartbeat == (uint16_t)AGV_OWN_HEARTBEAT_RUNNING)) {
        transmitter->alive_counter++;
    }
}

void agv_transmitter_burst(agv_core_t *core) {
    const uint32_t wanted = wanted_commands(core);
    agv_scheduler_restart(core);
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        if ((wanted & bit_of(i)) != 0u) {
            send_own(core, i);
        }
    }
    core->transmitter.wanted_before = (uint8_t)wanted;
}

/* Whether a payload commands what the own command does. Reserved bits and the alive counter command nothing. */
static bool is_same_command(const agv_core_t *core, uint32_t command, const uint8_t data[AGV_DLC]) {
    uint8_t own[AGV_DLC];
    uint32_t differences = 0u;
    build(core, command, own);
    for (uint32_t i = 0u; i < (AGV_DLC - 1u); i++) {
        differences |= ((uint32_t)own[i] ^ data[i]) & agv_command_bits[command][i];
    }
    return differences == 0u;
}

static void override(agv_core_t *core, uint32_t command) {
    send_own(core, command);
    agv_scheduler_overridden(core, command);
}

void agv_transmitter_answer(agv_core_t *core, uint32_t command, const uint8_t *data) {
    const bool differs = (data == NULL) || !is_same_command(core, command, data);
    if (differs && ((wanted_commands(core) & bit_of(command)) != 0u) && agv_scheduler_override(core, command)) {
        override(core, command);
    }
}

/* Send a passed frame, or keep it until the HAL takes it. */
static void send_passed(agv_core_t *core, uint32_t message) {
    agv_transmitter_t *const transmitter = &core->transmitter;
    if (send_message(core, message, transmitter->kept_data[message])) {
        transmitter->kept |= bit_of(message);
    } else {
        transmitter->kept &= ~bit_of(message);
    }
}

void agv_transmitter_pass(agv_core_t *core, uint32_t message, const uint8_t data[AGV_DLC]) {
    agv_transmitter_t *const transmitter = &core->transmitter;
    if ((transmitter->kept & bit_of(message)) != 0u) {
        core->counters.dropped++; /* the older one that waited */
    }
    (void)memcpy(transmitter->kept_data[message], data, AGV_DLC);
    if (message < AGV_COMMAND_COUNT) {
        agv_gateway_limit(core, message, transmitter->kept_data[message]);
    }
    send_passed(core, message);
}

static void tick_own(agv_core_t *core, uint32_t command, uint32_t wanted) {
    const uint32_t slots = agv_scheduler_due(core, command);
    const bool foreign = agv_scheduler_override_due(core, command);
    if ((wanted & bit_of(command)) == 0u) {
        agv_watch_stop(core, wait_of(command));
        return;
    }
    if (slots > 1u) {
        core->counters.skipped_slots += slots - 1u;
    }
    if (foreign) {
        override(core, command);
        return;
    }
    /* park: at_standstill held P back; 065h waits for its slot */
    const bool first_park =
        (command == (uint32_t)AGV_MSG_GEAR_COMMAND) && ((core->transmitter.wanted_before & bit_of(command)) == 0u);
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
    if (!emit(core, HAL_CAN_VEHICLE, core->config.status_frame_id, data)) {
        transmitter->status_counter++;
    }
}

void agv_transmitter_tick(agv_core_t *core) {
    agv_transmitter_t *const transmitter = &core->transmitter;
    const uint32_t wanted = wanted_commands(core);
    for (uint32_t i = 0u; (transmitter->kept >> i) != 0u; i++) {
        if ((transmitter->kept & bit_of(i)) != 0u) {
            send_passed(core, i);
        }
    }
    if ((wanted | transmitter->wanted_before) != 0u) {
        for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
            tick_own(core, i, wanted);
        }
    }
    transmitter->wanted_before = (uint8_t)wanted;
    send_status_frame(core);
}

bool agv_transmitter_stalled(agv_core_t *core) {
    uint32_t stalled = 0u;
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        stalled |= agv_watch_reached(core, wait_of(i)) ? 1u : 0u;
    }
    return stalled != 0u;
}

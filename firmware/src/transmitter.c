#include "agv/transmitter.h"

#include <string.h>

#include "agv/codec.h"

static uint8_t bit_of(agv_message_t command) {
    return (uint8_t)(1u << (uint32_t)command);
}

static bool is_command(agv_message_t message) {
    return (uint32_t)message < AGV_COMMAND_COUNT;
}

void agv_transmitter_start(agv_transmitter_t *transmitter, uint32_t now_ms) {
    *transmitter = (agv_transmitter_t){.status_due_ms = now_ms};
    agv_scheduler_restart(&transmitter->scheduler, now_ms);
}

static void discard(agv_transmitter_t *transmitter, agv_counters_t *counters, uint16_t messages) {
    for (uint32_t i = 0u; i < (uint32_t)AGV_MSG_COUNT; i++) {
        if ((transmitter->kept & messages & (1u << i)) != 0u) {
            counters->dropped++;
        }
    }
    transmitter->kept &= (uint16_t)~messages;
}

void agv_transmitter_discard(agv_transmitter_t *transmitter, agv_counters_t *counters) {
    discard(transmitter, counters, AGV_COMMANDS_ALL);
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        agv_timer_stop(&transmitter->waits[i]);
        transmitter->scheduler.slots[i].override_waits = false;
    }
}

void agv_transmitter_discard_ai(agv_transmitter_t *transmitter, agv_counters_t *counters) {
    discard(transmitter, counters, (uint16_t)~AGV_COMMANDS_ALL);
}

/* The safe command: built-in constants, but for the alive counter and the held angle. */
static void build(const agv_transmitter_t *transmitter, const agv_outlet_t *outlet, agv_message_t command,
                  uint8_t data[AGV_DLC]) {
    (void)memset(data, 0, AGV_DLC);
    switch (command) {
    case AGV_MSG_TURN_SIGNAL_COMMAND: {
        const agv_turn_signal_command_t safe = {.turn_left_on = true,
                                                .turn_right_on = true,
                                                .autopilot_off = true,
                                                .headlight_on = true,
                                                .alive_counter = transmitter->alive_counter};
        (void)agv_pack_turn_signal_command(data, &safe);
        break;
    }
    case AGV_MSG_GEAR_COMMAND: {
        const agv_gear_command_t safe = {.gear = AGV_GEAR_P};
        (void)agv_pack_gear_command(data, &safe);
        break;
    }
    case AGV_MSG_STEERING_COMMAND: {
        const agv_steering_command_t safe = {.angle_ddeg = (int32_t)outlet->gate.hold_raw - AGV_ANGLE_RAW_CENTRE};
        (void)agv_pack_steering_command(data, &safe);
        break;
    }
    default: /* throttle 0 */
        break;
    }
}

static agv_gate_result_t emit(agv_outlet_t *outlet, hal_can_side_t side, uint16_t id, const uint8_t data[AGV_DLC]) {
    hal_can_frame_t frame = {.id = id, .time_ms = outlet->now_ms, .length = AGV_DLC};
    (void)memcpy(frame.data, data, AGV_DLC);
    const agv_gate_result_t result = agv_gate_send(&outlet->gate, outlet->hal, side, &frame);
    switch (result) {
    case AGV_GATE_SENT:
        outlet->counters->sent++;
        break;
    case AGV_GATE_SHADOWED:
        outlet->counters->shadowed++;
        break;
    case AGV_GATE_REFUSED:
        outlet->counters->gate_refused++;
        outlet->refused = true;
        break;
    default:
        break;
    }
    return result;
}

static agv_gate_result_t emit_message(agv_outlet_t *outlet, agv_message_t message, const uint8_t data[AGV_DLC]) {
    const uint16_t id = agv_message_id(message, (agv_id_set_t)outlet->gate.id_set);
    return emit(outlet, is_command(message) ? HAL_CAN_VEHICLE : HAL_CAN_AI, id, data);
}

/* Send an own command. It answers whatever was heard before. */
static void send_own(agv_transmitter_t *transmitter, agv_outlet_t *outlet, agv_message_t command) {
    uint8_t data[AGV_DLC];
    if (outlet->vehicle_side_off) {
        return;
    }
    build(transmitter, outlet, command, data);
    const agv_gate_result_t result = emit_message(outlet, command, data);
    agv_timer_while(&transmitter->waits[command], result == AGV_GATE_BUSY, outlet->now_ms);
    if ((result == AGV_GATE_SENT) || (result == AGV_GATE_SHADOWED)) {
        transmitter->scheduler.slots[command].override_waits = false;
        if (command == AGV_MSG_GEAR_COMMAND) {
            outlet->park_sent = true;
        }
        if ((command == AGV_MSG_TURN_SIGNAL_COMMAND) && !outlet->frozen_heartbeat) {
            transmitter->alive_counter++;
        }
    }
}

static bool is_wanted(const agv_outlet_t *outlet, agv_message_t command) {
    return (outlet->wanted & bit_of(command)) != 0u;
}

void agv_transmitter_burst(agv_transmitter_t *transmitter, agv_outlet_t *outlet) {
    agv_scheduler_restart(&transmitter->scheduler, outlet->now_ms);
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        if (is_wanted(outlet, (agv_message_t)i)) {
            send_own(transmitter, outlet, (agv_message_t)i);
        }
    }
    transmitter->wanted_before = outlet->wanted;
}

bool agv_transmitter_same_command(agv_message_t command, const agv_outlet_t *outlet, const uint8_t data[AGV_DLC]) {
    agv_turn_signal_command_t signals;
    agv_gear_command_t gear;
    agv_throttle_command_t throttle;
    agv_steering_command_t steering;
    switch (command) {
    case AGV_MSG_TURN_SIGNAL_COMMAND:
        (void)agv_unpack_turn_signal_command(&signals, data);
        return signals.turn_left_on && signals.turn_right_on && signals.autopilot_off && signals.headlight_on;
    case AGV_MSG_GEAR_COMMAND:
        return agv_unpack_gear_command(&gear, data) && (gear.gear == (uint8_t)AGV_GEAR_P);
    case AGV_MSG_THROTTLE_COMMAND:
        return agv_unpack_throttle_command(&throttle, data) && (throttle.throttle_permille == 0u);
    default:
        return agv_unpack_steering_command(&steering, data) &&
               (steering.angle_ddeg == ((int32_t)outlet->gate.hold_raw - AGV_ANGLE_RAW_CENTRE));
    }
}

static void answer(agv_transmitter_t *transmitter, agv_outlet_t *outlet, agv_message_t command) {
    send_own(transmitter, outlet, command);
    agv_scheduler_overridden(&transmitter->scheduler, command, outlet->now_ms);
}

void agv_transmitter_override(agv_transmitter_t *transmitter, agv_outlet_t *outlet, agv_message_t command) {
    if (is_wanted(outlet, command) &&
        agv_scheduler_override(&transmitter->scheduler, command, outlet->now_ms, outlet->override_gap_ms)) {
        answer(transmitter, outlet, command);
    }
}

static void keep(agv_transmitter_t *transmitter, agv_outlet_t *outlet, agv_message_t message, bool busy,
                 const uint8_t data[AGV_DLC]) {
    const uint16_t bit = (uint16_t)(1u << (uint32_t)message);
    if (is_command(message)) {
        agv_timer_while(&transmitter->waits[message], busy, outlet->now_ms);
    }
    transmitter->kept &= (uint16_t)~bit;
    if (busy) {
        transmitter->kept |= bit;
        (void)memmove(transmitter->kept_data[message], data, AGV_DLC);
    }
}

void agv_transmitter_pass(agv_transmitter_t *transmitter, agv_outlet_t *outlet, agv_message_t message,
                          const uint8_t data[AGV_DLC]) {
    if ((transmitter->kept & (1u << (uint32_t)message)) != 0u) {
        outlet->counters->dropped++; /* the older one that waited */
    }
    keep(transmitter, outlet, message, emit_message(outlet, message, data) == AGV_GATE_BUSY, data);
}

static void retry_kept(agv_transmitter_t *transmitter, agv_outlet_t *outlet) {
    for (uint32_t i = 0u; (i < (uint32_t)AGV_MSG_COUNT) && (transmitter->kept != 0u); i++) {
        if ((transmitter->kept & (1u << i)) != 0u) {
            const agv_message_t message = (agv_message_t)i;
            const uint8_t *data = transmitter->kept_data[message];
            keep(transmitter, outlet, message, emit_message(outlet, message, data) == AGV_GATE_BUSY, data);
        }
    }
}

/* 168h may be wanted later than the others (park: at_standstill): then it is sent at once. 065h waits for its slot. */
static bool begins(const agv_transmitter_t *transmitter, const agv_outlet_t *outlet, agv_message_t command) {
    return (command == AGV_MSG_GEAR_COMMAND) && ((transmitter->wanted_before & bit_of(command)) == 0u) &&
           is_wanted(outlet, command);
}

static void tick_command(agv_transmitter_t *transmitter, agv_outlet_t *outlet, agv_message_t command) {
    const bool waits = transmitter->waits[command].phase != (uint8_t)AGV_TIMER_STOPPED;
    uint32_t skipped = 0u;
    const bool due = agv_scheduler_due(&transmitter->scheduler, command, outlet->now_ms, &skipped);
    const bool override_due =
        agv_scheduler_override_due(&transmitter->scheduler, command, outlet->now_ms, outlet->override_gap_ms);
    if (!is_wanted(outlet, command)) {
        agv_timer_stop(&transmitter->waits[command]);
        return;
    }
    outlet->counters->skipped_slots += skipped;
    if (begins(transmitter, outlet, command)) {
        agv_scheduler_restart_slot(&transmitter->scheduler, command, outlet->now_ms);
        send_own(transmitter, outlet, command);
    } else if (override_due) {
        answer(transmitter, outlet, command);
    } else if (due || waits) {
        send_own(transmitter, outlet, command);
    } else {
        /* not yet */
    }
}

void agv_transmitter_tick(agv_transmitter_t *transmitter, agv_outlet_t *outlet) {
    retry_kept(transmitter, outlet);
    if ((outlet->wanted | transmitter->wanted_before) != 0u) {
        for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
            tick_command(transmitter, outlet, (agv_message_t)i);
        }
    }
    transmitter->wanted_before = outlet->wanted;
}

bool agv_transmitter_stalled(agv_transmitter_t *transmitter, uint32_t now_ms, uint16_t limit_ms) {
    bool stalled = false;
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        stalled = agv_timer_exceeded(&transmitter->waits[i], now_ms, limit_ms) || stalled;
    }
    return stalled;
}

void agv_transmitter_status(agv_transmitter_t *transmitter, agv_outlet_t *outlet, const uint8_t data[AGV_DLC],
                            uint16_t period_ms) {
    uint8_t payload[AGV_DLC];
    const uint32_t late_ms = outlet->now_ms - transmitter->status_due_ms;
    if ((outlet->gate.status_id == 0u) || (late_ms > (UINT32_MAX / 2u)) || outlet->vehicle_side_off) {
        return;
    }
    transmitter->status_due_ms = outlet->now_ms + period_ms - (late_ms % period_ms);
    (void)memcpy(payload, data, AGV_DLC);
    payload[3] = transmitter->status_counter;
    if (emit(outlet, HAL_CAN_VEHICLE, outlet->gate.status_id, payload) != AGV_GATE_BUSY) {
        transmitter->status_counter++;
    }
}

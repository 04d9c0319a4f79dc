#include "transmit/transmitter.h"

#include <stddef.h>
#include <string.h>

#include "agv/codec.h"
#include "observe/bus.h"
#include "transmit/gate.h"

/* The timer of a command that the HAL does not accept. */
static const uint8_t waits[AGV_COMMAND_COUNT] = {[AGV_MSG_TURN_SIGNAL_COMMAND] = AGV_TIMER_TX_TURN_SIGNAL,
                                                 [AGV_MSG_GEAR_COMMAND] = AGV_TIMER_TX_GEAR,
                                                 [AGV_MSG_THROTTLE_COMMAND] = AGV_TIMER_TX_THROTTLE,
                                                 [AGV_MSG_STEERING_COMMAND] = AGV_TIMER_TX_STEERING};

/* A status frame that the HAL accepted less than this ago may still be waiting. */
enum { STATUS_ON_WIRE_MS = 2 };

/* A tick that comes later than this after the last one is late. */
enum { TICK_USUAL_MS = 2 };

/*
 * A foreign command that comes alone adds ALONE_FRAME, one that follows in the same or next ms resets the count, and each ms
 * without one subtracts 1. From ALONE_ENOUGH on, the sender repeats its command with pauses in which an override finds room.
 * From ALONE_MAX the count falls below ALONE_ENOUGH within 5 ms after the last command.
 */
#define ALONE_FRAME 4u
#define ALONE_ENOUGH 8u
#define ALONE_MAX 9u
#define LAST_TICK_SHIFT 4u

void agv_transmitter_start(agv_transmitter_t *transmitter, uint32_t now_ms) {
    transmitter->status_due_ms = now_ms;
    transmitter->status_ms = now_ms - (uint32_t)STATUS_ON_WIRE_MS - 1u;
}

/* The controller was purged, or will be: the last status frame may be lost. */
static void repeat_status(agv_transmitter_t *transmitter, const agv_timers_t *timers) {
    transmitter->status_again = agv_age_ms(timers->now_ms, transmitter->status_ms) <= (uint32_t)STATUS_ON_WIRE_MS;
}

void agv_transmitter_discard(agv_transmitter_t *transmitter, agv_timers_t *timers, hal_can_side_t side) {
    const uint32_t messages = (side == HAL_CAN_VEHICLE) ? AGV_SET_COMMANDS : AGV_SET_STATUS;
    for (uint32_t waiting = transmitter->kept & messages; waiting != 0u; waiting &= waiting - 1u) {
        transmitter->report.dropped++;
    }
    transmitter->kept &= ~messages;
    if (side == HAL_CAN_VEHICLE) {
        repeat_status(transmitter, timers);
        transmitter->throttle_0_waits = false;
        agv_scheduler_discard(&transmitter->scheduler);
        for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
            agv_timer_stop(timers, waits[i]);
        }
        agv_timer_stop(timers, AGV_TIMER_TX_STATUS);
    } else {
        agv_timer_stop(timers, AGV_TIMER_TX_AI);
    }
}

void agv_transmitter_withdraw(agv_transmitter_t *transmitter, agv_timers_t *timers, bool status_again) {
    agv_transmitter_discard(transmitter, timers, HAL_CAN_VEHICLE);
    transmitter->status_again = transmitter->status_again && status_again;
}

/* The own commands that are sent in this state (FSM-1, FSM-10). */
static uint32_t wanted_commands(const agv_tx_orders_t *orders) {
    uint32_t wanted = 0u;
    if (agv_state_commands_safe((agv_state_t)orders->state)) {
        wanted = agv_message_bit(AGV_MSG_TURN_SIGNAL_COMMAND) | agv_message_bit(AGV_MSG_THROTTLE_COMMAND);
        if (orders->park_released) {
            wanted |= agv_message_bit(AGV_MSG_GEAR_COMMAND);
        }
        if (orders->holdable && agv_hold_is_held(&orders->hold)) {
            wanted |= agv_message_bit(AGV_MSG_STEERING_COMMAND);
        }
    }
    return wanted;
}

/* Build a safe command from constants, the alive counter and the held angle. */
static void build(const agv_transmitter_t *transmitter, const agv_tx_orders_t *orders, uint32_t command,
                  uint8_t data[AGV_DLC]) {
    (void)memset(data, 0, AGV_DLC); /* throttle 0 */
    if (command == (uint32_t)AGV_MSG_TURN_SIGNAL_COMMAND) {
        data[4] = AGV_SIGNAL_LEFT | AGV_SIGNAL_RIGHT | AGV_SIGNAL_AUTOPILOT_OFF;
        data[7] = transmitter->alive_counter;
    } else if (command == (uint32_t)AGV_MSG_GEAR_COMMAND) {
        data[0] = AGV_GEAR_P;
    } else if (command == (uint32_t)AGV_MSG_STEERING_COMMAND) {
        agv_angle_write(data, orders->hold.raw);
    } else {
        /* throttle: all zero */
    }
}

/* Send a frame through the gate. Returns whether the HAL did not accept it. */
static bool emit(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders, hal_can_side_t side, uint32_t id,
                 const uint8_t data[AGV_DLC]) {
    const agv_gate_t gate = {.config = orders->config,
                             .ids = orders->ids,
                             .hold_raw = orders->hold.raw,
                             .hold_check = orders->hold.check,
                             .state = orders->state};
    hal_can_frame_t frame = {.id = id, .time_ms = orders->timers->now_ms, .length = AGV_DLC};
    (void)memcpy(frame.data, data, AGV_DLC);
    switch (agv_gate_send(&gate, orders->hal, side, &frame)) {
    case AGV_GATE_BUSY:
        return true;
    case AGV_GATE_SENT:
        transmitter->report.sent++;
        break;
    case AGV_GATE_SHADOWED:
        transmitter->report.shadowed++;
        break;
    default:
        transmitter->report.refused++;
        break;
    }
    return false;
}

/*
 * Send a message to its side. Returns whether it must wait. The waiting time is measured: of each command, and of the AI side as
 * a whole.
 */
static bool send_message(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders, uint32_t message,
                         const uint8_t data[AGV_DLC]) {
    const bool command = message < AGV_COMMAND_COUNT;
    const bool has_to_wait =
        emit(transmitter, orders, command ? HAL_CAN_VEHICLE : HAL_CAN_AI, orders->ids->of[message], data);
    (void)agv_timer_while(orders->timers, command ? waits[message] : (uint32_t)AGV_TIMER_TX_AI, has_to_wait);
    return has_to_wait;
}

/* Send an own command. This also does a waiting override. In bus-off no frame is passed to the HAL. */
static void send_own(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders, uint32_t command) {
    uint8_t data[AGV_DLC];
    if (agv_bus_is_off(orders->timers, HAL_CAN_VEHICLE)) {
        return;
    }
    build(transmitter, orders, command, data);
    if (send_message(transmitter, orders, command, data)) {
        return;
    }
    agv_scheduler_answered(&transmitter->scheduler, command);
    if (command == (uint32_t)AGV_MSG_GEAR_COMMAND) {
        transmitter->report.park_sent = true;
    }
    if (command == (uint32_t)AGV_MSG_STEERING_COMMAND) {
        transmitter->report.hold_sent = true;
    }
    if ((command == (uint32_t)AGV_MSG_TURN_SIGNAL_COMMAND) &&
        (orders->config->own_heartbeat == (uint16_t)AGV_OWN_HEARTBEAT_RUNNING)) {
        transmitter->alive_counter++;
    }
}

/* The nth own command that is sent, in the order of arbitration: no command waits in a port behind one that cannot leave. */
static uint32_t nth_command(uint32_t n) {
    return ((uint32_t)AGV_COMMAND_COUNT - 1u) - n;
}

void agv_transmitter_burst(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders) {
    const uint32_t wanted = wanted_commands(orders);
    agv_scheduler_restart(&transmitter->scheduler, orders->timers->now_ms);
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        const uint32_t command = nth_command(i);
        if ((wanted & agv_message_bit(command)) != 0u) {
            send_own(transmitter, orders, command);
        }
    }
    transmitter->wanted_before = (uint8_t)wanted;
}

/* Whether a payload has the same effect as the own command: reserved bits and the alive counter do not count. */
static bool is_same_command(const agv_transmitter_t *transmitter, const agv_tx_orders_t *orders, uint32_t command,
                            const uint8_t data[AGV_DLC]) {
    uint8_t own[AGV_DLC];
    uint32_t differences = 0u;
    build(transmitter, orders, command, own);
    for (uint32_t i = 0u; i < (AGV_DLC - 1u); i++) {
        differences |= ((uint32_t)own[i] ^ data[i]) & agv_command_bits[command][i];
    }
    return differences == 0u;
}

static void override(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders, uint32_t command) {
    send_own(transmitter, orders, command);
    agv_scheduler_overridden(&transmitter->scheduler, orders->timers, command);
}

/* Whether another sender's command that differs came since the tick before the last one. */
static bool came_lately(const agv_transmitter_t *transmitter, uint32_t command) {
    const uint32_t lately = (uint32_t)transmitter->foreign_lately >> LAST_TICK_SHIFT;
    return ((transmitter->foreign_lately | lately) & agv_message_bit(command)) != 0u;
}

static void note_foreign(agv_transmitter_t *transmitter, uint32_t command) {
    const uint32_t count = came_lately(transmitter, command) ? 0u : (transmitter->alone[command] + ALONE_FRAME);
    transmitter->alone[command] = (uint8_t)((count < ALONE_MAX) ? count : ALONE_MAX);
    transmitter->foreign_lately |= (uint8_t)agv_message_bit(command);
}

void agv_transmitter_answer(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders, uint32_t command,
                            const uint8_t *data) {
    const bool differs = (data == NULL) || !is_same_command(transmitter, orders, command, data);
    if (!differs || ((wanted_commands(orders) & agv_message_bit(command)) == 0u)) {
        return;
    }
    note_foreign(transmitter, command);
    if (agv_scheduler_override(&transmitter->scheduler, orders->timers->now_us, orders->config->override_gap_ms,
                               command) &&
        (!orders->passive || (transmitter->alone[command] >= ALONE_ENOUGH))) {
        override(transmitter, orders, command);
    }
}

/* Whether a command was forwarded less than half its cycle ago. The bit is cleared when that time is over. */
static bool is_too_soon(agv_transmitter_t *transmitter, uint32_t message, uint32_t now_ms) {
    if (message >= AGV_COMMAND_COUNT) {
        return false;
    }
    if ((2u * (now_ms - transmitter->passed_ms[message])) >= agv_message_cycle_ms(message)) {
        transmitter->passed_lately &= (uint8_t)~agv_message_bit(message);
    }
    return (transmitter->passed_lately & agv_message_bit(message)) != 0u;
}

static void note_passed(agv_transmitter_t *transmitter, uint32_t message, uint32_t now_ms) {
    transmitter->kept &= ~agv_message_bit(message);
    if (message < AGV_COMMAND_COUNT) {
        transmitter->throttle_0_waits =
            transmitter->throttle_0_waits && (message != (uint32_t)AGV_MSG_THROTTLE_COMMAND);
        transmitter->report.passed |= (uint8_t)agv_message_bit(message);
        transmitter->passed_lately |= (uint8_t)agv_message_bit(message);
        transmitter->passed_ms[message] = now_ms;
    }
}

/* Forward a frame, or keep it until it is due and the HAL accepts it. */
static void send_passed(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders, uint32_t message) {
    const uint32_t now_ms = orders->timers->now_ms;
    if (is_too_soon(transmitter, message, now_ms) ||
        send_message(transmitter, orders, message, transmitter->kept_data[message])) {
        transmitter->kept |= agv_message_bit(message);
    } else {
        note_passed(transmitter, message, now_ms);
    }
}

void agv_transmitter_drop(agv_transmitter_t *transmitter, agv_timers_t *timers, uint32_t command) {
    transmitter->kept &= ~agv_message_bit(command);
    transmitter->report.dropped++;
    agv_timer_stop(timers, waits[command]);
}

static void send_throttle_0(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders) {
    static const uint8_t throttle_0[AGV_DLC] = {0};
    transmitter->throttle_0_waits = !agv_bus_is_off(orders->timers, HAL_CAN_VEHICLE) &&
                                    send_message(transmitter, orders, AGV_MSG_THROTTLE_COMMAND, throttle_0);
}

void agv_transmitter_end_engagement(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders) {
    hal_can_purge(orders->hal, HAL_CAN_VEHICLE);
    repeat_status(transmitter, orders->timers);
    send_throttle_0(transmitter, orders);
}

const uint8_t *agv_transmitter_passed(const agv_transmitter_t *transmitter, uint32_t command) {
    return transmitter->kept_data[command];
}

void agv_transmitter_pass(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders, uint32_t message,
                          const uint8_t data[AGV_DLC]) {
    if ((transmitter->kept & agv_message_bit(message)) != 0u) {
        transmitter->report.dropped++; /* the older waiting one */
    }
    (void)memcpy(transmitter->kept_data[message], data, AGV_DLC);
    send_passed(transmitter, orders, message);
}

/*
 * Whether an override finds room at a tick: no such command came in the last ms, and none is to be expected. After a late tick,
 * those since the last one are older.
 */
static bool is_quiet(const agv_transmitter_t *transmitter, const agv_tx_orders_t *orders, uint32_t command) {
    const bool came = (transmitter->foreign_lately & agv_message_bit(command)) != 0u;
    const bool late = (orders->timers->now_ms - transmitter->tick_ms) > (uint32_t)TICK_USUAL_MS;
    return late || (!came && (transmitter->alone[command] < ALONE_ENOUGH));
}

static void forget_foreign(agv_transmitter_t *transmitter) {
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        if ((transmitter->alone[i] != 0u) && !came_lately(transmitter, i)) {
            transmitter->alone[i]--;
        }
    }
    transmitter->foreign_lately = (uint8_t)((uint32_t)transmitter->foreign_lately << LAST_TICK_SHIFT);
}

static void tick_own(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders, uint32_t command, uint32_t wanted) {
    const uint32_t slots = agv_scheduler_due(&transmitter->scheduler, orders->timers->now_ms, command);
    const bool foreign = agv_scheduler_override_due(&transmitter->scheduler, orders->timers->now_us,
                                                    orders->config->override_gap_ms, command);
    if ((wanted & agv_message_bit(command)) == 0u) {
        agv_timer_stop(orders->timers, waits[command]);
        agv_scheduler_answered(&transmitter->scheduler, command);
        return;
    }
    if (slots > 1u) {
        transmitter->report.skipped_slots += slots - 1u;
    }
    if (orders->passive && (slots != 0u)) {
        agv_scheduler_shift(&transmitter->scheduler, command);
    }
    if (foreign && (!orders->passive || is_quiet(transmitter, orders, command))) {
        override(transmitter, orders, command);
        return;
    }
    /* park: at_standstill held P back; 065h waits for its slot */
    const bool first_park =
        (command == (uint32_t)AGV_MSG_GEAR_COMMAND) && ((transmitter->wanted_before & agv_message_bit(command)) == 0u);
    if (first_park) {
        agv_scheduler_restart_slot(&transmitter->scheduler, orders->timers->now_ms, command);
    }
    if (first_park || (slots != 0u) || agv_timer_is_started(orders->timers, waits[command])) {
        send_own(transmitter, orders, command);
    }
}

/* Send a page of the status frame. Returns whether it must wait. */
static bool emit_status_page(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders, uint32_t page,
                             uint32_t content) {
    const bool tripped = orders->first_reason < (uint8_t)AGV_FAULT_COUNT;
    const uint32_t output = orders->output_closed ? 1u : 0u;
    uint8_t data[AGV_DLC] = {orders->state, tripped ? orders->first_reason : (uint8_t)AGV_STATUS_FRAME_NO_REASON,
                             (uint8_t)(output | (page << 4u)), transmitter->status_counter};
    for (uint32_t i = 0u; i < 4u; i++) {
        data[4u + i] = (uint8_t)(content >> (8u * i));
    }
    return emit(transmitter, orders, HAL_CAN_VEHICLE, orders->config->status_frame_id, data);
}

/*
 * By choice, two more frames follow every 256th one at once, with version and revision. They are left out if they would have
 * to wait.
 */
static void emit_version(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders) {
    const agv_version_t *const version = orders->version;
    if ((version != NULL) && (orders->config->status_version == (uint16_t)AGV_STATUS_VERSION_ON) &&
        (transmitter->status_counter == UINT8_MAX)) {
        const uint32_t number = version->major | ((uint32_t)version->minor << 8u) | ((uint32_t)version->patch << 16u);
        (void)emit_status_page(transmitter, orders, AGV_STATUS_PAGE_VERSION, number);
        (void)emit_status_page(transmitter, orders, AGV_STATUS_PAGE_REVISION, version->revision);
    }
}

/* Send the status frame (TOP-3). Returns whether it must wait. */
static bool emit_status_frame(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders) {
    if (emit_status_page(transmitter, orders, AGV_STATUS_PAGE_STATE, orders->config_checksum)) {
        return true;
    }
    emit_version(transmitter, orders);
    transmitter->status_counter++;
    transmitter->status_ms = orders->timers->now_ms;
    transmitter->status_again = false;
    return false;
}

/* Frames that the HAL did not accept are retried at every tick, which also tests the transmit path. */
void agv_transmitter_status(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders) {
    const agv_config_t *const config = orders->config;
    const uint32_t late_ms = orders->timers->now_ms - transmitter->status_due_ms;
    const bool due = late_ms <= (UINT32_MAX / 2u);
    bool has_to_wait = agv_timer_is_started(orders->timers, AGV_TIMER_TX_STATUS) || transmitter->status_again;
    if ((config->status_frame_id == 0u) || (config->shadow == (uint16_t)AGV_SHADOW_ON) ||
        agv_bus_is_off(orders->timers, HAL_CAN_VEHICLE)) {
        has_to_wait = false;
    } else if (due || has_to_wait) {
        has_to_wait = emit_status_frame(transmitter, orders);
    } else {
        /* not yet */
    }
    if (due) {
        transmitter->status_due_ms +=
            ((late_ms / config->status_frame_period_ms) + 1u) * config->status_frame_period_ms;
    }
    (void)agv_timer_while(orders->timers, AGV_TIMER_TX_STATUS, has_to_wait);
}

void agv_transmitter_tick(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders) {
    const uint32_t wanted = wanted_commands(orders);
    for (uint32_t i = 0u; ((transmitter->kept | transmitter->passed_lately) >> i) != 0u; i++) {
        if ((transmitter->kept & agv_message_bit(i)) != 0u) {
            send_passed(transmitter, orders, i);
        } else {
            (void)is_too_soon(transmitter, i, orders->timers->now_ms);
        }
    }
    if (transmitter->throttle_0_waits) {
        send_throttle_0(transmitter, orders);
    }
    if ((wanted | transmitter->wanted_before) != 0u) {
        for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
            tick_own(transmitter, orders, nth_command(i), wanted);
        }
    }
    transmitter->wanted_before = (uint8_t)wanted;
    forget_foreign(transmitter);
    transmitter->tick_ms = orders->timers->now_ms;
    agv_transmitter_status(transmitter, orders);
}

bool agv_transmitter_waits(const agv_timers_t *timers) {
    bool waiting = agv_timer_is_started(timers, AGV_TIMER_TX_STATUS);
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        waiting = waiting || agv_timer_is_started(timers, waits[i]);
    }
    return waiting;
}

bool agv_transmitter_is_stalled(const agv_timers_t *timers) {
    bool stalled = false;
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        if (agv_timer_reached(timers, waits[i])) {
            stalled = true;
        }
    }
    return stalled || agv_timer_reached(timers, AGV_TIMER_TX_STATUS);
}

bool agv_transmitter_has_report(const agv_transmitter_t *transmitter) {
    const agv_tx_report_t *const report = &transmitter->report;
    return ((uint32_t)report->sent | report->shadowed | report->refused | report->dropped | report->skipped_slots) !=
           0u;
}

agv_tx_report_t agv_transmitter_take_report(agv_transmitter_t *transmitter) {
    const agv_tx_report_t report = transmitter->report;
    transmitter->report = (agv_tx_report_t){0};
    return report;
}

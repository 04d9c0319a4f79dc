#include "rules.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "agv/protocol.h"
#include "frame_bytes.h"

enum { VEHICLE = 0, GEAR_STATUS, THROTTLE_STATUS, STEERING_STATUS, EPS_STATUS, POSITION, WHEELS };
/* STEP_MS: the longest permitted time between ticks, because only ticks check deadlines. A longer one trips (TIM-4). */
enum { HEARTBEAT_MS = 50, STEP_MS = 101, STATUS_MS = 60, GEAR_STATUS_MS = 125, CONFIRM_MS = 500, CONFIRMED_MS = 5000 };
/* LATELY_MS: ticks check the conditions of a reset, and of the time before a late one 10 ms count. */
enum { PRESS_MS = 1000, PRESS_MAX_MS = 5000, LATELY_MS = PRESS_MS - 10 };
enum { IDLE_COUNTS = 2, SLOW_COUNTS = 180, THROTTLE_COUNTS = 250, ENGAGED_ALONE = 0x80, MODE_BITS = 0xC0 };
enum { P = 8, CYCLE_MS = 100, PASSIVE_CYCLE_MS = 103, OVERRIDE_GAP_MS = 5 };

__attribute__((format(printf, 2, 3))) static void broken(rules_t *rules, const char *format, ...) {
    va_list arguments;
    if (rules->broken[0] == '\0') {
        va_start(arguments, format);
        (void)vsnprintf(rules->broken, sizeof rules->broken, format, arguments);
        va_end(arguments);
    }
}

static bool is_supervising(agv_state_t state) {
    return !commands_safe(state);
}

static int index_of(uint32_t id, const uint32_t ids[], int count) {
    for (int i = 0; i < count; i++) {
        if (ids[i] == id) {
            return i;
        }
    }
    return -1;
}

static int command_of(const rules_t *rules, uint32_t id) {
    const uint32_t ids[RULES_COMMANDS] = {rules->oracle.signal_id, 0x168u, 0x075u, 0x065u};
    return index_of(id, ids, RULES_COMMANDS);
}

static int status_of(const rules_t *rules, uint32_t id) {
    const uint32_t ids[RULES_STATUS] = {rules->oracle.vehicle_id, 0x0A3u, 0x050u, 0x067u, 0x167u, 0x267u, 0x101u};
    return index_of(id, ids, RULES_STATUS);
}

void rules_init(rules_t *rules, const agv_config_t *config) {
    memset(rules, 0, sizeof *rules);
    oracle_configure(&rules->oracle, config);
    rules->park_at_once = config->park == AGV_PARK_AT_ONCE;
    rules->shadow = config->shadow == AGV_SHADOW_ON;
    rules->running_heartbeat = config->own_heartbeat == AGV_OWN_HEARTBEAT_RUNNING;
    rules->limits_commands = (config->throttle_ceiling_pct != 100) || (config->steering_slew_ddeg_s != 0);
    rules->throttle_max = (uint8_t)(config->throttle_ceiling_pct * 250 / 100);
    rules->tx_stalled_ms = config->tx_stalled_ms;
    rules->watchdog_period_ms = config->watchdog_period_ms;
    rules->bus = (rules_bus_t){.takes_frames = true};
}

/* Clear both sums of FSM-4. */
static void forget_confirmation(rules_t *rules) {
    rules->was_engaged = false;
    rules->was_out_of_park = false;
    rules->engaged_sum_ms = 0;
    rules->no_park_sum_ms = 0;
    rules->unconfirmed_ms = rules->now_ms;
    rules->park_sent = false;
}

/* Clear everything but the statistics. */
static void clear_all_but_statistics(rules_t *rules, uint64_t now_ms) {
    rules->vcu = (rules_beat_t){.changed_ms = now_ms};
    rules->eps = (rules_beat_t){.changed_ms = now_ms};
    for (int i = 0; i < RULES_STATUS; i++) {
        rules->status_ms[i] = now_ms;
        rules->status_heard[i] = false;
    }
    for (int i = 0; i < RULES_COMMANDS; i++) {
        rules->command_heard[i] = false;
        rules->answer_owed[i] = false;
        rules->sent_ms[i] = now_ms;
    }
    rules->button_was_up = false;
    rules->button_down = false;
    rules->manual = false;
    rules->released = false;
    rules->fast_ms = now_ms;
    rules->throttle_high = false;
    rules->throttle_ms = now_ms;
    rules->gears_heard = 0;
    rules->mode_bits = 0;
    rules->ticked_ms = now_ms;
    forget_confirmation(rules);
    rules->commanding_ms = now_ms;
    rules->fed_ms = now_ms;
    rules->own_counter_known = false;
    oracle_restart(&rules->oracle);
}

/* FSM-7 */
static void check_start(rules_t *rules, hal_reset_cause_t cause, const rules_seen_t *before, const rules_seen_t *seen) {
    const bool power_on = cause == HAL_RESET_POWER_ON;
    const bool was_tripped = (before != NULL) && is_latched(before->state);
    if (seen->state != (power_on ? AGV_STATE_INIT : AGV_STATE_TRIPPED)) {
        broken(rules, "FSM-7: after reset cause %d the supervisor starts in state %02Xh", (int)cause,
               (unsigned)seen->state);
    }
    if (!power_on && (seen->first_reason != (was_tripped ? before->first_reason : AGV_FAULT_SUPERVISOR_RESET))) {
        broken(rules, "FSM-7: after a reset the first reason is %s", agv_fault_name(seen->first_reason));
    }
    if (seen->output_closed) {
        broken(rules, "FSM-4: the safety output is closed after a start");
    }
}

void rules_started(rules_t *rules, hal_reset_cause_t cause, const rules_seen_t *before, const rules_seen_t *seen,
                   uint64_t now_ms) {
    check_start(rules, cause, before, seen);
    rules->now_ms = now_ms;
    clear_all_but_statistics(rules, now_ms);
    rules->last = *seen;
    oracle_returned(&rules->oracle, seen->state);
}

/* ---- Received frames ---- */

static void on_counter(rules_beat_t *beat, uint8_t counter, uint64_t stamp_ms) {
    if (beat->heard && (beat->counter != counter)) {
        beat->changed_ms = stamp_ms;
    }
    beat->heard = true;
    beat->counter = counter;
}

static void on_mode(rules_t *rules, uint8_t byte7, uint64_t stamp_ms) {
    const bool manual = (byte7 & 0xC0u) == 0x40u;
    if (((byte7 & 0xC0u) != 0xC0u) && (manual != rules->manual)) {
        rules->manual = manual;
        rules->manual_ms = stamp_ms;
    }
    rules->mode_bits = byte7 & (uint8_t)MODE_BITS;
}

static void on_button(rules_t *rules, bool down) {
    if (!down) {
        rules->released = rules->button_down && rules->button_was_up;
        rules->press_ms = rules->now_ms - rules->pressed_ms;
        rules->button_was_up = true;
    } else if (!rules->button_down) {
        rules->pressed_ms = rules->now_ms;
    } else {
        /* held */
    }
    rules->button_down = down;
}

/* Idle is up to 2 counts; an invalid value is not used. */
static void on_throttle(rules_t *rules, uint8_t counts) {
    const bool before = rules->throttle_high;
    if (counts <= THROTTLE_COUNTS) {
        rules->throttle_high = counts > IDLE_COUNTS;
    }
    rules->throttle_ms = (before || rules->throttle_high) ? rules->now_ms : rules->throttle_ms;
}

static void on_status(rules_t *rules, int status, const hal_can_frame_t *frame, uint64_t stamp_ms) {
    const uint8_t *data = frame->data;
    rules->status_ms[status] = stamp_ms;
    rules->status_heard[status] = true;
    memcpy(rules->status_data[status], data, 8);
    switch (status) {
    case VEHICLE:
        on_counter(&rules->vcu, data[7], stamp_ms);
        on_mode(rules, data[6], stamp_ms);
        on_button(rules, (data[6] & 1) != 0);
        rules->fast_ms = (word_at(data) > SLOW_COUNTS) ? stamp_ms : rules->fast_ms;
        rules->alarm = (data[4] & 0xB3u) != 0; /* bits 0, 1, 4, 5, 7 */
        break;
    case THROTTLE_STATUS:
        on_throttle(rules, data[0]);
        break;
    case STEERING_STATUS:
        on_counter(&rules->eps, data[0], stamp_ms);
        break;
    case EPS_STATUS:
        rules->alarm = (data[7] & 0xE8u) != 0; /* bits 4, 6, 7, 8 in the protocol document */
        break;
    case WHEELS:
        rules->fast_ms = (is_fast(&data[0]) || is_fast(&data[4])) ? stamp_ms : rules->fast_ms;
        break;
    default:
        break;
    }
}

static void on_command(rules_t *rules, int command, const hal_can_frame_t *frame) {
    if (in_range(command, frame->data)) {
        memcpy(rules->command_data[command], frame->data, 8);
        clear_reserved(command, rules->command_data[command]);
        rules->command_heard[command] = true;
        rules->gears_heard |= (command == GEAR) ? frame->data[0] : 0;
    }
}

/* While error-passive, behind the last one of a burst: each further command begins the time anew. */
static void require_override(rules_t *rules, int command, const hal_can_frame_t *frame, uint64_t stamp_ms) {
    const bool sends_it = (command == SIGNALS) || (command == THROTTLE) || ((command == GEAR) && rules->park_at_once);
    if (sends_it && (frame->flags == 0) && commands_safe(rules->last.state) && differs_from_safe(command, frame) &&
        (!rules->answer_owed[command] || rules->bus.is_passive)) {
        rules->answer_owed[command] = true;
        rules->answer_owed_ms[command] = (stamp_ms > rules->now_ms) ? stamp_ms : rules->now_ms;
    }
}

void rules_heard(rules_t *rules, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t stamp_ms) {
    const int command = command_of(rules, frame->id);
    const int status = status_of(rules, frame->id);
    const bool whole = (frame->flags == 0) && (frame->length == 8);
    rules->now_ms = (stamp_ms > rules->now_ms) ? stamp_ms : rules->now_ms;
    rules->sent_now = 0;
    rules->alarm = false;
    rules->released = false;
    oracle_heard(&rules->oracle, side, frame);
    if (whole && (status >= 0) && (side == HAL_CAN_VEHICLE)) {
        on_status(rules, status, frame, stamp_ms);
    }
    if (command < 0) {
        return;
    }
    if (whole && (side == (rules->oracle.gateway ? HAL_CAN_AI : HAL_CAN_VEHICLE))) {
        on_command(rules, command, frame);
    }
    if (side == HAL_CAN_VEHICLE) {
        require_override(rules, command, frame, stamp_ms);
    }
}

void rules_ticks(rules_t *rules, uint64_t now_ms, rules_bus_t bus) {
    rules->now_ms = now_ms;
    rules->bus = bus;
    rules->passive_ms = bus.is_passive ? now_ms : rules->passive_ms;
    rules->sent_now = 0;
    rules->alarm = false;
    rules->released = false;
}

/* ---- Sent frames ---- */

/* TOP-2: a forwarded frame has the bytes of the last received one; a command has reserved bits cleared, and may be
 * limited. */
static void check_passed(rules_t *rules, hal_can_side_t side, const hal_can_frame_t *frame, agv_state_t state) {
    const int status = status_of(rules, frame->id);
    const int command = command_of(rules, frame->id);
    if (side == HAL_CAN_AI) {
        if ((status < 0) || !rules->status_heard[status] || (memcmp(rules->status_data[status], frame->data, 8) != 0)) {
            broken(rules, "TOP-2: %03X was sent to the AI side, but not received with these bytes",
                   (unsigned)frame->id);
        }
        return;
    }
    if ((command < 0) || commands_safe(state)) {
        return;
    }
    if ((command == THROTTLE) && (frame->data[0] == 0)) {
        return; /* throttle 0 at the end of an engagement, or of STANDBY, sent late */
    }
    uint8_t expected[8];
    memcpy(expected, rules->command_data[command], 8);
    if ((command == GEAR) && ((rules->gears_heard & frame->data[0]) != 0)) {
        expected[0] = frame->data[0]; /* a later gear command may have been dropped because the vehicle was moving */
    }
    if (command == THROTTLE) {
        const uint8_t most = (state == AGV_STATE_ACTIVE) ? rules->throttle_max : 0;
        expected[0] = (expected[0] < most) ? expected[0] : most;
    }
    const bool same = memcmp(expected, frame->data, 8) == 0;
    if (!rules->command_heard[command] || (!same && ((command != STEERING) || !rules->limits_commands))) {
        broken(rules, "TOP-2: %03X was sent to the vehicle side, but not received with these bytes",
               (unsigned)frame->id);
    }
}

/* FSM-8: the supervisor's alive counter increases by one. */
static void check_own_counter(rules_t *rules, uint8_t counter) {
    if (rules->own_counter_known && ((counter != rules->own_counter) != rules->running_heartbeat)) {
        broken(rules, "FSM-8: the own alive counter was %u and is %u", rules->own_counter, counter);
    }
    rules->own_counter = counter;
    rules->own_counter_known = true;
}

void rules_sent(rules_t *rules, hal_can_side_t side, const hal_can_frame_t *frame, agv_state_t state) {
    const int command = command_of(rules, frame->id);
    const uint32_t forbidden = rules->oracle.forbidden;
    rules->sent++;
    oracle_sent(&rules->oracle, side, frame, state);
    if (rules->oracle.forbidden != forbidden) {
        broken(rules, "FSM-6: %s", oracle_verdict(&rules->oracle));
    }
    if (rules->shadow) {
        broken(rules, "TOP-4: %03X was sent in shadow mode", (unsigned)frame->id);
    }
    if (rules->oracle.gateway) {
        check_passed(rules, side, frame, state);
    }
    if ((command >= 0) && (side == HAL_CAN_VEHICLE)) {
        rules->sent_now |= (uint8_t)(1u << (unsigned)command);
        rules->sent_ms[command] = rules->now_ms;
        rules->answer_owed[command] = false;
        if ((command == SIGNALS) && commands_safe(state)) {
            check_own_counter(rules, frame->data[7]);
        }
        rules->park_sent = rules->park_sent || ((command == GEAR) && is_latched(state));
    }
}

/* ---- Required reactions ---- */

static uint64_t age_ms(const rules_t *rules, uint64_t then_ms) {
    return (rules->now_ms > then_ms) ? (rules->now_ms - then_ms) : 0;
}

/* SUP-2, SUP-3: while supervising, silence must trip. Only a tick checks the clock. */
static void check_silence(rules_t *rules) {
    static const uint64_t LIMITS[RULES_STATUS] = {HEARTBEAT_MS, GEAR_STATUS_MS, STATUS_MS, HEARTBEAT_MS,
                                                  STATUS_MS,    UINT64_MAX,     STATUS_MS}; /* 267h only warns */
    if ((age_ms(rules, rules->vcu.changed_ms) > HEARTBEAT_MS) ||
        (age_ms(rules, rules->eps.changed_ms) > HEARTBEAT_MS)) {
        broken(rules,
               "SUP-2: the heartbeat of the VCU is %u ms old, of the EPS %u ms, and the supervisor has not tripped",
               (unsigned)age_ms(rules, rules->vcu.changed_ms), (unsigned)age_ms(rules, rules->eps.changed_ms));
    }
    for (int i = 0; i < RULES_STATUS; i++) {
        if (age_ms(rules, rules->status_ms[i]) > LIMITS[i]) {
            broken(rules, "SUP-3: status %d is %u ms old, and the supervisor has not tripped", i,
                   (unsigned)age_ms(rules, rules->status_ms[i]));
        }
    }
}

/* FSM-2: all safe commands are sent in the call that trips. */
static void check_trip(rules_t *rules) {
    const uint8_t needed = (uint8_t)((1u << SIGNALS) | (1u << THROTTLE) | (rules->park_at_once ? (1u << GEAR) : 0));
    rules->trips++;
    rules->button_was_up = rules->status_heard[VEHICLE] && !rules->button_down; /* the next press is a new one */
    forget_confirmation(rules);
    rules->park_sent = (rules->sent_now & (1u << GEAR)) != 0;
    rules->own_counter_known = false;
    rules->commanding_ms = rules->now_ms;
    if (rules->bus.takes_frames && !rules->shadow && ((rules->sent_now & needed) != needed)) {
        broken(rules, "FSM-2: only the safe commands %X were sent in the call that tripped", rules->sent_now);
    }
}

/* FSM-3 */
static void check_reset(rules_t *rules) {
    const char *missing = NULL;
    rules->resets++;
    if ((rules->last.state != AGV_STATE_SAFE) || (age_ms(rules, rules->safe_ms) < LATELY_MS)) {
        missing = "SAFE for a second";
    } else if (!rules->released || (rules->press_ms < PRESS_MS) || (rules->press_ms > PRESS_MAX_MS)) {
        missing = "the button, pressed after the trip, held for 1 s to 5 s and released";
    } else if (!rules->manual || (age_ms(rules, rules->manual_ms) < LATELY_MS)) {
        missing = "manual for a second";
    } else if (age_ms(rules, rules->fast_ms) < LATELY_MS) {
        missing = "standstill for a second";
    } else if (rules->throttle_high || (age_ms(rules, rules->throttle_ms) < LATELY_MS)) {
        missing = "throttle at idle for a second";
    } else if ((age_ms(rules, rules->vcu.changed_ms) > HEARTBEAT_MS + STEP_MS) ||
               (age_ms(rules, rules->eps.changed_ms) > HEARTBEAT_MS + STEP_MS)) {
        missing = "an alive VCU and EPS";
    } else {
        return;
    }
    broken(rules, "FSM-3: the latch was left without %s", missing);
}

static void check_state(rules_t *rules, const rules_seen_t *seen) {
    const rules_seen_t *last = &rules->last;
    if (!is_latched(last->state) && is_latched(seen->state)) {
        check_trip(rules);
    }
    if (is_latched(last->state) && !is_latched(seen->state)) {
        if (seen->state != AGV_STATE_STANDBY) {
            broken(rules, "FSM-3: the latch was left for state %02Xh", (unsigned)seen->state);
        }
        check_reset(rules);
    }
    if ((last->state != AGV_STATE_INIT) && (seen->state == AGV_STATE_INIT)) {
        broken(rules, "back to INIT from %02Xh", (unsigned)last->state);
    }
    if (is_latched(seen->state) != (seen->first_reason != AGV_FAULT_NONE)) {
        broken(rules, "FSM-5: state %02Xh with first reason %s", (unsigned)seen->state,
               agv_fault_name(seen->first_reason));
    }
    if (is_latched(last->state) && is_latched(seen->state) && (last->first_reason != seen->first_reason)) {
        broken(rules, "FSM-5: the first reason was %s and is %s", agv_fault_name(last->first_reason),
               agv_fault_name(seen->first_reason));
    }
    if ((seen->state == AGV_STATE_SAFE) && (last->state != AGV_STATE_SAFE)) {
        rules->safe_ms = rules->now_ms;
    }
    if (rules->alarm && is_supervising(seen->state)) {
        broken(rules, "SUP-4: a fault bit was received in state %02Xh, and the supervisor has not tripped",
               (unsigned)last->state);
    }
}

/*
 * FSM-4: conditions that keep the output open in every state (SUP-7, TIM-3). Only a tick checks the controller and the
 * clock. The values before the tick count, because a trip discards waiting frames, and the tick feeds the watchdog
 * last.
 */
static void check_closed(rules_t *rules, const rules_seen_t *seen) {
    static const agv_fault_t OPENING[] = {AGV_FAULT_BUS_OFF, AGV_FAULT_TX_STALLED, AGV_FAULT_SAFE_STATE_UNCONFIRMED,
                                          AGV_FAULT_VEHICLE_NOT_STOPPING, AGV_FAULT_MOVING_WHILE_SAFE};
    for (unsigned i = 0; i < sizeof OPENING / sizeof OPENING[0]; i++) {
        if (agv_fault_is_in(&seen->active, OPENING[i])) {
            broken(rules, "FSM-4: the safety output is closed, and %s is active", agv_fault_name(OPENING[i]));
        }
    }
    if (rules->bus.is_bus_off) {
        broken(rules, "FSM-4: the safety output is closed in bus-off");
    }
    if (rules->bus.tx_pending_ms > rules->tx_stalled_ms) {
        broken(rules, "FSM-4: the safety output is closed, and a frame has not been sent for %u ms",
               (unsigned)rules->bus.tx_pending_ms);
    }
    if (age_ms(rules, rules->fed_ms) > (rules->watchdog_period_ms + 1u)) {
        broken(rules, "FSM-4: the safety output is closed, and the watchdog has not been fed for %u ms",
               (unsigned)age_ms(rules, rules->fed_ms));
    }
}

/*
 * FSM-4: two sums of time. In the first autopilot was reported, in the second P was commanded and not reported by a
 * fresh 0A3h. Only time in which two successive ticks found it is counted. Five seconds without either may have cleared
 * the sums.
 */
static void add_up_confirmation(rules_t *rules) {
    const uint64_t gap_ms = age_ms(rules, rules->ticked_ms);
    const bool engaged = rules->status_heard[VEHICLE] && (rules->mode_bits == ENGAGED_ALONE);
    const bool in_park = rules->status_heard[GEAR_STATUS] && (rules->status_data[GEAR_STATUS][0] == (uint8_t)P) &&
                         (age_ms(rules, rules->status_ms[GEAR_STATUS]) <= GEAR_STATUS_MS);
    const bool out_of_park = rules->park_sent && !in_park;
    rules->engaged_sum_ms += (engaged && rules->was_engaged) ? gap_ms : 0;
    rules->no_park_sum_ms += (out_of_park && rules->was_out_of_park) ? gap_ms : 0;
    if (engaged || out_of_park) {
        rules->unconfirmed_ms = rules->now_ms;
    } else if (age_ms(rules, rules->unconfirmed_ms) >= (CONFIRMED_MS - STEP_MS)) {
        rules->engaged_sum_ms = 0;
        rules->no_park_sum_ms = 0;
    } else {
        /* not yet */
    }
    rules->was_engaged = engaged;
    rules->was_out_of_park = out_of_park;
}

static void check_confirmation(rules_t *rules) {
    if ((rules->engaged_sum_ms > CONFIRM_MS) || (rules->no_park_sum_ms > CONFIRM_MS)) {
        broken(rules, "FSM-4: the safety output is closed after %u ms of autopilot and %u ms without P since the trip",
               (unsigned)rules->engaged_sum_ms, (unsigned)rules->no_park_sum_ms);
    }
}

/* FSM-4. In STANDBY and ACTIVE the output is closed again at the next tick if the port did not close it before (HW-1). */
static void check_output(rules_t *rules, const rules_seen_t *seen, bool tick) {
    const bool closes = (seen->state == AGV_STATE_STANDBY) || (seen->state == AGV_STATE_ACTIVE);
    if (seen->output_closed && !rules->last.output_closed && !closes) {
        broken(rules, "FSM-4: the safety output has closed in state %02Xh", (unsigned)seen->state);
    }
    if (!seen->output_closed) {
        return;
    }
    if (seen->state == AGV_STATE_INIT) {
        broken(rules, "FSM-4: the safety output is closed in INIT");
    }
    if (tick) {
        check_closed(rules, seen);
    }
    if (tick && is_latched(seen->state)) {
        check_confirmation(rules);
    }
}

/* TIM-1, TOP-1: safe commands are sent on their cycles, and other senders' commands are overridden. */
static void check_sending(rules_t *rules, const rules_seen_t *seen, uint64_t tick_gap_ms) {
    const bool able = rules->bus.takes_frames && !rules->shadow && commands_safe(seen->state);
    if (!able || !commands_safe(rules->last.state)) {
        rules->commanding_ms = rules->now_ms;
        memset(rules->answer_owed, 0, sizeof rules->answer_owed);
        return;
    }
    const bool was_passive = age_ms(rules, rules->passive_ms) <= PASSIVE_CYCLE_MS;
    const uint64_t cycle_ms = was_passive ? PASSIVE_CYCLE_MS : CYCLE_MS;
    for (int i = 0; i <= THROTTLE; i++) {
        const bool sends_it = (i != GEAR) || rules->park_at_once;
        const uint64_t since_ms = (rules->sent_ms[i] > rules->commanding_ms) ? rules->sent_ms[i] : rules->commanding_ms;
        if (sends_it && (age_ms(rules, since_ms) > cycle_ms + tick_gap_ms)) {
            broken(rules, "TIM-1: safe command %d has not been sent for %u ms", i, (unsigned)age_ms(rules, since_ms));
        }
        if (rules->answer_owed[i] && (age_ms(rules, rules->answer_owed_ms[i]) > OVERRIDE_GAP_MS + tick_gap_ms)) {
            broken(rules, "TOP-1: another sender's command was not overridden (command %d)", i);
        }
    }
}

void rules_returned(rules_t *rules, const rules_seen_t *seen, bool tick, uint64_t tick_gap_ms) {
    rules->calls++;
    check_state(rules, seen);
    if (tick && is_latched(seen->state)) {
        add_up_confirmation(rules);
    }
    rules->ticked_ms = tick ? rules->now_ms : rules->ticked_ms;
    check_output(rules, seen, tick);
    if (tick && is_supervising(seen->state)) {
        check_silence(rules);
    }
    if (tick && (seen->state == AGV_STATE_ACTIVE) && (agv_fault_first(&seen->trips) != AGV_FAULT_NONE)) {
        broken(rules, "FSM-11: ACTIVE with the trip cause %s", agv_fault_name(agv_fault_first(&seen->trips)));
    }
    if (tick) {
        check_sending(rules, seen, tick_gap_ms);
    }
    if (seen->gate_refused != rules->last.gate_refused) {
        broken(rules, "INT-4: the gate refused a frame in state %02Xh", (unsigned)seen->state);
    }
    if (agv_fault_is_in(&seen->active, AGV_FAULT_MEMORY_CORRUPTED)) {
        broken(rules, "INT-5: memory corruption was detected, but no test changed the memory");
    }
    if (seen->watchdog_feeds != rules->last.watchdog_feeds) {
        rules->fed_ms = rules->now_ms;
    }
    rules->last = *seen;
    oracle_returned(&rules->oracle, seen->state);
}

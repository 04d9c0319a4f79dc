/* What may not last too long: the deviations and the modes (SUP-9 to SUP-12). */
#include <stdlib.h>

#include "agv/codec.h"
#include "text/units.h"
#include "why/why_internal.h"

enum { THROTTLE_DROP = 25, MM_S_PER_18_COUNTS = 5, SPEED_SLACK_MM_S = 500, SPEED_SHARE = 4, WHEEL_MAX_MM_S = 1000000 };
enum { MOVING_MM_S = 100, ANY_SPEED = 65535 };

#define BIT_OF(message) (1u << (uint32_t)(message))

static uint32_t mode_bits(const why_t *why) {
    return why->facts.mode_bits & (AGV_VCU_FLAG_MANUAL | AGV_VCU_FLAG_AUTOPILOT);
}

static int32_t off_by(const why_t *why, uint32_t angle_raw) {
    return abs((int32_t)angle_raw - (int32_t)why->facts.angle_command_raw);
}

static bool steering_is_off(const why_t *why) {
    return why->facts.angle_known && why->facts.command_known[AGV_MSG_STEERING_COMMAND] &&
           (off_by(why, why->facts.angle_raw) > (int32_t)why->config.steering_deviation_ddeg);
}

static bool throttle_is_above(const why_t *why) {
    return why->facts.command_known[AGV_MSG_THROTTLE_COMMAND] &&
           (why->facts.throttle > why->facts.throttle_command + why->config.throttle_deviation_counts);
}

static bool is_above_idle(const why_t *why) {
    return why->facts.throttle > why->config.throttle_idle_counts;
}

static bool is_driven_in_another_gear(const why_t *why) {
    const uint32_t gear = why->facts.gear;
    return why->facts.command_known[AGV_MSG_GEAR_COMMAND] && ((gear == AGV_GEAR_D) || (gear == AGV_GEAR_R)) &&
           (gear != why->facts.gear_command) && is_above_idle(why);
}

static bool off_is_ignored(const why_t *why) {
    return why->facts.command_known[AGV_MSG_TURN_SIGNAL_COMMAND] && why->facts.autopilot_off;
}

static bool is_throttle_in_park(const why_t *why) {
    return (why->facts.gear == AGV_GEAR_P) && is_above_idle(why);
}

static int32_t clamp(int32_t value, int32_t limit) {
    return (value > limit) ? limit : ((value < -limit) ? -limit : value);
}

static bool speeds_differ(const why_t *why) {
    const int32_t left = clamp(why->facts.left_mm_s, WHEEL_MAX_MM_S);
    const int32_t right = clamp(why->facts.right_mm_s, WHEEL_MAX_MM_S);
    const int32_t wheels = abs(left + right) / 2;
    const int32_t vcu = ((int32_t)why->facts.vcu_speed * MM_S_PER_18_COUNTS) / 18;
    const int32_t larger = (wheels > vcu) ? wheels : vcu;
    return why->facts.speed_known && why->facts.vcu_speed_seen &&
           (abs(wheels - vcu) > SPEED_SLACK_MM_S + (larger / SPEED_SHARE));
}

static bool has_both_modes(const why_t *why) {
    return mode_bits(why) == (AGV_VCU_FLAG_MANUAL | AGV_VCU_FLAG_AUTOPILOT);
}

/** Neither bit, both bits, and manual while engaged. */
static bool is_no_mode(const why_t *why) {
    const uint32_t bits = mode_bits(why);
    return (bits != AGV_VCU_FLAG_AUTOPILOT) && ((bits != AGV_VCU_FLAG_MANUAL) || why->engagement.engaged);
}

static bool has_no_mode(const why_t *why) {
    const int32_t slow = why->config.standstill_speed_mm_s;
    const bool wheels_turn = (abs(why->facts.left_mm_s) >= slow) || (abs(why->facts.right_mm_s) >= slow);
    const uint32_t limit = why->config.standstill_vcu_counts;
    const bool vcu_moves = (limit != ANY_SPEED) && (why->facts.vcu_speed > limit);
    return why->facts.mode_known && is_no_mode(why) && (wheels_turn || vcu_moves);
}

/** A wheel turns, or 363h contradicts standing wheels. */
static bool may_move(const why_t *why) {
    return (abs(why->facts.left_mm_s) >= MOVING_MM_S) || (abs(why->facts.right_mm_s) >= MOVING_MM_S) ||
           (why->faults[AGV_FAULT_SPEED_IMPLAUSIBLE].active && speeds_differ(why));
}

/** A budget: its condition depends on these messages. */
typedef struct {
    agv_fault_t fault;
    bool judged;
    uint32_t messages;
    uint16_t setting; /**< of its time; WHY_NO_SETTING: WHY_MOVING_MS */
    bool (*is_bad)(const why_t *why);
} row_t;

static const row_t rows[] = {
    {AGV_FAULT_STEERING_DEVIATION, true, BIT_OF(AGV_MSG_STEERING_STATUS) | BIT_OF(AGV_MSG_STEERING_COMMAND),
     AGV_SETTING_steering_deviation_ms, steering_is_off},
    {AGV_FAULT_THROTTLE_DEVIATION, true, BIT_OF(AGV_MSG_THROTTLE_STATUS) | BIT_OF(AGV_MSG_THROTTLE_COMMAND),
     AGV_SETTING_throttle_deviation_ms, throttle_is_above},
    {AGV_FAULT_GEAR_DEVIATION, true,
     BIT_OF(AGV_MSG_GEAR_STATUS) | BIT_OF(AGV_MSG_THROTTLE_STATUS) | BIT_OF(AGV_MSG_GEAR_COMMAND),
     AGV_SETTING_gear_deviation_ms, is_driven_in_another_gear},
    {AGV_FAULT_AUTOPILOT_OFF_IGNORED, true, BIT_OF(AGV_MSG_TURN_SIGNAL_COMMAND), AGV_SETTING_autopilot_off_ms,
     off_is_ignored},
    {AGV_FAULT_THROTTLE_IN_PARK, true, BIT_OF(AGV_MSG_THROTTLE_STATUS) | BIT_OF(AGV_MSG_GEAR_STATUS),
     AGV_SETTING_throttle_in_park_ms, is_throttle_in_park},
    {AGV_FAULT_SPEED_IMPLAUSIBLE, false, BIT_OF(AGV_MSG_WHEEL_SPEED) | BIT_OF(AGV_MSG_VEHICLE_STATUS),
     AGV_SETTING_speed_implausible_ms, speeds_differ},
    {AGV_FAULT_MODE_INVALID, false, BIT_OF(AGV_MSG_VEHICLE_STATUS), AGV_SETTING_mode_invalid_ms, has_both_modes},
    {AGV_FAULT_MODE_NONE, false, BIT_OF(AGV_MSG_VEHICLE_STATUS) | BIT_OF(AGV_MSG_WHEEL_SPEED), AGV_SETTING_mode_none_ms,
     has_no_mode},
    {AGV_FAULT_MOVING_WHILE_SAFE, false, BIT_OF(AGV_MSG_WHEEL_SPEED) | BIT_OF(AGV_MSG_VEHICLE_STATUS), WHY_NO_SETTING,
     may_move},
};

enum { ROWS = sizeof rows / sizeof rows[0] };

static uint64_t budget_limit_us(const why_t *why, const row_t *row) {
    const uint32_t limit_ms =
        (row->setting != WHY_NO_SETTING) ? agv_config_get(&why->config, row->setting) : WHY_MOVING_MS;
    return (uint64_t)limit_ms * US_PER_MS;
}

uint64_t why_budget_us(const why_t *why, agv_fault_t fault) {
    for (size_t i = 0; i < ROWS; i++) {
        if (rows[i].fault == fault) {
            return budget_limit_us(why, &rows[i]);
        }
    }
    return 0;
}

/** From when on a budget counts; WHY_NEVER: it does not. A movement counts once the vehicle has stood since the trip. */
static uint64_t budget_counts_from(const why_t *why, const row_t *row) {
    const why_trip_t *trip = why_open_trip(why);
    if (row->is_bad == may_move) {
        return (trip != NULL) ? trip->stopped_us : WHY_NEVER;
    }
    return row->judged ? why_judged_us(why) : 0;
}

/** D or R is commanded, and not reported. */
static bool gear_is_awaited(const why_t *why) {
    return (why->facts.gear_command <= AGV_GEAR_R) && (why->facts.gear != why->facts.gear_command);
}

/** At idle an awaited gear does not take. */
static bool shows_nothing(const why_t *why, const row_t *row) {
    return !is_above_idle(why) && (row->is_bad == is_driven_in_another_gear) && gear_is_awaited(why);
}

/** Count the time since the last call: a bad microsecond adds 2, a good one takes 1. */
static void count(const why_t *why, const row_t *row, why_tracker_t *tracker, uint64_t t_us) {
    const uint64_t counts_us = budget_counts_from(why, row);
    const uint64_t from_us = (tracker->since_us > counts_us) ? tracker->since_us : counts_us;
    const uint64_t full = 2 * budget_limit_us(why, row);
    if (from_us < t_us) {
        const uint64_t elapsed_us = t_us - from_us;
        if (tracker->bad) {
            tracker->began_us = (tracker->value == 0) ? tracker->bad_since_us : tracker->began_us;
            tracker->value += 2 * elapsed_us;
            tracker->value = (tracker->value < full) ? tracker->value : full;
        } else if (!shows_nothing(why, row)) {
            tracker->value -= (tracker->value > elapsed_us) ? elapsed_us : tracker->value;
        }
    }
    tracker->since_us = t_us;
}

void why_budget_advance(why_t *why, uint64_t t_us) {
    for (size_t i = 0; i < ROWS; i++) {
        why_tracker_t *tracker = &why->trackers[rows[i].fault];
        if (tracker->bad || (tracker->value != 0)) {
            count(why, &rows[i], tracker, t_us);
        }
    }
}

void why_budget_engage(why_t *why) {
    for (size_t i = 0; i < ROWS; i++) {
        if (rows[i].judged) {
            why->trackers[rows[i].fault] = (why_tracker_t){.good = why_no_evidence(), .first = why_no_evidence()};
        }
    }
    why->facts.steering_progress = (why_progress_t){0};
    why->facts.throttle_progress = (why_progress_t){0};
    for (size_t i = 0; i < AGV_COMMAND_COUNT; i++) {
        why->facts.command_known[i] = false;
    }
}

/** For as long as a full budget decays, within the limit, steps back count after progress has cleared it. */
static void follow_steps_back(why_progress_t *progress, bool bad, uint64_t full_us, uint64_t t_us) {
    const uint64_t elapsed_us = t_us - progress->at_us;
    progress->at_us = t_us;
    if (progress->steps_back_us == 0) {
        return;
    }
    const uint64_t left_us = progress->steps_back_us;
    progress->steps_back_us = bad ? full_us : ((left_us > elapsed_us) ? (left_us - elapsed_us) : 0);
}

static int32_t beyond(int32_t off, int32_t limit) {
    return (off > limit) ? (off - limit) : 0;
}

/** How far a value is off its command, before and after it moved, and how far it may be. */
typedef struct {
    int32_t before, now, limit;
} step_t;

/** While the budget is 0, only steps back are kept, and those only if progress has just cleared it. */
static void restart_progress(const why_tracker_t *tracker, why_progress_t *progress) {
    const bool steps_back_count = progress->steps_back_us != 0;
    if (tracker->value == 0) {
        progress->gained = (steps_back_count && (progress->gained < 0)) ? progress->gained : 0;
        progress->gained_beyond = (steps_back_count && (progress->gained_beyond < 0)) ? progress->gained_beyond : 0;
    }
}

/** Count the part of a step that is farther from the command than the limit. */
static void add_step(int32_t *gained, step_t step, int32_t limit, bool judged, bool steps_back_count) {
    const int32_t nearer = beyond(step.before, limit) - beyond(step.now, limit);
    if (judged || (steps_back_count && (nearer < 0))) {
        *gained += nearer;
    }
}

/** Progress towards what is commanded clears a budget. */
static void follow_progress(why_t *why, agv_fault_t fault, why_progress_t *progress, step_t step, int32_t enough,
                            uint64_t t_us) {
    why_tracker_t *tracker = &why->trackers[fault];
    const uint64_t full_us = 2 * why_budget_us(why, fault);
    follow_steps_back(progress, tracker->bad, full_us, t_us);
    restart_progress(tracker, progress);
    const bool steps_back_count = progress->steps_back_us != 0;
    const bool judged = t_us >= why_judged_us(why);
    add_step(&progress->gained, step, 0, judged, steps_back_count);
    if (steps_back_count) {
        add_step(&progress->gained_beyond, step, step.limit, judged, true);
    }
    const bool is_enough = (progress->gained >= enough) || (progress->gained_beyond >= enough);
    if ((tracker->value != 0) && is_enough) {
        tracker->value = 0;
        tracker->since_us = t_us;
        tracker->bad_since_us = t_us;
        progress->steps_back_us = full_us;
    }
    restart_progress(tracker, progress);
}

static void take_angle(why_t *why, const why_evidence_t *frame) {
    const uint32_t before = why->facts.angle_raw;
    const bool known = why->facts.angle_known;
    why->facts.angle_raw = agv_angle_read(&frame->frame.data[2]);
    why->facts.angle_known = true;
    if (known && why->facts.command_known[AGV_MSG_STEERING_COMMAND]) {
        const step_t step = {.before = off_by(why, before),
                             .now = off_by(why, why->facts.angle_raw),
                             .limit = (int32_t)why->config.steering_deviation_ddeg};
        follow_progress(why, AGV_FAULT_STEERING_DEVIATION, &why->facts.steering_progress, step,
                        (int32_t)why->config.steering_gain_ddeg, frame->t_us);
    }
}

static void take_throttle(why_t *why, const why_evidence_t *frame) {
    const uint32_t before = why->facts.throttle;
    why->facts.throttle = frame->frame.data[0];
    const int32_t commanded = (int32_t)why->facts.throttle_command;
    const step_t step = {.before = (int32_t)before - commanded,
                         .now = (int32_t)why->facts.throttle - commanded,
                         .limit = (int32_t)why->config.throttle_deviation_counts};
    follow_progress(why, AGV_FAULT_THROTTLE_DEVIATION, &why->facts.throttle_progress, step, THROTTLE_DROP, frame->t_us);
}

static void take_wheels(why_t *why, const uint8_t *data) {
    agv_wheel_speed_t wheels;
    (void)agv_unpack_wheel_speed(&wheels, data);
    why->facts.left_mm_s = clamp(wheels.left_mm_s, WHEEL_MAX_MM_S);
    why->facts.right_mm_s = clamp(wheels.right_mm_s, WHEEL_MAX_MM_S);
    why->facts.speed_known = true;
}

static void take_vehicle(why_t *why, const uint8_t *data) {
    agv_vehicle_status_t status;
    (void)agv_unpack_vehicle_status(&status, data);
    if (!why->facts.mode_known) {
        why->began_in_autopilot = status.autopilot_mode;
    }
    why->facts.vcu_speed = status.speed_m_per_h;
    why->facts.vcu_speed_seen = why->facts.vcu_speed_seen || (status.speed_m_per_h != 0);
    why->facts.mode_bits = data[6];
    why->facts.mode_known = true;
    why->manual_was_seen = why->manual_was_seen || status.manual_mode;
}

/** Read what a status message says, if it is valid. */
static void take_status(why_t *why, agv_message_t message, const why_evidence_t *frame) {
    if (!agv_value_is_valid(message, frame->frame.data)) {
        return;
    }
    switch (message) {
    case AGV_MSG_STEERING_STATUS:
        take_angle(why, frame);
        break;
    case AGV_MSG_THROTTLE_STATUS:
        take_throttle(why, frame);
        break;
    case AGV_MSG_GEAR_STATUS:
        why->facts.gear = frame->frame.data[0];
        break;
    case AGV_MSG_WHEEL_SPEED:
        take_wheels(why, frame->frame.data);
        break;
    case AGV_MSG_VEHICLE_STATUS:
        take_vehicle(why, frame->frame.data);
        break;
    default:
        break;
    }
}

/** Whether that is known with which a budget compares: before, no frame is a good one. */
static bool is_comparable(const why_t *why, const row_t *row) {
    for (uint32_t command = 0; command < AGV_COMMAND_COUNT; command++) {
        if (((row->messages & BIT_OF(command)) != 0) && !why->facts.command_known[command]) {
            return false;
        }
    }
    return why->facts.vcu_speed_seen || (row->fault != AGV_FAULT_SPEED_IMPLAUSIBLE);
}

/** Evaluate what depends on a message, after it was read. */
static void evaluate(why_t *why, agv_message_t message, const why_evidence_t *frame) {
    for (size_t i = 0; i < ROWS; i++) {
        why_tracker_t *tracker = &why->trackers[rows[i].fault];
        if ((rows[i].messages & BIT_OF(message)) == 0) {
            continue;
        }
        const bool bad = rows[i].is_bad(why);
        if (bad && !tracker->bad && (tracker->value == 0)) {
            const agv_message_t shown = why_row(rows[i].fault)->message;
            const why_evidence_t *before = why_before(&why->messages[shown], frame->t_us);
            tracker->good = ((before != NULL) && tracker->is_comparable) ? *before : why_no_evidence();
            tracker->first = *frame;
            tracker->since_us = frame->t_us;
        }
        tracker->bad_since_us = (bad && !tracker->bad) ? frame->t_us : tracker->bad_since_us;
        tracker->bad = bad;
        tracker->is_comparable = is_comparable(why, &rows[i]);
    }
}

void why_budget_frame(why_t *why, agv_message_t message, const why_evidence_t *frame) {
    if (!why_is_command(message)) {
        why_budget_advance(why, frame->t_us);
        take_status(why, message, frame);
        evaluate(why, message, frame);
    }
}

void why_budget_command(why_t *why, agv_message_t command, const why_evidence_t *frame) {
    const uint8_t *data = frame->frame.data;
    if (!agv_value_is_valid(command, data)) {
        return;
    }
    why_budget_advance(why, frame->t_us);
    why->facts.command_known[command] = true;
    if (command == AGV_MSG_STEERING_COMMAND) {
        why->facts.angle_command_raw = agv_angle_read(data);
    } else if (command == AGV_MSG_THROTTLE_COMMAND) {
        why->facts.throttle_command = data[0];
    } else if (command == AGV_MSG_GEAR_COMMAND) {
        why->facts.gear_command = data[0];
    } else {
        why->facts.autopilot_off = (data[4] & AGV_SIGNAL_AUTOPILOT_OFF) != 0;
    }
    evaluate(why, command, frame);
}

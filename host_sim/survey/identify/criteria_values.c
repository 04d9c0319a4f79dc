/* Criteria of the values of one identifier. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "agv/codec.h"
#include "survey/identify/compare.h"
#include "survey/identify/suspect.h"
#include "text/units.h"

enum { GEARS_SIZE = 24, MOVES_MM_S = 100, STANDS_MM_S = 50, APART_MM_S = 500, MIDDLE_PARTS = 10, SPAN_MIN = 1000 };
enum { SUPPLY_LOWEST = 60, SUPPLY_HIGHEST = 250, SUPPLY_SPREAD = 60 };
enum { CENTRE_DDEG = 450, HALF_DDEG = 4500, JUMP_DDEG = 1000 };
enum { FRAMES_PER_CHANGE = 100, ANGLE_CONTROL = AGV_EPS_MODE_ANGLE, MODE_SAMPLES_MIN = 10, VALUE_SAMPLE_MS = 100 };

static const double TOGETHER = 0.9;
static const double PERCENT_PER_COUNT = 0.4;
static const double DDEG_PER_DEGREE = 10.0;

static verdict_t judge_gear(const suspect_t *suspect, criterion_t *criterion) {
    static const struct {
        int32_t gear;
        const char *word;
    } gears[] = {{AGV_GEAR_P, "P"}, {AGV_GEAR_R, "R"}, {AGV_GEAR_N, "N"}, {AGV_GEAR_D, "D"}};
    const track_t *track = suspect->heard->tracks[FIELD_BYTE_0];
    char text[GEARS_SIZE] = "";
    for (size_t i = 0; i < sizeof gears / sizeof gears[0]; i++) {
        bool was_seen = false;
        for (size_t at = 0; at < track->count; at++) {
            was_seen = was_seen || (track->changes[at].value == gears[i].gear);
        }
        if (was_seen) {
            const size_t used = strlen(text);
            (void)snprintf(&text[used], sizeof text - used, "%s%s", (used > 0) ? ", " : "", gears[i].word);
        }
    }
    return (track->lowest == track->highest) ? say(criterion, VERDICT_REFUSES, "its gear is always %s", text)
                                             : say(criterion, VERDICT_FOR, "its gears are %s", text);
}

static verdict_t judge_throttle(const suspect_t *suspect, criterion_t *criterion) {
    const track_t *track = suspect->heard->tracks[FIELD_BYTE_0];
    const double lowest = (double)track->lowest * PERCENT_PER_COUNT;
    const double highest = (double)track->highest * PERCENT_PER_COUNT;
    if (track->highest == 0) {
        return VERDICT_NONE;
    }
    return (track->lowest > 0) ? say(criterion, VERDICT_REFUSES, "its throttle is never 0")
                               : say(criterion, VERDICT_FOR, "its throttle is %.1f to %.1f %%", lowest, highest);
}

static double degrees(int32_t raw) {
    return (double)(raw - AGV_ANGLE_RAW_CENTRE) / DDEG_PER_DEGREE;
}

/** An angle has its rest at the centre. A byte or a speed that is read as an angle has its rest at the end stop. */
static verdict_t judge_angle(const track_t *track, criterion_t *criterion) {
    const int32_t lowest = track->lowest - AGV_ANGLE_RAW_CENTRE;
    const int32_t highest = track->highest - AGV_ANGLE_RAW_CENTRE;
    const char *remark = "";
    verdict_t verdict = VERDICT_FOR;
    if ((lowest <= -AGV_ANGLE_MAX_DDEG) || (highest >= AGV_ANGLE_MAX_DDEG)) {
        verdict = VERDICT_REFUSES;
        remark = ", an end stop";
    } else if ((lowest > HALF_DDEG) || (highest < -HALF_DDEG)) {
        verdict = VERDICT_REFUSES;
        remark = ", at an end stop all the time";
    } else if ((lowest > CENTRE_DDEG) || (highest < -CENTRE_DDEG)) {
        verdict = VERDICT_AGAINST;
        remark = ", never near the centre";
    } else {
        /* around the centre */
    }
    return say(criterion, verdict, "its angle is %.1f to %.1f deg%s", degrees(track->lowest), degrees(track->highest),
               remark);
}

static verdict_t judge_steering_command(const suspect_t *suspect, criterion_t *criterion) {
    return judge_angle(suspect->heard->tracks[FIELD_WORD_0], criterion);
}

/** A wheel does not jump. */
static bool is_smooth(const track_t *track) {
    for (size_t i = 1; i < track->count; i++) {
        if (abs(track->changes[i].value - track->changes[i - 1].value) > JUMP_DDEG) {
            return false;
        }
    }
    return true;
}

static verdict_t judge_steering_status(const suspect_t *suspect, criterion_t *criterion) {
    const track_t *supply = suspect->heard->tracks[FIELD_BYTE_1];
    const track_t *angle = suspect->heard->tracks[FIELD_WORD_2];
    const verdict_t verdict = judge_angle(angle, criterion);
    if (verdict != VERDICT_FOR) {
        return verdict;
    }
    if ((supply->lowest < SUPPLY_LOWEST) || (supply->highest > SUPPLY_HIGHEST) ||
        (supply->highest - supply->lowest > SUPPLY_SPREAD)) {
        return say(criterion, VERDICT_AGAINST, "its supply is %d to %d %% of 12 V", (int)supply->lowest,
                   (int)supply->highest);
    }
    if (!is_smooth(angle)) {
        return say(criterion, VERDICT_AGAINST, "its angle jumps");
    }
    return say(criterion, VERDICT_DECIDES, "has a counter, a supply of %d to %d %% and an angle of %.1f to %.1f deg",
               (int)supply->lowest, (int)supply->highest, degrees(angle->lowest), degrees(angle->highest));
}

static verdict_t judge_mode(const suspect_t *suspect, criterion_t *criterion) {
    const track_t *mode = suspect->heard->tracks[FIELD_MODE];
    const bool is_one = (mode->lowest == AGV_VCU_FLAG_MANUAL) || (mode->lowest == AGV_VCU_FLAG_AUTOPILOT);
    if (!is_one || (mode->highest > (int32_t)AGV_VCU_FLAG_AUTOPILOT)) {
        return say(criterion, VERDICT_AGAINST, "has both modes at once");
    }
    if (mode->lowest == mode->highest) {
        return say(criterion, VERDICT_AGAINST, "its mode is always %s",
                   (mode->lowest == AGV_VCU_FLAG_MANUAL) ? "manual" : "autopilot");
    }
    if (mode->count * FRAMES_PER_CHANGE > suspect->heard->frames) {
        return say(criterion, VERDICT_REFUSES, "its mode flickers");
    }
    return say(criterion, VERDICT_DECIDES, "has a counter, and the modes manual and autopilot in turn");
}

/** Measured once, and the centre is in the middle. */
static verdict_t judge_positions(const suspect_t *suspect, criterion_t *criterion) {
    agv_steering_position_t position;
    (void)agv_unpack_steering_position(&position, suspect->entry->bits_ever);
    const int32_t left = position.left_raw;
    const int32_t right = position.right_raw;
    if ((left == 0) && (right == 0)) {
        return VERDICT_NONE;
    }
    if (memcmp(suspect->entry->bits_ever, suspect->entry->bits_always, sizeof suspect->entry->bits_ever) != 0) {
        static const uint8_t zeros[AGV_DLC] = {0};
        const bool is_other = memcmp(suspect->entry->bits_always, zeros, sizeof zeros) == 0;
        return is_other ? say(criterion, VERDICT_REFUSES, "all its positions change")
                        : say(criterion, VERDICT_AGAINST, "its positions change");
    }
    const int32_t off = (2 * position.centre_raw) - left - right;
    const int32_t span = abs(right - left);
    return ((span >= SPAN_MIN) && (abs(off) * MIDDLE_PARTS <= 2 * span))
               ? say(criterion, VERDICT_DECIDES, "has a centre, %u, in the middle of %d and %d", position.centre_raw,
                     (int)left, (int)right)
               : say(criterion, VERDICT_AGAINST, "its centre, %u, is not in the middle of %d and %d",
                     position.centre_raw, (int)left, (int)right);
}

static bool moves(const track_t *track) {
    return (track->highest >= MOVES_MM_S) || (track->lowest <= -MOVES_MM_S);
}

static verdict_t judge_wheels(const suspect_t *suspect, criterion_t *criterion) {
    const compare_t compare = {.first = suspect->heard->tracks[FIELD_LONG_0],
                               .second = suspect->heard->tracks[FIELD_LONG_4],
                               .tolerance = APART_MM_S};
    if (!moves(compare.first) && !moves(compare.second)) {
        return say(criterion, VERDICT_REFUSES, "does not move");
    }
    if (!moves(compare.first) || !moves(compare.second)) {
        return say(criterion, VERDICT_REFUSES, "only one of its two speeds moves");
    }
    if ((compare.first->lowest > STANDS_MM_S) || (compare.first->highest < -STANDS_MM_S)) {
        return say(criterion, VERDICT_AGAINST, "its speed is never near 0");
    }
    const agreement_t found = compare_values(&compare);
    return ((found.equal >= TOGETHER) && (found.together >= TOGETHER))
               ? say(criterion, VERDICT_DECIDES, "its two speeds go together")
               : say(criterion, VERDICT_AGAINST, "its two speeds do not go together");
}

/** Share of the time in which the EPS is under angle control, in a mode of the vehicle. */
static double angle_control(const compare_t *compare, bool is_engaged, uint64_t *samples) {
    const uint64_t step_us = (uint64_t)VALUE_SAMPLE_MS * US_PER_MS;
    size_t at[2] = {0, 0};
    uint64_t controlled = 0;
    *samples = 0;
    for (uint64_t t_us = compare->first->changes[0].at_us; t_us <= compare->first->until_us; t_us += step_us) {
        const bool now = (track_value(compare->second, &at[1], t_us) & (int32_t)AGV_VCU_FLAG_AUTOPILOT) != 0;
        const int32_t mode = track_value(compare->first, &at[0], t_us);
        *samples += (now == is_engaged) ? 1 : 0;
        controlled += ((now == is_engaged) && (mode == ANGLE_CONTROL)) ? 1 : 0;
    }
    return (*samples > 0) ? (double)controlled / (double)*samples : 0.0;
}

verdict_t criteria_eps_mode(const suspect_t *suspect, const track_t *mode, criterion_t *criterion) {
    const compare_t compare = {.first = suspect->heard->tracks[FIELD_EPS_MODE], .second = mode};
    const counter_use_t *faults = &suspect->heard->counters[1];
    if ((faults->steps + faults->other_steps) * 2 >= faults->frames) {
        return say(criterion, VERDICT_REFUSES, "its byte 8 counts, so it has no faults");
    }
    if (compare.first->lowest == compare.first->highest) {
        return (compare.first->lowest == 0) ? VERDICT_NONE : say(criterion, VERDICT_AGAINST, "its mode never changes");
    }
    if (mode == NULL) {
        return VERDICT_NONE;
    }
    uint64_t samples[2];
    const double engaged = angle_control(&compare, true, &samples[0]);
    const double manual = angle_control(&compare, false, &samples[1]);
    if ((samples[0] < MODE_SAMPLES_MIN) || (samples[1] < MODE_SAMPLES_MIN)) {
        return VERDICT_NONE;
    }
    if ((engaged >= TOGETHER) && (manual <= 1.0 - TOGETHER)) {
        return say(criterion, VERDICT_DECIDES, "is in angle control only in autopilot mode");
    }
    return (engaged <= 1.0 - TOGETHER) ? say(criterion, VERDICT_REFUSES, "is not in angle control in autopilot mode")
                                       : VERDICT_NONE;
}

verdict_t criteria_values(const suspect_t *suspect, criterion_t *criterion) {
    static verdict_t (*const judges[AGV_MSG_COUNT])(const suspect_t *, criterion_t *) = {
        [AGV_MSG_GEAR_COMMAND] = judge_gear,
        [AGV_MSG_THROTTLE_COMMAND] = judge_throttle,
        [AGV_MSG_STEERING_COMMAND] = judge_steering_command,
        [AGV_MSG_VEHICLE_STATUS] = judge_mode,
        [AGV_MSG_GEAR_STATUS] = judge_gear,
        [AGV_MSG_THROTTLE_STATUS] = judge_throttle,
        [AGV_MSG_STEERING_STATUS] = judge_steering_status,
        [AGV_MSG_STEERING_POSITION] = judge_positions,
        [AGV_MSG_WHEEL_SPEED] = judge_wheels,
    };
    const uint32_t fields = field_of_message(suspect->message);
    for (uint32_t field = 0; field < FIELD_COUNT; field++) {
        if ((((fields >> field) & 1) != 0) && (suspect->heard->tracks[field] == NULL)) {
            return VERDICT_NONE; /* out of memory */
        }
    }
    return (judges[suspect->message] != NULL) ? judges[suspect->message](suspect, criterion) : VERDICT_NONE;
}

/* Fault bits, bad values and their scores (SUP-4, SUP-5). */

#include "agv/codec.h"
#include "why/why_internal.h"

/** What makes a frame a bad one. */
typedef enum { BIT, EPS_MODE, VALUE } condition_t;

/** A fault that frames of a message show. EPS_MODE_OFF stands for all three faults of the mode. */
typedef struct {
    agv_fault_t fault;
    condition_t condition;
    bool judged; /**< counts in autopilot only */
} tracked_t;

#define ALWAYS(fault) {AGV_FAULT_##fault, BIT, false}

static const tracked_t tracked[] = {
    ALWAYS(VCU_EPS_HARDWARE_FAULT),
    ALWAYS(VCU_EPS_CAN_BUS_FAULT),
    ALWAYS(S_DRIVER_ALARM),
    ALWAYS(REMOTE_SIGNAL_LOST),
    ALWAYS(REMOTE_POWER_LOST),
    ALWAYS(VCU_AI_CAN_LOST),
    ALWAYS(VCU_LEVEL2_ALARM),
    ALWAYS(EPS_OVER_CURRENT_SHUTDOWN),
    ALWAYS(EPS_TEMP_ABOVE_120),
    ALWAYS(EPS_MOTOR_ENCODER),
    ALWAYS(EPS_POSITION_ENCODER),
    ALWAYS(EPS_UNDER_VOLTAGE),
    ALWAYS(EPS_OVER_VOLTAGE),
    ALWAYS(EPS_EXCESSIVE_CURRENT),
    ALWAYS(EPS_TEMP_ABOVE_110),
    {AGV_FAULT_EPS_MODE_OFF, EPS_MODE, true},
    {AGV_FAULT_GEAR_STATUS_INVALID, VALUE, true},
    {AGV_FAULT_THROTTLE_STATUS_INVALID, VALUE, true},
    {AGV_FAULT_STEERING_ANGLE_INVALID, VALUE, true},
};

enum { TRACKED_COUNT = sizeof tracked / sizeof tracked[0] };

void why_track_start(why_t *why) {
    for (size_t i = 0; i < AGV_FAULT_COUNT; i++) {
        why->trackers[i].good = why_no_evidence();
        why->trackers[i].first = why_no_evidence();
    }
}

void why_track_engage(why_t *why) {
    for (size_t i = 0; i < TRACKED_COUNT; i++) {
        if (tracked[i].judged) {
            why->trackers[tracked[i].fault].value = 0;
        }
    }
}

/** The first of bad frames that follow each other. */
static void note_first(why_tracker_t *tracker, const why_evidence_t *frame, const why_evidence_t *before) {
    tracker->first = *frame;
    tracker->good = (before != NULL) ? *before : why_no_evidence();
}

void why_score(why_tracker_t *tracker, bool bad, uint32_t frames, uint64_t from_us, const why_score_frames_t *seen) {
    const uint64_t full = 2 * (uint64_t)frames;
    if (bad && (tracker->value == 0)) {
        tracker->is_old = tracker->bad && (tracker->first.t_us < from_us);
        if (!tracker->bad) {
            note_first(tracker, seen->frame, seen->before);
        } else if (tracker->is_old) {
            tracker->first = *seen->frame; /* the one before it is bad too: the last good one stays */
        } else {
            /* it began after that time */
        }
        tracker->began_us = tracker->is_old ? from_us : tracker->first.t_us;
        tracker->bad_frames = 0;
        tracker->is_mixed = false;
    }
    if (bad) {
        tracker->bad_frames++;
        tracker->value = (tracker->value + 2 < full) ? tracker->value + 2 : full;
    } else {
        tracker->value = ((tracker->value > 1) && (frames > 1)) ? tracker->value - 1 : 0;
    }
    tracker->bad = bad;
}

static bool is_bad(const tracked_t *row, const why_row_t *what, const uint8_t *data) {
    switch (row->condition) {
    case BIT:
        return (data[what->byte] & what->mask) != 0;
    case EPS_MODE:
        return data[3] != AGV_EPS_MODE_ANGLE;
    default:
        return !agv_value_is_valid(what->message, data);
    }
}

static agv_fault_t mode_fault(const uint8_t *data) {
    if (data[3] == AGV_EPS_MODE_OFF) {
        return AGV_FAULT_EPS_MODE_OFF;
    }
    return agv_value_is_valid(AGV_MSG_EPS_STATUS, data) ? AGV_FAULT_EPS_MODE_NOT_ANGLE : AGV_FAULT_EPS_MODE_INVALID;
}

static void follow(why_t *why, const tracked_t *row, agv_message_t message, const why_evidence_t *frame) {
    const why_row_t *what = why_row(row->fault);
    why_tracker_t *tracker = &why->trackers[row->fault];
    if (what->message != message) {
        return;
    }
    const bool bad = is_bad(row, what, frame->frame.data);
    if (!bad && (tracker->value == 0)) {
        tracker->bad = false;
        return;
    }
    const why_score_frames_t seen = {frame, why_before(&why->messages[message], frame->t_us)};
    if (row->judged && (frame->t_us < why_judged_us(why))) {
        if (bad && !tracker->bad) {
            note_first(tracker, seen.frame, seen.before);
        }
        tracker->bad = bad;
        return;
    }
    const uint32_t frames = (what->setting != WHY_NO_SETTING) ? agv_config_get(&why->config, what->setting) : 1;
    why_score(tracker, bad, frames, row->judged ? why->engagement.began_us : 0, &seen);
    if (bad && (row->condition == EPS_MODE)) {
        tracker->is_mixed = tracker->is_mixed || (frame->frame.data[3] != tracker->first.frame.data[3]);
        why->eps_mode = mode_fault(frame->frame.data);
    }
}

void why_track_frame(why_t *why, agv_message_t message, const why_evidence_t *frame) {
    if (why_is_command(message)) {
        why_intruder_command(why, message, frame);
        return;
    }
    for (size_t i = 0; i < TRACKED_COUNT; i++) {
        follow(why, &tracked[i], message, frame);
    }
}

const why_tracker_t *why_tracker(const why_t *why, agv_fault_t fault) {
    const bool is_mode = (fault >= AGV_FAULT_EPS_MODE_OFF) && (fault <= AGV_FAULT_EPS_MODE_NOT_ANGLE);
    const why_tracker_t *tracker = &why->trackers[is_mode ? AGV_FAULT_EPS_MODE_OFF : fault];
    return ((tracker->value == 0) || (is_mode && (fault != why->eps_mode))) ? NULL : tracker;
}

/* Frames of other senders, and commands that come too fast (SUP-6, TOP-3, P1). */
#include "agv/codec.h"
#include "text/units.h"
#include "why/why_internal.h"

void why_intruder_start(why_t *why) {
    why->bad_command = why_no_evidence();
    why->foreign = why_no_evidence();
    why->status_id = why_no_evidence();
    why->other_set = why_no_evidence();
    for (size_t i = 0; i < AGV_COMMAND_COUNT; i++) {
        why->too_fast[i].good = why_no_evidence();
        why->too_fast[i].first = why_no_evidence();
    }
}

/** A data frame with an 11-bit identifier, of any length and format. */
static bool is_data_frame(const hal_can_frame_t *frame) {
    return (frame->flags & (HAL_CAN_EXTENDED | HAL_CAN_REMOTE | HAL_CAN_ERROR)) == 0;
}

static uint64_t event_hold_us(const why_t *why) {
    return (uint64_t)why->config.event_hold_ms * US_PER_MS;
}

/** Keep the first of several that follow each other. */
static void keep_first(const why_t *why, why_evidence_t *first, uint64_t *last_us, const why_evidence_t *frame) {
    if ((first->t_us == WHY_NEVER) || (frame->t_us > *last_us + event_hold_us(why))) {
        *first = *frame;
    }
    *last_us = frame->t_us;
}

/** A frame with the identifier that a message has in the other set. */
static void follow_other_set(why_t *why, const why_evidence_t *frame) {
    const uint32_t other_set = (uint32_t)AGV_ID_SET_TABLE - why->config.id_set;
    const agv_message_t message = (agv_message_t)agv_message_from_id(frame->frame.id, other_set);
    const bool moved = agv_message_id(message, AGV_ID_SET_HEADING) != agv_message_id(message, AGV_ID_SET_TABLE);
    if ((message == AGV_MSG_NONE) || !moved || (frame->frame.flags != 0) || (frame->frame.length != AGV_DLC)) {
        return;
    }
    const uint64_t own_us = why->messages[message].last_us;
    const bool is_new = (why->other_set.t_us == WHY_NEVER) || (why->other_message != message) ||
                        ((own_us != WHY_NEVER) && (own_us > why->other_set.t_us));
    if (is_new) {
        why->other_set = *frame;
        why->other_message = message;
    }
}

void why_intruder_frame(why_t *why, const why_evidence_t *frame) {
    const agv_message_t message = (agv_message_t)agv_ids_find(&why->ids, frame->frame.id);
    if (!is_data_frame(&frame->frame)) {
        return;
    }
    if (why_is_command(message)) {
        if ((frame->side == HAL_CAN_VEHICLE) && why->is_gateway) {
            keep_first(why, &why->foreign, &why->foreign_last_us, frame);
        } else if (why->engagement.engaged) {
            why->bad_command = *frame; /* of another length or format */
        } else {
            /* in manual it is only counted */
        }
    } else if (message == AGV_MSG_NONE) {
        follow_other_set(why, frame);
        if ((why->config.status_frame_id != 0) && (frame->frame.id == why->config.status_frame_id) &&
            (frame->side == HAL_CAN_VEHICLE)) {
            why->status_id = *frame;
        }
    } else {
        /* a status message of another length, or on the AI side */
    }
}

void why_intruder_command(why_t *why, agv_message_t command, const why_evidence_t *frame) {
    const why_evidence_t *before = why_history(&why->messages[command], 1);
    why_tracker_t *score = &why->too_fast[command];
    if (!agv_value_is_valid(command, frame->frame.data) && why->engagement.engaged) {
        why->bad_command = *frame;
    }
    if (before == NULL) {
        return;
    }
    /* the supervisor knows whole ms only */
    const uint64_t gap_ms = (frame->t_us / US_PER_MS) - (before->t_us / US_PER_MS);
    const uint32_t half_ms = (agv_message_cycle_ms(command) + 1) / 2;
    if (gap_ms > agv_config_get(&why->config, message_deadline_setting(command))) {
        score->value = 0;
        score->bad = false;
    } else {
        const why_score_frames_t seen = {frame, before};
        why_score(score, gap_ms < half_ms, why->config.command_too_fast_gaps, 0, &seen);
    }
}

/* The cause of a trip: what told, since when, and the frames that show it. */
#include <string.h>

#include "agv/codec.h"
#include "text/units.h"
#include "why/why_internal.h"

enum { RECENT_FRAMES = 6, ERROR_FRAME_US = 20000 };

/** Two frames with one stamp are the same if their bytes are. */
static bool is_same(const why_evidence_t *one, const why_evidence_t *other) {
    return (one->t_us == other->t_us) && (one->frame.id == other->frame.id) &&
           (memcmp(one->frame.data, other->frame.data, sizeof one->frame.data) == 0);
}

void why_show(why_trip_t *trip, const why_evidence_t *evidence) {
    if ((evidence == NULL) || (evidence->t_us == WHY_NEVER) || (trip->evidence_count == WHY_EVIDENCE_MAX)) {
        return;
    }
    size_t at = 0;
    for (size_t i = 0; i < trip->evidence_count; i++) {
        if (is_same(&trip->evidence[i], evidence)) {
            return;
        }
        at = (trip->evidence[i].t_us <= evidence->t_us) ? i + 1 : at;
    }
    memmove(&trip->evidence[at + 1], &trip->evidence[at], (trip->evidence_count - at) * sizeof trip->evidence[0]);
    trip->evidence[at] = *evidence;
    trip->evidence_count++;
}

static void show_recent(const why_t *why, why_trip_t *trip, agv_message_t message, uint32_t count) {
    for (uint32_t back = count; back > 0; back--) {
        why_show(trip, why_history(&why->messages[message], back - 1));
    }
}

static void set_limit(const why_t *why, why_trip_t *trip, uint16_t setting, const char *unit) {
    trip->limit = (setting != WHY_NO_SETTING) ? (int64_t)agv_config_get(&why->config, setting) : WHY_NO_LIMIT;
    trip->unit = (setting != WHY_NO_SETTING) ? unit : NULL;
    if (trip->reason == AGV_FAULT_MOVING_WHILE_SAFE) {
        trip->limit = (int64_t)WHY_MOVING_MS;
        trip->unit = "ms";
    }
}

/** The message that tells, and its identifier. */
static void set_message(const why_t *why, why_trip_t *trip, agv_message_t message) {
    trip->message = message;
    trip->id = (message != AGV_MSG_NONE) ? why->ids.of[message] : WHY_NO_ID;
}

static void set_frame(why_trip_t *trip, const why_evidence_t *frame) {
    if (frame->t_us != WHY_NEVER) {
        trip->cause_us = frame->t_us;
        trip->bad = *frame;
        why_show(trip, frame);
    }
}

static uint64_t limit_us(const why_trip_t *trip) {
    return (uint64_t)trip->limit * US_PER_MS;
}

/** What lasted for its limit until now began so long ago. */
static void began_before(why_trip_t *trip) {
    trip->cause_us = (trip->t_us > limit_us(trip)) ? trip->t_us - limit_us(trip) : 0;
}

/** The first frame that should have come and did not. Commands need not come before the engagement. */
static void explain_silence(const why_t *why, why_trip_t *trip) {
    const why_message_t *message = &why->messages[trip->message];
    const uint64_t cycle_us = (uint64_t)agv_message_cycle_ms(trip->message) * US_PER_MS;
    const uint64_t engaged_us = why->engagement.began_us;
    if (message->beat_us == WHY_NEVER) {
        trip->cause_us = why->start_us;
    } else {
        trip->was_heard = true;
        trip->last_good_us = message->beat_us;
        trip->cause_us = message->beat_us + cycle_us;
    }
    trip->refused = message->refused;
    if (trip->refused.count > 0) {
        why_show(trip, &message->refused.first);
    }
    const bool is_ai_heartbeat = trip->message == AGV_MSG_TURN_SIGNAL_COMMAND; /* once seen, it counts in manual too */
    const bool from_engagement = why_is_command(trip->message) && !(is_ai_heartbeat && trip->was_heard);
    if (from_engagement && (engaged_us != WHY_NEVER) && (trip->cause_us < engaged_us)) {
        trip->cause_us = engaged_us;
        trip->from_engagement = true;
        if (is_ai_heartbeat) {
            set_limit(why, trip, AGV_SETTING_ai_never_seen_timeout_ms, "ms");
        }
    }
    show_recent(why, trip, trip->message, RECENT_FRAMES);
}

static void explain_stuck(const why_t *why, why_trip_t *trip) {
    const why_message_t *message = &why->messages[trip->message];
    trip->last_good_us = message->beat_us;
    trip->wrong_steps = message->steps;
    show_recent(why, trip, trip->message, RECENT_FRAMES);
    why_show(trip, &message->beat);
    set_frame(trip, &message->first_repeat);
}

/** It counts while engaged only: a bit that was set before, from the 363h of the engagement on. */
static void begin_with_engagement(const why_t *why, why_trip_t *trip) {
    const why_engagement_t *engagement = &why->engagement;
    const why_evidence_t *frame = &engagement->frames[(engagement->count - 1) % WHY_ENGAGEMENTS];
    if ((trip->reason == AGV_FAULT_VCU_AI_CAN_LOST) && (engagement->count > 0) && (trip->cause_us < frame->t_us)) {
        set_frame(trip, frame);
    }
}

static void explain_tracked(const why_t *why, why_trip_t *trip) {
    const why_tracker_t *tracker = why_tracker(why, trip->reason);
    const agv_message_t other = why_compared_with(trip->reason);
    show_recent(why, trip, trip->message, RECENT_FRAMES);
    if (tracker != NULL) {
        trip->cause_us = tracker->began_us;
        trip->last_good_us = tracker->good.t_us;
        trip->from_engagement = tracker->is_old;
        trip->bad_frames = tracker->bad_frames;
        trip->is_mixed = tracker->is_mixed;
        why_show(trip, &tracker->good);
        why_show(trip, &tracker->first);
        if (tracker->first.t_us == tracker->began_us) {
            trip->bad = tracker->first;
        }
        begin_with_engagement(why, trip);
    }
    if (other != AGV_MSG_NONE) {
        show_recent(why, trip, other, 2);
    }
}

/** A flicker of manual trips a little later (SUP-9). The end of an engagement takes less. */
enum { FLICKER_US = 220000 };

/** The first of the engagements that were too many, or the first 363h of a flicker. */
static void explain_flapping(const why_t *why, why_trip_t *trip) {
    const why_engagement_t *engagement = &why->engagement;
    const uint32_t kept = (engagement->count < WHY_ENGAGEMENTS) ? engagement->count : (uint32_t)WHY_ENGAGEMENTS;
    if (engagement->manual_us >= FLICKER_US) {
        trip->cause_us = engagement->manual.t_us;
        why_show(trip, &engagement->manual);
        show_recent(why, trip, trip->message, RECENT_FRAMES);
        return;
    }
    for (uint32_t i = 0; i < kept; i++) {
        const why_evidence_t *frame = &engagement->frames[(engagement->count - kept + i) % WHY_ENGAGEMENTS];
        if (i == 0) {
            trip->cause_us = frame->t_us;
        }
        why_show(trip, frame);
    }
}

static void explain_mode(const why_t *why, why_trip_t *trip) {
    if (trip->reason == AGV_FAULT_MODE_FLAPPING) {
        explain_flapping(why, trip);
    } else {
        explain_tracked(why, trip);
    }
}

void why_value_limit(why_trip_t *trip) {
    if (trip->message == AGV_MSG_THROTTLE_COMMAND) {
        trip->limit = (int64_t)AGV_THROTTLE_MAX_COUNTS;
        trip->unit = "counts";
    } else if (trip->message == AGV_MSG_STEERING_COMMAND) {
        trip->limit = (int64_t)AGV_ANGLE_RAW_MAX / 2; /* on the wire it begins at the lowest one */
        trip->unit = "ddeg";
    } else {
        /* a gear has none */
    }
}

static void explain_value(const why_t *why, why_trip_t *trip) {
    const hal_can_frame_t *frame = &why->bad_command.frame;
    if (why->bad_command.t_us == WHY_NEVER) {
        return;
    }
    set_message(why, trip, (agv_message_t)agv_ids_find(&why->ids, frame->id));
    const bool whole = (frame->length == AGV_DLC) && (frame->flags == 0);
    if (whole) {
        why_value_limit(trip);
    }
    show_recent(why, trip, trip->message, RECENT_FRAMES);
    set_frame(trip, &why->bad_command);
    for (uint32_t back = 0; back < WHY_HISTORY; back++) {
        const why_evidence_t *before = why_history(&why->messages[trip->message], back);
        if ((before != NULL) && (before->t_us < why->bad_command.t_us) &&
            agv_value_is_valid(trip->message, before->frame.data)) {
            trip->last_good_us = before->t_us;
            break;
        }
    }
}

/** The command that came too fast: that with the highest score. */
static void explain_too_fast(const why_t *why, why_trip_t *trip) {
    agv_message_t command = AGV_MSG_TURN_SIGNAL_COMMAND;
    for (uint32_t i = 0; i < AGV_COMMAND_COUNT; i++) {
        if (why->too_fast[i].value > why->too_fast[command].value) {
            command = (agv_message_t)i;
        }
    }
    const why_tracker_t *score = &why->too_fast[command];
    set_message(why, trip, command);
    if (score->value != 0) {
        trip->cause_us = score->began_us;
        trip->last_good_us = score->good.t_us;
        trip->bad_frames = score->bad_frames;
        why_show(trip, &score->good);
        why_show(trip, &score->first);
    }
    show_recent(why, trip, command, RECENT_FRAMES);
}

static void explain_intrusion(const why_t *why, why_trip_t *trip) {
    if (trip->reason == AGV_FAULT_FOREIGN_COMMAND_SENDER) {
        set_message(why, trip, (agv_message_t)agv_ids_find(&why->ids, why->foreign.frame.id));
        set_frame(trip, &why->foreign);
    } else if (trip->reason == AGV_FAULT_STATUS_ID_IN_USE) {
        trip->id = why->config.status_frame_id;
        set_frame(trip, &why->status_id);
    } else {
        explain_too_fast(why, trip);
    }
}

static void explain_bus(const why_t *why, why_trip_t *trip) {
    if (trip->limit != WHY_NO_LIMIT) {
        began_before(trip);
    } else if ((why->error.t_us != WHY_NEVER) && (why->error.t_us + (uint64_t)ERROR_FRAME_US >= trip->t_us)) {
        set_frame(trip, &why->error);
    } else {
        /* the controller said so at that time */
    }
}

/** The confirmation that was missing for too long, and since when it is counted. */
static void explain_unconfirmed(const why_t *why, why_trip_t *trip) {
    const bool is_park = why_confirm_waits_for_park(why, trip->t_us);
    const why_missing_t *missing = is_park ? &why->confirmation.park : &why->confirmation.off;
    if (is_park) {
        set_message(why, trip, AGV_MSG_GEAR_STATUS);
        set_limit(why, trip, AGV_SETTING_park_confirm_timeout_ms, "ms");
    }
    began_before(trip);
    trip->cause_us = (missing->sum_us != 0) ? missing->began_us : trip->cause_us;
}

/** What the vehicle did not do. */
static void explain_vehicle(const why_t *why, why_trip_t *trip) {
    const why_tracker_t *moved = why_tracker(why, trip->reason);
    if (trip->reason == AGV_FAULT_SAFE_STATE_UNCONFIRMED) {
        explain_unconfirmed(why, trip);
    } else if (trip->reason == AGV_FAULT_VEHICLE_NOT_STOPPING) {
        began_before(trip);
    } else if (moved != NULL) {
        set_frame(trip, &moved->first);
    } else {
        /* it moved when that was found */
    }
    show_recent(why, trip, trip->message, RECENT_FRAMES);
}

static void explain_own(const why_t *why, why_trip_t *trip) {
    if (trip->reason == AGV_FAULT_WRONG_ID_SET) {
        if (why->other_set.t_us != WHY_NEVER) {
            trip->message = why->other_message;
            trip->id = why->other_set.frame.id;
            trip->last_good_us = why->messages[why->other_message].last_us;
            set_frame(trip, &why->other_set);
        }
    } else if (trip->limit != WHY_NO_LIMIT) {
        began_before(trip);
    } else {
        /* it began when it was found */
    }
}

/** A fault bit of which a single frame is enough is no score. */
static why_kind_t kind_of(const why_t *why, const why_row_t *row) {
    const bool one = (row->kind == WHY_SCORE) && (row->mask != 0) && (agv_config_get(&why->config, row->setting) == 1);
    return one ? WHY_BIT : row->kind;
}

void why_cause(const why_t *why, why_trip_t *trip) {
    static void (*const explain[WHY_KINDS])(const why_t *, why_trip_t *) = {
        [WHY_SILENCE] = explain_silence, [WHY_STUCK] = explain_stuck,         [WHY_BIT] = explain_tracked,
        [WHY_SCORE] = explain_tracked,   [WHY_VALUE] = explain_value,         [WHY_BUDGET] = explain_tracked,
        [WHY_MODE] = explain_mode,       [WHY_INTRUSION] = explain_intrusion, [WHY_BUS] = explain_bus,
        [WHY_VEHICLE] = explain_vehicle, [WHY_HARDWARE] = explain_own,        [WHY_OWN] = explain_own};
    const why_row_t *row = why_row(trip->reason);
    trip->kind = kind_of(why, row);
    trip->cause_us = trip->t_us;
    trip->last_good_us = WHY_NEVER;
    trip->next_us = WHY_NEVER;
    trip->bad = why_no_evidence();
    set_message(why, trip, row->message);
    if (trip->from_earlier_run) {
        trip->cause_us = WHY_NEVER;
        trip->limit = WHY_NO_LIMIT;
        return;
    }
    set_limit(why, trip, row->setting, row->unit);
    if (why->snapshot != NULL) {
        why_cause_recorded(why, why->snapshot, trip);
    } else {
        explain[row->kind](why, trip);
    }
}

/*
 * The cause of a trip that a flight recorder kept: it has the last payload of each message, but not when it came. The
 * times follow from the limits.
 */
#include "agv/codec.h"
#include "agv/state.h"
#include "text/units.h"
#include "why/why_internal.h"

static void before(why_trip_t *trip, uint64_t lasted_us) {
    trip->cause_us = (trip->t_us > lasted_us) ? trip->t_us - lasted_us : 0;
}

static uint64_t recorded_limit_us(const why_trip_t *trip) {
    return (trip->limit != WHY_NO_LIMIT) ? (uint64_t)trip->limit * US_PER_MS : 0;
}

static uint64_t cycle_us(const why_trip_t *trip) {
    return (uint64_t)agv_message_cycle_ms(trip->message) * US_PER_MS;
}

static bool is_seen(const agv_event_t *event, agv_message_t message) {
    return (message != AGV_MSG_NONE) && (((event->seen >> (uint32_t)message) & 1) != 0);
}

/** When the cause was found: in ACTIVE when it trips, else it may have been a warning before. WHY_NEVER: not recorded. */
static uint64_t found_us(const why_t *why, const agv_event_t *event, const why_trip_t *trip) {
    const uint64_t raised_us = why->faults[trip->reason].active ? why->fault_since_us[trip->reason] : WHY_NEVER;
    return (event->a == AGV_STATE_STANDBY) ? raised_us : trip->t_us;
}

/** The last good frame came a deadline before this time. */
static void last_came(why_trip_t *trip, uint64_t expired_us) {
    const uint64_t lasted_us = recorded_limit_us(trip) + US_PER_MS;
    trip->last_good_us = (expired_us > lasted_us) ? expired_us - lasted_us : 0;
    trip->cause_us = trip->last_good_us + cycle_us(trip);
}

/** A heartbeat of the AI computer. What was lost before a reset is found at the next engagement. */
static void explain_ai_heartbeat(const why_t *why, const agv_event_t *event, why_trip_t *trip) {
    const uint64_t at_us = found_us(why, event, trip);
    const bool at_engagement = (event->a == AGV_STATE_STANDBY) && why->was_tripped && (at_us == trip->t_us);
    if (at_engagement || (at_us == WHY_NEVER)) {
        trip->cause_us = WHY_NEVER;
    } else {
        last_came(trip, at_us);
    }
}

/**
 * A command of motion that had come before. Its deadline counts from the engagement on: when it came last is known only
 * if it was ACTIVE already.
 */
static void explain_silent_command(const why_t *why, const agv_event_t *event, why_trip_t *trip) {
    const bool is_active = event->a != AGV_STATE_STANDBY;
    const uint64_t engaged_us = why->engagement.began_us;
    if (!is_active || ((engaged_us != WHY_NEVER) && (engaged_us >= trip->cause_us))) {
        trip->from_engagement = is_active && (engaged_us <= trip->cause_us + US_PER_MS);
    } else {
        last_came(trip, trip->t_us);
    }
}

/** A deadline expires when the last good frame is older than its limit. */
static void recorded_silence(const why_t *why, const agv_event_t *event, why_trip_t *trip) {
    const bool is_command = why_is_command(trip->message);
    const bool is_ai_heartbeat = trip->message == AGV_MSG_TURN_SIGNAL_COMMAND;
    trip->was_heard = is_seen(event, trip->message);
    if (!trip->was_heard && is_ai_heartbeat) {
        trip->limit = why->config.ai_never_seen_timeout_ms;
    }
    before(trip, recorded_limit_us(trip) + US_PER_MS);
    if (trip->was_heard && is_ai_heartbeat) {
        explain_ai_heartbeat(why, event, trip);
    } else if (trip->was_heard && is_command) {
        explain_silent_command(why, event, trip);
    } else if (trip->was_heard) {
        last_came(trip, trip->t_us);
    } else {
        trip->cause_us = is_command ? trip->cause_us : why->start_us;
        trip->from_engagement = is_command; /* the deadline began with it */
    }
}

static void recorded_value(const why_t *why, const agv_event_t *event, why_trip_t *trip) {
    for (uint32_t command = 0; command < AGV_COMMAND_COUNT; command++) {
        if (is_seen(event, (agv_message_t)command) && !agv_value_is_valid(command, event->frames[command])) {
            trip->message = (agv_message_t)command;
            trip->id = why->ids.of[command];
        }
    }
    why_value_limit(trip);
}

/** Whether P was missing for too long, not that the autopilot is off. Where both are missing, the shorter limit ended first. */
static bool waits_for_park(const why_t *why, const agv_event_t *event) {
    const uint32_t flags = event->frames[AGV_MSG_VEHICLE_STATUS][6];
    const bool off_is_missing = ((flags & AGV_VCU_FLAG_AUTOPILOT) != 0) ||
                                why->faults[AGV_FAULT_VCU_HEARTBEAT_LOST].active ||
                                why->faults[AGV_FAULT_VCU_HEARTBEAT_STUCK].active;
    const bool park_is_missing =
        (event->frames[AGV_MSG_GEAR_STATUS][0] != AGV_GEAR_P) || why->faults[AGV_FAULT_GEAR_STATUS_TIMEOUT].active;
    return park_is_missing &&
           (!off_is_missing || (why->config.park_confirm_timeout_ms < why->config.confirm_timeout_ms));
}

static void recorded_vehicle(const why_t *why, const agv_event_t *event, why_trip_t *trip) {
    const bool is_sum = trip->reason == AGV_FAULT_SAFE_STATE_UNCONFIRMED;
    if (is_sum && waits_for_park(why, event)) {
        trip->message = AGV_MSG_GEAR_STATUS;
        trip->id = why->ids.of[AGV_MSG_GEAR_STATUS];
        trip->limit = why->config.park_confirm_timeout_ms;
    }
    before(trip, recorded_limit_us(trip));
    trip->at_the_latest = is_sum;
    if (trip->reason == AGV_FAULT_MOVING_WHILE_SAFE) { /* slow readings in between prolong it */
        trip->cause_us = WHY_NEVER;
    }
}

static void explain(const why_t *why, const agv_event_t *event, why_trip_t *trip) {
    switch (trip->kind) {
    case WHY_SILENCE:
    case WHY_STUCK:
        trip->wrong_steps = message_has_to_increment(&why->config, trip->message);
        recorded_silence(why, event, trip);
        break;
    case WHY_SCORE:
        trip->at_the_latest = true;
        before(trip, ((uint64_t)trip->limit - 1) * cycle_us(trip));
        break;
    case WHY_VALUE:
        recorded_value(why, event, trip);
        break;
    case WHY_BUDGET:
    case WHY_MODE:
        before(trip, why_budget_us(why, trip->reason));
        trip->at_the_latest = true; /* with pauses it began earlier */
        trip->cause_us = (trip->reason != AGV_FAULT_MODE_FLAPPING) ? trip->cause_us : WHY_NEVER;
        break;
    case WHY_VEHICLE:
        recorded_vehicle(why, event, trip);
        break;
    case WHY_INTRUSION:
        trip->id = (trip->reason == AGV_FAULT_STATUS_ID_IN_USE) ? why->config.status_frame_id : WHY_NO_ID;
        trip->cause_us = (trip->reason == AGV_FAULT_COMMAND_TOO_FAST) ? WHY_NEVER : trip->t_us;
        break;
    default:
        before(trip, recorded_limit_us(trip));
        break;
    }
}

/** Whether the last frame of the message that tells made it trip. */
static bool is_decided_by_frame(const why_trip_t *trip) {
    return (trip->kind == WHY_BIT) || (trip->kind == WHY_SCORE) || (trip->kind == WHY_VALUE);
}

/** The last payload of a message, if there was one. */
static void show_payload(const why_t *why, const agv_event_t *event, why_trip_t *trip, agv_message_t message) {
    if (!is_seen(event, message)) {
        return;
    }
    const bool from_ai = why_is_command(message) && why->is_gateway;
    const uint64_t decided_us = (trip->kind == WHY_VALUE) ? trip->cause_us : trip->t_us;
    const uint64_t t_us = ((message == trip->message) && is_decided_by_frame(trip)) ? decided_us : WHY_NEVER;
    why_evidence_t evidence = {.t_us = t_us, .side = from_ai ? HAL_CAN_AI : HAL_CAN_VEHICLE};
    evidence.frame.id = why->ids.of[message];
    evidence.frame.length = (uint8_t)AGV_DLC;
    for (size_t i = 0; i < AGV_DLC; i++) {
        evidence.frame.data[i] = event->frames[message][i];
    }
    if (t_us == trip->cause_us) {
        trip->bad = evidence;
    }
    trip->evidence[trip->evidence_count] = evidence; /* two at most */
    trip->evidence_count++;
}

/** An invalid command trips in ACTIVE when it comes. In STANDBY it came before the reset, which it outlived (FSM-11). */
static const agv_event_t *event_that_shows(const why_t *why, const agv_event_t *event, why_trip_t *trip) {
    if ((trip->kind != WHY_VALUE) || (event->a != AGV_STATE_STANDBY)) {
        return event;
    }
    trip->cause_us = found_us(why, event, trip);
    return (trip->cause_us != WHY_NEVER) ? &why->bad_command_event : event;
}

void why_cause_recorded(const why_t *why, const agv_event_t *event, why_trip_t *trip) {
    const agv_event_t *shown = event_that_shows(why, event, trip);
    explain(why, shown, trip);
    show_payload(why, shown, trip, trip->message);
    show_payload(why, shown, trip, why_compared_with(trip->reason));
}

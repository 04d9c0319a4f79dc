#include "why/why.h"

#include <stdlib.h>

#include "agv/codec.h"
#include "agv/recorder.h"
#include "agv/state.h"
#include "text/units.h"
#include "why/why_internal.h"

/** The states, in the order of their index. */
static const uint8_t states[WHY_STATES] = {AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_STATE_ACTIVE, AGV_STATE_TRIPPED,
                                           AGV_STATE_SAFE};

static why_evidence_t evidence_of(hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    return (why_evidence_t){.t_us = t_us, .side = side, .frame = *frame};
}

why_evidence_t why_no_evidence(void) {
    return (why_evidence_t){.t_us = WHY_NEVER};
}

why_t *why_new(const agv_config_t *config) {
    why_t *why = calloc(1, sizeof *why);
    if (why == NULL) {
        return NULL;
    }
    why->config = *config;
    agv_config_ids(config, &why->ids);
    why->is_gateway = config->topology == AGV_TOPOLOGY_GATEWAY;
    why_life_start(why);
    why_intruder_start(why);
    why_track_start(why);
    why_engage_start(why);
    why_init_start(why);
    why->error = why_no_evidence();
    why->safe_frame = why_no_evidence();
    why->open_trip = SIZE_MAX;
    return why;
}

bool why_is_shadow(const why_t *why) {
    return why->config.shadow == AGV_SHADOW_ON;
}

void why_is_recording(why_t *why) {
    why->is_recording = true;
}

void why_is_recorder(why_t *why) {
    why->is_recorder = true;
}

void why_free(why_t *why) {
    if (why != NULL) {
        free(why->trips);
        free(why);
    }
}

/** The message of a frame's identifier; AGV_MSG_NONE: it is none, or another sender sent it. */
static agv_message_t message_of(const why_t *why, hal_can_side_t side, const hal_can_frame_t *frame) {
    const agv_message_t message = (agv_message_t)agv_ids_find(&why->ids, frame->id);
    const hal_can_side_t from = (why_is_command(message) && why->is_gateway) ? HAL_CAN_AI : HAL_CAN_VEHICLE;
    return (side == from) ? message : AGV_MSG_NONE;
}

const why_evidence_t *why_history(const why_message_t *message, uint32_t back) {
    if ((back >= message->count) || (back >= WHY_HISTORY)) {
        return NULL;
    }
    return &message->history[(message->count - 1 - back) % WHY_HISTORY];
}

const why_evidence_t *why_before(const why_message_t *message, uint64_t t_us) {
    uint32_t back = 0;
    const why_evidence_t *frame = why_history(message, back);
    while ((frame != NULL) && (frame->t_us >= t_us)) {
        back++;
        frame = why_history(message, back);
    }
    return frame;
}

const why_trip_t *why_open_trip(const why_t *why) {
    return (why->open_trip < why->trip_count) ? &why->trips[why->open_trip] : NULL;
}

static why_trip_t *open_trip(why_t *why) {
    return (why->open_trip < why->trip_count) ? &why->trips[why->open_trip] : NULL;
}

/** What a frame adds to the trip before it: the end of a silence, standstill. */
static void follow_trip(why_t *why, agv_message_t message, const why_evidence_t *frame) {
    const uint64_t t_us = frame->t_us;
    why_trip_t *trip = open_trip(why);
    if (trip == NULL) {
        return;
    }
    const bool ends_silence = (trip->kind == WHY_SILENCE) && (trip->message == message) && !trip->from_earlier_run;
    trip->parked = trip->parked || (t_us < why_park_until_us(why));
    trip->disengaged = trip->disengaged || (t_us < why_off_until_us(why));
    if (ends_silence && (trip->next_us == WHY_NEVER) && !why_was_withheld(trip)) {
        trip->next_us = t_us;
        why_show(trip, frame);
    }
    if ((message == AGV_MSG_WHEEL_SPEED) && (trip->stopped_us == WHY_NEVER) && why_wheels_are_slow(why)) {
        trip->stopped_us = t_us;
    }
}

void why_frame(why_t *why, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    const why_evidence_t evidence = evidence_of(side, frame, t_us);
    const agv_message_t message = message_of(why, side, frame);
    why->now_us = t_us;
    why_init_check(why, t_us);
    why_confirm_advance(why, t_us);
    if ((frame->flags & HAL_CAN_ERROR) != 0) {
        why->error = evidence;
        return;
    }
    const bool whole = (frame->flags == 0) && (frame->length == AGV_DLC);
    if ((message == AGV_MSG_NONE) || !whole) {
        why_life_refuse(why, message, &evidence);
        why_intruder_frame(why, &evidence);
        return;
    }
    if (message == AGV_MSG_VEHICLE_STATUS) {
        why_engage_frame(why, &evidence);
    }
    why_life_frame(why, message, &evidence);
    why_track_frame(why, message, &evidence);
    if (why_is_command(message) && !why->is_gateway) {
        why_budget_command(why, message, &evidence);
    }
    why_budget_frame(why, message, &evidence);
    follow_trip(why, message, &evidence);
}

/** Whether a frame takes the drive away. */
static bool is_safe(const why_t *why, const hal_can_frame_t *frame) {
    switch (agv_ids_find(&why->ids, frame->id)) {
    case AGV_MSG_GEAR_COMMAND:
        return frame->data[0] == AGV_GEAR_P;
    case AGV_MSG_THROTTLE_COMMAND:
        return frame->data[0] == 0;
    case AGV_MSG_TURN_SIGNAL_COMMAND:
        return (frame->data[4] & AGV_SIGNAL_AUTOPILOT_OFF) != 0;
    default:
        return false;
    }
}

void why_sent(why_t *why, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    const why_evidence_t evidence = evidence_of(side, frame, t_us);
    const agv_message_t message = (agv_message_t)agv_ids_find(&why->ids, frame->id);
    if (side != HAL_CAN_VEHICLE) {
        return;
    }
    if (why_is_command(message) && why->is_gateway && !agv_state_is_latched((agv_state_t)why->state)) {
        why_budget_command(why, message, &evidence);
    }
    if (!is_safe(why, frame)) {
        return;
    }
    if (message == AGV_MSG_GEAR_COMMAND) {
        why_confirm_park_sent(why, t_us);
    }
    why_trip_t *trip = open_trip(why);
    if ((trip != NULL) && (trip->first_safe_us == WHY_NEVER)) {
        trip->first_safe_us = t_us;
    }
    if ((why->safe_frame.t_us == WHY_NEVER) || (why->safe_frame.t_us / US_PER_MS != t_us / US_PER_MS)) {
        why->safe_frame = evidence;
    }
}

/** A trip more; NULL: no room. */
static why_trip_t *add_trip(why_t *why) {
    if (why->trip_count == WHY_TRIPS_MAX) {
        return NULL;
    }
    if (why->trip_count == why->trip_room) {
        const size_t room = (why->trip_room == 0) ? 4 : 2 * why->trip_room;
        why_trip_t *trips = realloc(why->trips, room * sizeof *trips);
        if (trips == NULL) {
            return NULL;
        }
        why->trips = trips;
        why->trip_room = room;
    }
    why->trip_count++;
    return &why->trips[why->trip_count - 1];
}

/**
 * Whether a trip at the start of a run was latched in an earlier one: of the faults that trip, the start itself finds only
 * those of the supervisor.
 */
static bool is_from_earlier_run(agv_fault_t reason, bool at_start) {
    return at_start && (why_row(reason)->kind != WHY_OWN);
}

/** Note a trip, and find its cause. @param at_start the run began in TRIPPED */
static why_trip_t *note_trip(why_t *why, agv_fault_t reason, uint64_t t_us, bool at_start) {
    why_trip_t *trip = add_trip(why);
    if (trip == NULL) {
        return NULL;
    }
    why_budget_advance(why, t_us);
    why_confirm_advance(why, t_us);
    *trip = (why_trip_t){.t_us = t_us,
                         .reason = reason,
                         .from_earlier_run = is_from_earlier_run(reason, at_start),
                         .first_safe_us = WHY_NEVER,
                         .confirmed_us = WHY_NEVER,
                         .stopped_us = WHY_NEVER};
    why_cause(why, trip);
    return trip;
}

static void on_trip(why_t *why, agv_fault_t reason, uint64_t t_us, bool at_start) {
    why_trip_t *trip = note_trip(why, reason, t_us, at_start);
    why->was_tripped = true;
    why->trackers[AGV_FAULT_MOVING_WHILE_SAFE].value = 0;
    why_confirm_start(why, t_us);
    if (trip == NULL) {
        return;
    }
    why->open_trip = why->trip_count - 1;
    /* What the supervisor sends in the pass that trips is reported before the trip. */
    if ((why->safe_frame.t_us != WHY_NEVER) && (why->safe_frame.t_us / US_PER_MS == t_us / US_PER_MS)) {
        trip->first_safe_us = why->safe_frame.t_us;
    }
    if ((why->messages[AGV_MSG_WHEEL_SPEED].count > 0) && why_wheels_are_slow(why)) {
        trip->stopped_us = t_us;
    }
}

static size_t index_of(uint8_t state) {
    for (size_t i = 0; i < WHY_STATES; i++) {
        if (states[i] == state) {
            return i;
        }
    }
    return (size_t)WHY_STATES;
}

static void leave_state(why_t *why, uint64_t t_us) {
    const size_t index = index_of(why->state);
    if ((index < WHY_STATES) && (t_us > why->state_since_us)) {
        why->state_us[index] += t_us - why->state_since_us;
    }
    why->state_since_us = t_us;
}

static void end_fault(why_t *why, agv_fault_t fault, uint64_t t_us) {
    why_fault_t *entry = &why->faults[fault];
    if (entry->active) {
        entry->active = false;
        entry->active_us += t_us - why->fault_since_us[fault];
    }
}

/** The supervisor had no power from here on until it was started again. */
static void stop(why_t *why, uint64_t stopped_us) {
    leave_state(why, stopped_us);
    for (size_t i = 0; i < why->fault_count; i++) {
        end_fault(why, (agv_fault_t)why->fault_order[i], stopped_us);
    }
    why->state = 0;
}

static void on_state(why_t *why, const agv_event_t *event, uint64_t t_us) {
    leave_state(why, t_us);
    if (event->a == 0) {
        why->start_us = t_us;
        why->was_tripped = false;
        why->startup_missing = 0;
        why->facts.vcu_speed_seen = false;
    }
    if (why->state == AGV_STATE_INIT) {
        why_init_end(why, t_us);
    }
    why->state = event->b;
    if (why->is_recorder) {
        why_engage_state(why, event, t_us);
    }
    if ((event->b == AGV_STATE_TRIPPED) && (event->c < AGV_FAULT_COUNT)) {
        on_trip(why, (agv_fault_t)event->c, t_us, event->a == 0);
    } else if (!agv_state_is_latched((agv_state_t)event->b)) {
        why->open_trip = SIZE_MAX;
    } else {
        why_trip_t *trip = open_trip(why);
        if ((event->b == AGV_STATE_SAFE) && (trip != NULL) && (trip->confirmed_us == WHY_NEVER)) {
            trip->confirmed_us = t_us;
        }
    }
}

/** What follows from a trip that the vehicle does not obey. */
static bool is_consequence(const why_t *why, agv_fault_t fault) {
    return why->was_tripped && (why_row(fault)->kind == WHY_VEHICLE);
}

static void raise(why_t *why, agv_fault_t fault, agv_fault_class_t fault_class, uint64_t t_us) {
    why_fault_t *entry = &why->faults[fault];
    const bool recorded = why->is_recording && is_consequence(why, fault);
    if (entry->times == 0) {
        entry->fault = fault;
        entry->first_us = t_us;
        entry->trip_us = WHY_NEVER;
        why->fault_order[why->fault_count] = (size_t)fault;
        why->fault_count++;
    }
    entry->from_recording = recorded && (entry->from_recording || (entry->times == 0));
    entry->in_init = (why->state == AGV_STATE_INIT) && (entry->in_init || (entry->times == 0));
    entry->fault_class = fault_class;
    if ((fault_class == AGV_CLASS_TRIP) && (entry->trip_us == WHY_NEVER)) {
        entry->trip_us = t_us;
    }
    if (!entry->active) {
        entry->times++;
        why->fault_since_us[fault] = t_us;
    }
    entry->active = true;
    if (is_consequence(why, fault) && (fault_class == AGV_CLASS_TRIP)) {
        why_trip_t *trip = note_trip(why, fault, t_us, false);
        if (trip != NULL) {
            trip->from_recording = recorded;
        }
    }
}

static void on_fault(why_t *why, const agv_event_t *event, uint64_t t_us) {
    if (event->a >= AGV_FAULT_COUNT) {
        return;
    }
    if ((event->a == AGV_FAULT_AI_COMMAND_OUT_OF_RANGE) && (event->c != 0)) {
        why->bad_command_event = *event;
    }
    if (event->c != 0) {
        raise(why, (agv_fault_t)event->a, (agv_fault_class_t)event->b, t_us);
    } else {
        end_fault(why, (agv_fault_t)event->a, t_us);
    }
    why->faults[event->a].left_out += why->is_recorder ? event->left_out : 0;
}

void why_event(void *ctx, const session_event_t *event) {
    why_t *why = ctx;
    const uint64_t t_us = event->t_ms * US_PER_MS;
    if (event->is_led) {
        return;
    }
    why->snapshot = why->is_recorder ? &event->recorded : NULL;
    switch ((agv_event_kind_t)event->recorded.kind) {
    case AGV_EVENT_STATE:
        if ((event->recorded.a == 0) && (event->stopped_ms * US_PER_MS >= why->state_since_us)) {
            stop(why, event->stopped_ms * US_PER_MS);
        }
        on_state(why, &event->recorded, t_us);
        break;
    case AGV_EVENT_FAULT:
        on_fault(why, &event->recorded, t_us);
        break;
    case AGV_EVENT_STARTUP:
        why->startup_missing = event->recorded.missing;
        break;
    default:
        break;
    }
    why->snapshot = NULL;
}

void why_end(why_t *why, uint64_t t_us) {
    leave_state(why, t_us);
    why->now_us = t_us;
    if (why->state == AGV_STATE_INIT) {
        why->init_due_us = t_us;
        why_init_check(why, t_us);
        why_init_end(why, t_us);
        const bool is_known = why->is_recorder && (why->startup_missing != 0); /* a recorder holds no messages */
        why->missing = is_known ? why->startup_missing : why_init_words(why->missing | why->startup_missing);
    }
    for (size_t i = 0; i < why->fault_count; i++) {
        why_fault_t *entry = &why->faults[why->fault_order[i]];
        if (entry->active) {
            entry->active_us += t_us - why->fault_since_us[entry->fault];
            why->fault_since_us[entry->fault] = t_us;
        }
    }
}

#include "agv/recorder.h"

#include <stddef.h>
#include <string.h>

#include "agv/checksum.h"
#include "agv/state.h"

_Static_assert((AGV_RECORDER_EVENTS & (AGV_RECORDER_EVENTS - 1u)) == 0u, "AGV_RECORDER_EVENTS must be a power of two");
_Static_assert(AGV_RECORDER_EVENTS >= 16u, "AGV_RECORDER_EVENTS must be at least 16: what one trip records");
_Static_assert(sizeof(agv_event_t) == offsetof(agv_event_t, frames) + ((size_t)AGV_MSG_COUNT * AGV_DLC) + 4u,
               "no padding: the checksum runs over all bytes");

#define RATE_TIME_MS 1000u

static uint32_t slot_of(uint32_t sequence) {
    return sequence & (AGV_RECORDER_EVENTS - 1u);
}

static uint32_t checksum(const agv_event_t *event) {
    return agv_crc32(AGV_CRC32_START, event, offsetof(agv_event_t, checksum)) >> 16u;
}

bool agv_event_is_valid(const agv_event_t *event) {
    return (event->kind != 0u) && (event->checksum == checksum(event));
}

static bool is_newer(uint32_t sequence, uint32_t other) {
    return ((sequence - other) - 1u) < (UINT32_MAX / 2u);
}

/* Drop invalid trips, and find the place of the next one: a free one, otherwise that of the oldest. */
static void start_trips(agv_recorder_t *recorder) {
    uint32_t oldest = 0u;
    for (uint32_t i = 0u; i < AGV_RECORDER_TRIPS; i++) {
        agv_event_t *const trip = &recorder->trips[i];
        if (!agv_event_is_valid(trip)) {
            (void)memset(trip, 0, sizeof *trip);
        } else if (is_newer(trip->sequence + 1u, recorder->next_sequence)) {
            recorder->next_sequence = trip->sequence + 1u; /* its event in the ring is incomplete */
            recorder->run = (uint8_t)(trip->run + 1u);
        } else {
            /* its event is in the ring, or was replaced */
        }
        const bool older = (trip->kind == 0u) || is_newer(recorder->trips[oldest].sequence, trip->sequence);
        if ((recorder->trips[oldest].kind != 0u) && older) {
            oldest = i;
        }
    }
    recorder->next_trip = (uint8_t)oldest;
}

void agv_recorder_start(agv_recorder_t *recorder) {
    bool found = false;
    uint32_t first = 0u;
    uint32_t next = 0u;
    recorder->run = 0u;
    for (uint32_t i = 0u; i < AGV_RECORDER_EVENTS; i++) {
        agv_event_t *const event = &recorder->events[i];
        if (!agv_event_is_valid(event) || (slot_of(event->sequence) != i)) {
            (void)memset(event, 0, sizeof *event);
            continue;
        }
        if (!found) {
            found = true;
            first = event->sequence;
            next = event->sequence;
        }
        if (is_newer(event->sequence + 1u, next)) {
            next = event->sequence + 1u;
            recorder->run = (uint8_t)(event->run + 1u);
        }
        if (is_newer(first, event->sequence)) {
            first = event->sequence;
        }
    }
    recorder->next_sequence = next;
    start_trips(recorder);
    /* stored_sequence is valid only if it lies within the events that are kept. */
    if ((recorder->stored_sequence - first) > (recorder->next_sequence - first)) {
        recorder->stored_sequence = first;
    }
    (void)memset(recorder->rates, 0, sizeof recorder->rates);
    recorder->seen = 0u;
    (void)memset(recorder->frames, 0, sizeof recorder->frames);
}

void agv_recorder_frame(agv_recorder_t *recorder, uint32_t message, const uint8_t data[AGV_DLC]) {
    if (message < (uint32_t)AGV_MSG_COUNT) {
        (void)memcpy(recorder->frames[message], data, AGV_DLC);
        recorder->seen |= (uint16_t)agv_message_bit(message);
    }
}

/* Whether a fault may be recorded: its fourth last recorded event is at least a second ago. */
static bool is_within_rate(agv_fault_rate_t *rate, uint32_t time_ms) {
    uint32_t *const oldest_ms = &rate->recorded_ms[rate->oldest % AGV_RECORDER_FAULTS_PER_S];
    if ((rate->count == (uint8_t)AGV_RECORDER_FAULTS_PER_S) && ((time_ms - *oldest_ms) < RATE_TIME_MS)) {
        rate->left_out = (uint16_t)(rate->left_out + ((rate->left_out < UINT16_MAX) ? 1u : 0u));
        return false;
    }
    *oldest_ms = time_ms;
    rate->oldest = (uint8_t)((rate->oldest + 1u) % AGV_RECORDER_FAULTS_PER_S);
    rate->count = (uint8_t)(rate->count + ((rate->count < (uint8_t)AGV_RECORDER_FAULTS_PER_S) ? 1u : 0u));
    return true;
}

static void fill(const agv_recorder_t *recorder, const agv_entry_t *entry, uint32_t time_ms, agv_event_t *event) {
    event->sequence = recorder->next_sequence;
    event->time_ms = time_ms;
    event->kind = entry->kind;
    event->a = entry->a;
    event->b = entry->b;
    event->c = entry->c;
    event->missing = entry->missing;
    event->state = entry->state;
    event->first_reason = entry->first_reason;
    event->left_out = 0u;
    event->seen = recorder->seen;
    (void)memcpy(event->frames, recorder->frames, sizeof event->frames);
    event->run = recorder->run;
    event->reserved = 0u;
}

/* Whether a start, which names no state before it, continues the trip of the run before. */
static bool continues_trip(const agv_recorder_t *recorder, const agv_event_t *event) {
    const agv_event_t *const before = &recorder->events[slot_of(event->sequence - 1u)];
    return (event->a == 0u) && agv_event_is_valid(before) && (before->first_reason == event->c);
}

static bool is_trip(const agv_event_t *event) {
    return (event->kind == (uint8_t)AGV_EVENT_STATE) && (event->b == (uint8_t)AGV_STATE_TRIPPED) &&
           (event->c < (uint8_t)AGV_FAULT_COUNT);
}

/* A trip replaces the oldest one. */
static void keep_trip(agv_recorder_t *recorder, const agv_event_t *event) {
    recorder->trips[recorder->next_trip % AGV_RECORDER_TRIPS] = *event;
    recorder->next_trip = (uint8_t)((recorder->next_trip + 1u) % AGV_RECORDER_TRIPS);
}

void agv_recorder_add(agv_recorder_t *recorder, const agv_entry_t *entry, uint32_t time_ms) {
    agv_event_t *const event = &recorder->events[slot_of(recorder->next_sequence)];
    const bool is_fault = (entry->kind == (uint8_t)AGV_EVENT_FAULT) && (entry->a < (uint8_t)AGV_FAULT_COUNT);
    if (is_fault && !is_within_rate(&recorder->rates[entry->a], time_ms)) {
        return;
    }
    fill(recorder, entry, time_ms, event);
    if (is_fault) {
        event->left_out = recorder->rates[entry->a].left_out;
        recorder->rates[entry->a].left_out = 0u;
    }
    event->checksum = (uint16_t)checksum(event);
    recorder->next_sequence++;
    if ((recorder->next_sequence - recorder->stored_sequence) > AGV_RECORDER_EVENTS) {
        recorder->stored_sequence++;
    }
    if (is_trip(event) && !continues_trip(recorder, event)) {
        keep_trip(recorder, event);
    }
}

void agv_recorder_add_crash(agv_recorder_t *recorder, const agv_entry_t *entry, const uint8_t addresses[AGV_DLC],
                            uint32_t time_ms) {
    agv_event_t *const event = &recorder->events[slot_of(recorder->next_sequence)];
    agv_recorder_add(recorder, entry, time_ms);
    event->seen = 0u;
    (void)memset(event->frames, 0, sizeof event->frames);
    (void)memcpy(event->frames[0], addresses, AGV_DLC);
    event->checksum = (uint16_t)checksum(event);
}

/* The number of trips after this one. */
static uint32_t newer_trips(const agv_recorder_t *recorder, const agv_event_t *trip) {
    uint32_t newer = 0u;
    for (uint32_t i = 0u; i < AGV_RECORDER_TRIPS; i++) {
        const agv_event_t *const other = &recorder->trips[i];
        newer += (agv_event_is_valid(other) && is_newer(other->sequence, trip->sequence)) ? 1u : 0u;
    }
    return newer;
}

bool agv_recorder_get_trip(const agv_recorder_t *recorder, uint32_t index, agv_event_t *event) {
    for (uint32_t i = 0u; i < AGV_RECORDER_TRIPS; i++) {
        const agv_event_t *const trip = &recorder->trips[i];
        if (agv_event_is_valid(trip) && (newer_trips(recorder, trip) == index)) {
            *event = *trip;
            return true;
        }
    }
    return false;
}

uint32_t agv_recorder_next_sequence(const agv_recorder_t *recorder) {
    return recorder->next_sequence;
}

/* The event in the ring; NULL if it was replaced or is not valid. */
static const agv_event_t *find(const agv_recorder_t *recorder, uint32_t sequence) {
    const agv_event_t *event = &recorder->events[slot_of(sequence)];
    return ((event->sequence == sequence) && agv_event_is_valid(event)) ? event : NULL;
}

bool agv_recorder_get(const agv_recorder_t *recorder, uint32_t sequence, agv_event_t *event) {
    const agv_event_t *found = find(recorder, sequence);
    if (found != NULL) {
        *event = *found;
    }
    return found != NULL;
}

const agv_event_t *agv_recorder_next_to_store(agv_recorder_t *recorder) {
    const agv_event_t *event = NULL;
    for (uint32_t i = 0u; (i < AGV_RECORDER_EVENTS) && (recorder->stored_sequence != recorder->next_sequence); i++) {
        event = find(recorder, recorder->stored_sequence);
        if (event != NULL) {
            break;
        }
        recorder->stored_sequence++;
    }
    return event;
}

void agv_recorder_stored(agv_recorder_t *recorder) {
    recorder->stored_sequence++;
}

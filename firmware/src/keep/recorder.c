#include "agv/recorder.h"

#include <stddef.h>
#include <string.h>

#include "agv/checksum.h"

_Static_assert((AGV_RECORDER_EVENTS & (AGV_RECORDER_EVENTS - 1u)) == 0u, "a power of two");
_Static_assert(sizeof(agv_event_t) == 108u, "no padding: the checksum runs over all bytes");

_Static_assert(offsetof(agv_event_t, run) - offsetof(agv_event_t, kind) == sizeof(agv_entry_t), "an entry is copied");
_Static_assert(offsetof(agv_event_t, state) - offsetof(agv_event_t, kind) == offsetof(agv_entry_t, state), "in order");

static uint32_t slot_of(uint32_t sequence) {
    return sequence & (AGV_RECORDER_EVENTS - 1u);
}

static uint32_t checksum(const agv_event_t *event) {
    return agv_crc32(AGV_CRC32_START, event, offsetof(agv_event_t, checksum)) >> 16u;
}

static bool is_valid(const agv_event_t *event) {
    return (event->kind != 0u) && (event->checksum == checksum(event));
}

static bool is_newer(uint32_t sequence, uint32_t other) {
    return ((sequence - other) - 1u) < (UINT32_MAX / 2u);
}

void agv_recorder_start(agv_recorder_t *recorder) {
    bool found = false;
    uint32_t first = 0u;
    uint32_t next = 0u;
    recorder->run = 0u;
    for (uint32_t i = 0u; i < AGV_RECORDER_EVENTS; i++) {
        agv_event_t *const event = &recorder->events[i];
        if (!is_valid(event) || (slot_of(event->sequence) != i)) {
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
    /* The mark of what is in flash counts if it lies among what is here. */
    if ((recorder->stored_sequence - first) > (next - first)) {
        recorder->stored_sequence = first;
    }
    recorder->seen = 0u;
    (void)memset(recorder->frames, 0, sizeof recorder->frames);
}

void agv_recorder_frame(agv_recorder_t *recorder, uint32_t message, const uint8_t data[AGV_DLC]) {
    if (message < (uint32_t)AGV_MSG_COUNT) {
        (void)memcpy(recorder->frames[message], data, AGV_DLC);
        recorder->seen |= (uint16_t)((uint32_t)1u << message);
    }
}

void agv_recorder_add(agv_recorder_t *recorder, const agv_entry_t *entry, uint32_t time_ms) {
    agv_event_t *event = &recorder->events[slot_of(recorder->next_sequence)];
    event->sequence = recorder->next_sequence;
    event->time_ms = time_ms;
    (void)memcpy(&((unsigned char *)event)[offsetof(agv_event_t, kind)], entry, sizeof *entry);
    event->run = recorder->run;
    event->seen = recorder->seen;
    (void)memcpy(event->frames, recorder->frames, sizeof event->frames);
    event->checksum = (uint16_t)checksum(event);
    recorder->next_sequence++;
    if ((recorder->next_sequence - recorder->stored_sequence) > AGV_RECORDER_EVENTS) {
        recorder->stored_sequence++;
    }
}

uint32_t agv_recorder_next_sequence(const agv_recorder_t *recorder) {
    return recorder->next_sequence;
}

/* The event in the ring, NULL when it is not there any more or not valid. */
static const agv_event_t *find(const agv_recorder_t *recorder, uint32_t sequence) {
    const agv_event_t *event = &recorder->events[slot_of(sequence)];
    return ((event->sequence == sequence) && is_valid(event)) ? event : NULL;
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

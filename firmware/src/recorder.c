#include "agv/recorder.h"

#include <string.h>

#include "agv/checksum.h"

_Static_assert((AGV_RECORDER_EVENTS & (AGV_RECORDER_EVENTS - 1u)) == 0u, "a power of two");
_Static_assert(sizeof(agv_event_t) == 108u, "no padding: the checksum runs over all bytes");

static agv_event_t *slot(agv_recorder_t *recorder, uint32_t sequence) {
    return &recorder->events[sequence & (AGV_RECORDER_EVENTS - 1u)];
}

static uint16_t checksum(const agv_event_t *event) {
    agv_event_t copy = *event;
    copy.checksum = 0u;
    return agv_crc16(&copy, sizeof copy);
}

static bool is_valid(const agv_event_t *event) {
    return (event->kind != 0u) && (event->checksum == checksum(event));
}

static bool is_newer(uint32_t sequence, uint32_t other) {
    return ((sequence - other) != 0u) && ((sequence - other) < 0x80000000u);
}

void agv_recorder_start(agv_recorder_t *recorder) {
    bool any = false;
    uint32_t newest = 0u;
    uint32_t oldest = 0u;
    uint8_t run = 0u;
    for (uint32_t i = 0u; i < AGV_RECORDER_EVENTS; i++) {
        agv_event_t *event = &recorder->events[i];
        if (!is_valid(event) || ((event->sequence & (AGV_RECORDER_EVENTS - 1u)) != i)) {
            (void)memset(event, 0, sizeof *event);
            continue;
        }
        if (!any || is_newer(event->sequence, newest)) {
            newest = event->sequence;
            run = event->run;
        }
        if (!any || is_newer(oldest, event->sequence)) {
            oldest = event->sequence;
        }
        any = true;
    }
    recorder->next_sequence = any ? (newest + 1u) : 0u;
    recorder->run = any ? (uint8_t)(run + 1u) : 0u;
    /* What is still here and newer than the mark was not stored before the reset. */
    if (!any || is_newer(oldest, recorder->stored_sequence) ||
        is_newer(recorder->stored_sequence, recorder->next_sequence)) {
        recorder->stored_sequence = any ? oldest : 0u;
    }
    recorder->seen = 0u;
    (void)memset(recorder->frames, 0, sizeof recorder->frames);
}

void agv_recorder_frame(agv_recorder_t *recorder, agv_message_t message, const uint8_t data[AGV_DLC]) {
    if ((uint32_t)message < (uint32_t)AGV_MSG_COUNT) {
        (void)memcpy(recorder->frames[message], data, AGV_DLC);
        recorder->seen |= (uint16_t)(1u << (uint32_t)message);
    }
}

void agv_recorder_add(agv_recorder_t *recorder, const agv_event_t *event) {
    agv_event_t *target = slot(recorder, recorder->next_sequence);
    *target = *event;
    target->sequence = recorder->next_sequence;
    target->run = recorder->run;
    target->seen = recorder->seen;
    (void)memcpy(target->frames, recorder->frames, sizeof target->frames);
    target->checksum = checksum(target);
    if ((recorder->next_sequence - recorder->stored_sequence) >= AGV_RECORDER_EVENTS) {
        recorder->stored_sequence = recorder->next_sequence - (AGV_RECORDER_EVENTS - 1u);
    }
    recorder->next_sequence++;
}

uint32_t agv_recorder_next_sequence(const agv_recorder_t *recorder) {
    return recorder->next_sequence;
}

bool agv_recorder_get(const agv_recorder_t *recorder, uint32_t sequence, agv_event_t *event) {
    *event = recorder->events[sequence & (AGV_RECORDER_EVENTS - 1u)];
    return (event->sequence == sequence) && is_valid(event);
}

bool agv_recorder_next_to_store(agv_recorder_t *recorder, agv_event_t *event) {
    bool found = false;
    for (uint32_t i = 0u; (i < AGV_RECORDER_EVENTS) && !found; i++) {
        if (recorder->stored_sequence == recorder->next_sequence) {
            break;
        }
        found = agv_recorder_get(recorder, recorder->stored_sequence, event);
        recorder->stored_sequence += found ? 0u : 1u;
    }
    return found;
}

void agv_recorder_stored(agv_recorder_t *recorder, uint32_t sequence) {
    recorder->stored_sequence = sequence + 1u;
}

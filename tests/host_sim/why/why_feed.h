/** @file why_feed.h Frames and events for the tests of why/: one line each, times in ms. */
#ifndef WHY_FEED_H
#define WHY_FEED_H

#include <string.h>

#include "agv/recorder.h"
#include "agv/state.h"
#include "why/why.h"

static inline void feed_frame(why_t *why, hal_can_side_t side, uint32_t id, const char bytes[8], uint64_t t_ms) {
    hal_can_frame_t frame = {.id = id, .length = 8};
    memcpy(frame.data, bytes, 8);
    why_frame(why, side, &frame, t_ms * 1000);
}

/** A 363h whose counter runs; times are multiples of 10 ms. */
static inline void feed_mode(why_t *why, uint8_t mode, uint64_t t_ms) {
    const char bytes[8] = {0, 0, 0, 0, 0, 0, (char)mode, (char)(t_ms / 10)};
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, bytes, t_ms);
}

static inline void feed_state(why_t *why, uint8_t from, uint8_t to, uint8_t reason, uint64_t t_ms) {
    const session_event_t event = {.t_ms = t_ms,
                                   .recorded = {.kind = AGV_EVENT_STATE, .a = from, .b = to, .c = reason}};
    why_event(why, &event);
}

static inline void feed_fault(why_t *why, uint8_t fault, uint8_t fault_class, bool active, uint64_t t_ms) {
    const session_event_t event = {
        .t_ms = t_ms, .recorded = {.kind = AGV_EVENT_FAULT, .a = fault, .b = fault_class, .c = active ? 1 : 0}};
    why_event(why, &event);
}

/** A trip from ACTIVE. */
static inline void feed_trip(why_t *why, uint8_t reason, uint64_t t_ms) {
    feed_fault(why, reason, AGV_CLASS_TRIP, true, t_ms);
    feed_state(why, AGV_STATE_ACTIVE, AGV_STATE_TRIPPED, reason, t_ms);
}

#endif

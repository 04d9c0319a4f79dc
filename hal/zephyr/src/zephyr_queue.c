/* Queue of frames to send, in the order of arbitration. Of the frames with one identifier only the newest waits. Those that were
 * given together all wait, the older one first: they carry different things. */
#include "zephyr_hal_internal.h"

#include <string.h>

/* Frames with one identifier that are given within this time belong together. */
enum { TOGETHER_MS = 1 };

/* @return since when the identifier waits */
static uint32_t drop_older(zephyr_hal_side_t *side, uint32_t id, uint32_t now_ms) {
    uint32_t age_ms = 0u;
    uint32_t kept = 0u;
    for (uint32_t i = 0u; i < side->waiting_count; i++) {
        const zephyr_hal_waiting_t *const waiting = &side->waiting[i];
        if ((waiting->frame.id == id) && ((now_ms - waiting->taken_ms) > (uint32_t)TOGETHER_MS)) {
            age_ms = MAX(age_ms, now_ms - waiting->since_ms);
        } else {
            side->waiting[kept] = *waiting;
            kept++;
        }
    }
    side->waiting_count = kept;
    return now_ms - age_ms;
}

static bool insert(zephyr_hal_side_t *side, const zephyr_hal_waiting_t *frame) {
    if (side->waiting_count == ZEPHYR_HAL_QUEUE_SIZE) {
        return false;
    }
    uint32_t place = side->waiting_count;
    while ((place > 0u) && (frame->frame.id < side->waiting[place - 1u].frame.id)) {
        side->waiting[place] = side->waiting[place - 1u];
        place--;
    }
    side->waiting[place] = *frame;
    side->waiting_count++;
    return true;
}

bool zephyr_queue_put(zephyr_hal_side_t *side, const hal_can_frame_t *frame, uint32_t now_ms) {
    const uint32_t since_ms = drop_older(side, frame->id, now_ms);
    const zephyr_hal_waiting_t waiting = {.frame = *frame, .taken_ms = now_ms, .since_ms = since_ms};
    return insert(side, &waiting);
}

void zephyr_queue_put_back(zephyr_hal_side_t *side, const zephyr_hal_waiting_t *taken_back) {
    for (uint32_t i = 0u; i < side->waiting_count; i++) {
        if (side->waiting[i].frame.id == taken_back->frame.id) {
            side->waiting[i].since_ms = taken_back->since_ms;
            return;
        }
    }
    (void)insert(side, taken_back);
}

void zephyr_queue_drop_first(zephyr_hal_side_t *side) {
    side->waiting_count--;
    (void)memmove(&side->waiting[0], &side->waiting[1], side->waiting_count * sizeof side->waiting[0]);
}

uint32_t zephyr_queue_pending_ms(const zephyr_hal_side_t *side, bool in_flight, uint32_t now_ms) {
    const bool sent_counts = in_flight && !side->sent_is_purged;
    uint32_t oldest_ms = sent_counts ? (now_ms - side->sent.since_ms) : 0u;
    for (uint32_t i = 0u; i < side->waiting_count; i++) {
        oldest_ms = MAX(oldest_ms, now_ms - side->waiting[i].since_ms);
    }
    const bool any = sent_counts || (side->waiting_count > 0u);
    return any ? MAX(oldest_ms, 1u) : 0u;
}

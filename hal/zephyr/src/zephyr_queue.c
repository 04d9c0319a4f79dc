/* Queue of frames to send, in the order of arbitration. Of two frames with the same identifier the older one is sent
 * first. */
#include "zephyr_hal_internal.h"

#include <string.h>

bool zephyr_queue_insert(zephyr_hal_side_t *side, const hal_can_frame_t *frame, uint32_t now_ms) {
    if (side->waiting_count == ZEPHYR_HAL_QUEUE_SIZE) {
        return false;
    }
    uint32_t place = side->waiting_count;
    while ((place > 0u) && (frame->id < side->waiting[place - 1u].frame.id)) {
        side->waiting[place] = side->waiting[place - 1u];
        place--;
    }
    side->waiting[place] = (zephyr_hal_waiting_t){.frame = *frame, .taken_ms = now_ms};
    side->waiting_count++;
    return true;
}

void zephyr_queue_drop_first(zephyr_hal_side_t *side) {
    side->waiting_count--;
    (void)memmove(&side->waiting[0], &side->waiting[1], side->waiting_count * sizeof side->waiting[0]);
}

uint32_t zephyr_queue_pending_ms(const zephyr_hal_side_t *side, bool in_flight, uint32_t now_ms) {
    const bool sent_counts = in_flight && !side->sent_is_purged;
    uint32_t oldest_ms = sent_counts ? (now_ms - side->sent_taken_ms) : 0u;
    for (uint32_t i = 0u; i < side->waiting_count; i++) {
        oldest_ms = MAX(oldest_ms, now_ms - side->waiting[i].taken_ms);
    }
    const bool any = sent_counts || (side->waiting_count > 0u);
    return any ? MAX(oldest_ms, 1u) : 0u;
}

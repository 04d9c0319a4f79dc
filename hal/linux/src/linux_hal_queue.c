/* Queue of frames to send, in the order of arbitration. At most one frame is in the kernel. Of the frames with one identifier
 * only the newest waits. Those that were given together all wait: they carry different things. */
#include <string.h>

#include "linux_hal_internal.h"

enum { US_PER_MS = 1000, STANDARD_SHIFT = 18 };

/* Frames with one identifier that are given within this time belong together. */
enum { TOGETHER_US = 1000 };

/* Patience with a frame whose echo does not come: after a purge; without one, so that a stall is reported before (SUP-7). */
enum { PATIENCE_US = 100000, PATIENCE_UNPURGED = 10, DOUBLED_MAX = 7 };

/* Rank in the arbitration: the lower one wins. An 11-bit ID is compared with the first 11 bits of a 29-bit one. */
static uint64_t rank_of(const hal_can_frame_t *frame) {
    const bool is_extended = (frame->flags & HAL_CAN_EXTENDED) != 0;
    const uint64_t value = is_extended ? frame->id : (uint64_t)frame->id << STANDARD_SHIFT;
    return value * 2 + (is_extended ? 1 : 0);
}

static bool can_be_sent(const hal_can_frame_t *frame) {
    const bool is_extended = (frame->flags & HAL_CAN_EXTENDED) != 0;
    return (frame->flags & (HAL_CAN_FD | HAL_CAN_ERROR)) == 0 && frame->length <= sizeof frame->data &&
           frame->id <= (is_extended ? 0x1FFFFFFFu : 0x7FFu);
}

static bool is_same(const hal_can_frame_t *a, const hal_can_frame_t *b) {
    return a->id == b->id && a->flags == b->flags && a->length == b->length &&
           ((a->flags & HAL_CAN_REMOTE) != 0 || memcmp(a->data, b->data, a->length) == 0);
}

static linux_can_write_t write_now(linux_hal_side_t *side, const linux_hal_waiting_t *frame, uint64_t now_us) {
    const linux_can_write_t result = linux_can_write(&side->can, &frame->frame);
    if (result == LINUX_CAN_TAKEN) {
        side->sent = *frame;
        side->in_flight = true;
        side->sent_is_purged = false;
        side->given_us = now_us;
    }
    return result;
}

/* @return since when the identifier waits */
static uint64_t drop_older(linux_hal_side_t *side, const hal_can_frame_t *frame, uint64_t now_us) {
    uint64_t since_us = now_us;
    size_t kept = 0;
    for (size_t i = 0; i < side->waiting_count; i++) {
        const linux_hal_waiting_t *waiting = &side->waiting[i];
        if (rank_of(&waiting->frame) == rank_of(frame) && now_us > waiting->taken_us + (uint64_t)TOGETHER_US) {
            since_us = (waiting->since_us < since_us) ? waiting->since_us : since_us;
        } else {
            side->waiting[kept] = *waiting;
            kept++;
        }
    }
    side->waiting_count = kept;
    return since_us;
}

/* Insert behind all frames of higher or equal priority, so that of two with the same identifier the older one is sent
 * first. */
static void insert(linux_hal_side_t *side, const linux_hal_waiting_t *frame) {
    size_t place = side->waiting_count;
    while (place > 0 && rank_of(&frame->frame) < rank_of(&side->waiting[place - 1].frame)) {
        side->waiting[place] = side->waiting[place - 1];
        place--;
    }
    side->waiting[place] = *frame;
    side->waiting_count++;
}

bool linux_hal_queue_take(linux_hal_side_t *side, const hal_can_frame_t *frame, uint64_t now_us) {
    if (!can_be_sent(frame)) {
        return false;
    }
    const uint64_t since_us = drop_older(side, frame, now_us);
    const linux_hal_waiting_t waiting = {.frame = *frame, .taken_us = now_us, .since_us = since_us};
    if (!side->in_flight && side->waiting_count == 0) {
        const bool is_taken = write_now(side, &waiting, now_us) == LINUX_CAN_TAKEN;
        if (is_taken || since_us == now_us) {
            return is_taken;
        }
        /* it replaced a frame that was accepted: it waits in its place */
    }
    if (side->waiting_count == LINUX_HAL_QUEUE_SIZE) {
        return false;
    }
    insert(side, &waiting);
    return true;
}

void linux_hal_queue_give(linux_hal_side_t *side, uint64_t now_us) {
    if (side->in_flight || side->waiting_count == 0) {
        return;
    }
    const linux_hal_waiting_t first = side->waiting[0];
    if (write_now(side, &first, now_us) == LINUX_CAN_TAKEN) {
        side->waiting_count--;
        memmove(&side->waiting[0], &side->waiting[1], side->waiting_count * sizeof side->waiting[0]);
    }
}

/* The frames are compared, because a frame that was discarded at bus-off may still be sent while another one is in
 * flight. */
void linux_hal_queue_left(linux_hal_side_t *side, const hal_can_frame_t *frame) {
    side->given_up = 0;
    if (side->in_flight && is_same(frame, &side->sent.frame)) {
        side->in_flight = false;
    }
}

/* An echo may be lost without a trace. But the frame may also be in the kernel still, because the bus is blocked, and leave
 * later. So the patience doubles until an echo comes: few frames gather in a blocked kernel. */
static void give_up(linux_hal_side_t *side, uint64_t now_us, uint64_t patience_us) {
    if (!side->in_flight || now_us <= side->given_us + (patience_us << side->given_up)) {
        return;
    }
    side->in_flight = false;
    if (side->given_up < DOUBLED_MAX) {
        side->given_up++;
    }
}

void linux_hal_queue_look(linux_hal_side_t *side, uint64_t now_us) {
    give_up(side, now_us, (uint64_t)PATIENCE_US * PATIENCE_UNPURGED);
}

void linux_hal_queue_purge(linux_hal_side_t *side, uint64_t now_us) {
    side->waiting_count = 0;
    side->sent_is_purged = true;
    give_up(side, now_us, PATIENCE_US);
}

void linux_hal_queue_discard(linux_hal_side_t *side) {
    side->waiting_count = 0;
    side->in_flight = false;
    side->given_up = 0;
}

uint32_t linux_hal_queue_pending_ms(const linux_hal_side_t *side, uint64_t now_us) {
    const bool sent_counts = side->in_flight && !side->sent_is_purged;
    if (!sent_counts && side->waiting_count == 0) {
        return 0;
    }
    uint64_t oldest_us = sent_counts ? side->sent.since_us : UINT64_MAX;
    for (size_t i = 0; i < side->waiting_count; i++) {
        oldest_us = (side->waiting[i].since_us < oldest_us) ? side->waiting[i].since_us : oldest_us;
    }
    const uint64_t age_ms = (now_us > oldest_us) ? (now_us - oldest_us) / US_PER_MS : 0;
    return (age_ms == 0) ? 1 : (uint32_t)age_ms;
}

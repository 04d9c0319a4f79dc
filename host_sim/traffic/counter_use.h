/**
 * @file counter_use.h
 * How an alive counter counts (SUP-2).
 */
#ifndef HOST_SIM_COUNTER_USE_H
#define HOST_SIM_COUNTER_USE_H

#include <stdint.h>

/** How a counter counts, as a whole. */
typedef enum {
    COUNTER_UNSEEN,     /**< too few frames to tell */
    COUNTER_INCREMENTS, /**< by 1 to 3, always: the setting `increments` fits */
    COUNTER_ANY,        /**< it changes in another way: only `any` fits */
    COUNTER_STUCK       /**< it never changed */
} counter_kind_t;

/** All zero: no frame yet. */
typedef struct {
    uint64_t frames;
    uint64_t steps;         /**< by 1 to 3 */
    uint64_t other_steps;   /**< by more */
    uint64_t other_at_us;   /**< the first of them */
    uint64_t repeats;       /**< frames with the counter of the frame before */
    uint64_t changed_us;    /**< when it changed last, or the first frame */
    uint64_t longest_us;    /**< the longest time in which frames came, but no change */
    uint64_t longest_at_us; /**< when that began */
    uint8_t value;
} counter_use_t;

/** Frames that are needed to say how a counter counts. */
#define COUNTER_USE_FRAMES_MIN 20u

/** Take the counter of a frame. */
void counter_use_add(counter_use_t *use, uint8_t value, uint64_t t_us);

/** How it counts. */
counter_kind_t counter_use_kind(const counter_use_t *use);

/** "increments", "any", "stuck"; "unknown" for COUNTER_UNSEEN. */
const char *counter_use_word(counter_kind_t kind);

#endif

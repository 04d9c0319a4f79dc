/**
 * @file score.h
 * How faults that need more than one frame, or more than one moment, are counted, so that gaps and single good frames do
 * not start the count again.
 */
#ifndef AGV_SCORE_H
#define AGV_SCORE_H

#include <stdbool.h>
#include <stdint.h>

/**
 * Score of a fault that needs N frames: a bad frame adds 2, a good one takes 1 away, within 0 and 2 N. The fault is present
 * from the frame on that brings the score to 2 N until it is back at 0. With N of 1 the last frame decides.
 */
typedef struct {
    uint8_t value;
    bool present;
} agv_score_t;

/** Count a frame. @param frames N, 1..100 */
void agv_score_add(agv_score_t *score, bool bad, uint32_t frames);

/**
 * Budget of T ms: up by 1 with every ms in which its condition holds, down by 1 with every second ms in which it does not,
 * within 0 and T. The fault is present from T on until the budget is back at 0.
 */
typedef struct {
    uint16_t value_ms;
    bool half; /**< one ms without the condition has passed that has not counted yet */
    bool present;
} agv_budget_t;

/** Time has passed. @param limit_ms T */
void agv_budget_add(agv_budget_t *budget, bool condition, uint32_t elapsed_ms, uint32_t limit_ms);

#endif

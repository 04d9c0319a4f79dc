/**
 * @file score.h
 * Scores and budgets: they debounce faults that need several bad frames, or a condition that lasts. Gaps between frames
 * and single good frames do not restart the count.
 */
#ifndef AGV_SCORE_H
#define AGV_SCORE_H

#include <stdbool.h>
#include <stdint.h>

/**
 * Score of a fault that needs N bad frames. A bad frame adds 2, a good frame subtracts 1, within 0..2 N. The fault becomes
 * present when the score reaches 2 N, and ends when it is 0 again. With N = 1 the last frame decides.
 */
typedef struct {
    uint8_t value;
    bool present;
} agv_score_t;

/** Count a frame. @param frames N, 1..100 */
void agv_score_add(agv_score_t *score, bool bad, uint32_t frames);

/**
 * Time budget of T ms. Each ms with the condition adds 1, two ms without it subtract 1, within 0..T. The fault becomes
 * present when the budget reaches T, and ends when it is 0 again.
 */
typedef struct {
    uint16_t value_ms;
    uint8_t bits; /**< of score.c: the condition held at the last tick; one ms without it has not been subtracted yet */
    bool present;
} agv_budget_t;

/**
 * Whether a condition counts as held since the last tick. If that was 1 ms ago, the result is the condition of the last tick:
 * a condition that is seen for the first time has lasted for 0 ms. If the tick is late, it is the condition of now.
 */
static inline bool agv_held_since_tick(bool before, bool now, uint32_t elapsed_ms) {
    return (elapsed_ms == 1u) ? before : now;
}

/**
 * Add the time since the last tick, as agv_held_since_tick() says.
 * @param condition what it is now  @param elapsed_ms 0 for a frame, which changes nothing  @param limit_ms T
 */
void agv_budget_add(agv_budget_t *budget, bool condition, uint32_t elapsed_ms, uint32_t limit_ms);

/** As agv_budget_add(), but time without the condition subtracts nothing: the caller sets the budget to 0. */
void agv_budget_gather(agv_budget_t *budget, bool condition, uint32_t elapsed_ms, uint32_t limit_ms);

#endif

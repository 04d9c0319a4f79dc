/* What frama-c is given: the contracts, then the shipped source as it is. */
#include "reset.h"

// ---- Inside, step by step.

/*@ requires \valid_read(reset);
    assigns \nothing;
    ensures \result == press(reset);
*/
static uint32_t press_timer(const agv_reset_button_t *reset);

/*@ requires \valid_read(reset);
    assigns \nothing;
    ensures \result == long_press(reset);
*/
static uint32_t long_press_timer(const agv_reset_button_t *reset);

/*@ requires \valid(reset) && \valid(timers) && \separated(reset, timers);
    assigns reset->began_after, reset->answered, timers->phase[press(reset)], timers->phase[long_press(reset)];
    ensures reset->began_after == 0 && reset->answered == 0;
    ensures timers->phase[press(reset)] == 0 && timers->phase[long_press(reset)] == 0;
*/
static void forget_press(agv_reset_button_t *reset, agv_timers_t *timers);

/*@ requires \valid_read(reset) && \valid_read(config) && \separated(reset, config);
    assigns \nothing;
    ensures \result == 0 <==> all_held(reset, config);
*/
static uint32_t missing_lately(const agv_reset_button_t *reset, const agv_config_t *config);

/*@ requires \valid_read(reset);
    assigns \nothing;
    ensures \result != 0 <==> surely_up(reset);
*/
static bool is_up(const agv_reset_button_t *reset);

/*@ requires \valid(reset) && \valid_read(config) && \separated(reset, config) && held_in_range(reset, config);
    assigns reset->held_ms[0 .. 8];
    ensures held_in_range(reset, config);
    ensures \forall integer i; 0 <= i < 9 && (lacking & bit_of(i)) != 0 ==> reset->held_ms[i] == 0;
    ensures \forall integer i; 0 <= i < 9 && (lacking & bit_of(i)) == 0 ==>
                reset->held_ms[i] == \old(held_for(reset, config, i, elapsed_ms));
*/
static void follow_conditions(agv_reset_button_t *reset, const agv_config_t *config, uint32_t elapsed_ms,
                              uint32_t lacking);

/*@ requires \valid(reset) && \valid(timers) && \separated(reset, timers);
    assigns reset->began_after, timers->due_ms;
    assigns timers->since_ms[press(reset)], timers->since_ms[long_press(reset)];
    assigns timers->phase[press(reset)], timers->phase[long_press(reset)];
    ensures reset->button != 1 ==> reset->began_after == \old(reset->began_after);
    ensures reset->button == 1 ==> (reset->began_after != 0 <==> \old(reset->began_after) != 0 || reset->was_up != 0);
    ensures reached(timers, press(reset)) <==> \old(reached(timers, press(reset)));
    ensures reached(timers, long_press(reset)) <==> \old(reached(timers, long_press(reset)));
*/
static void follow_press(agv_reset_button_t *reset, agv_timers_t *timers);

/*@ requires \valid_read(reset) && \valid_read(timers) && \valid(missing) && \separated(missing, reset, timers);
    requires reset->button <= 3;
    assigns *missing;
    ensures \result == AGV_PRESS_RESETS <==> *missing == 0;
    ensures \result == AGV_PRESS_RESETS || \result == AGV_PRESS_IN_VAIN;
    ensures *missing == 0 <==>
                \old(*missing) == 0 && reset->began_after != 0 && (reset->button == 1 || reset->button == 2) &&
                !reached(timers, long_press(reset));
*/
static agv_press_result_t press_result(const agv_reset_button_t *reset, const agv_timers_t *timers, uint32_t *missing);

#include "decide/reset_button.c"

/*
 * The reset by a button (FSM-3, HW-3) as a contract in ACSL: every button, press, timers, elapsed time, configuration and
 * combination of missing conditions. Written from docs/requirements.md. A button is 0 unknown, 1 down, 2 up, 3 unheard.
 * A compiler sees declarations only.
 */
#ifndef PROOF_UNBOUNDED_RESET_H
#define PROOF_UNBOUNDED_RESET_H

#include "decide/reset_button.h"
#include "timers.h"

/*@
  // ---- The nine conditions, by their bits.
  logic integer bit_of(integer i) =
      i == 0 ? 0x01 : i == 1 ? 0x02 : i == 2 ? 0x04 : i == 3 ? 0x08 : i == 4 ? 0x10 : i == 5 ? 0x20 : i == 6 ? 0x80 :
      i == 7 ? 0x100 : 0x400;

  // How long condition i has held, after a step.
  logic integer held_for{L}(agv_reset_button_t *r, agv_config_t *c, integer i, integer elapsed_ms) =
      r->held_ms[i] + elapsed_ms <= c->reset_hold_ms ? r->held_ms[i] + elapsed_ms : c->reset_hold_ms;

  predicate all_held{L}(agv_reset_button_t *r, agv_config_t *c) =
      \forall integer i; 0 <= i < 9 ==> r->held_ms[i] >= c->reset_hold_ms;
  predicate held_in_range{L}(agv_reset_button_t *r, agv_config_t *c) =
      \forall integer i; 0 <= i < 9 ==> r->held_ms[i] <= c->reset_hold_ms;

  // ---- The two timers of each button: 1 s to 5 s (reset_hold_ms, reset_hold_max_ms; the rows of the timers).
  logic integer press{L}(agv_reset_button_t *r) = r->is_pin != 0 ? AGV_TIMER_PIN_PRESS : AGV_TIMER_PRESS;
  logic integer long_press{L}(agv_reset_button_t *r) = r->is_pin != 0 ? AGV_TIMER_PIN_PRESS_LONG : AGV_TIMER_PRESS_LONG;

  // ---- A button that is up, and was so in three 363h in a row; the debounced pin counts at once.
  predicate surely_up{L}(agv_reset_button_t *r) = r->button == 2 && r->up_frames == 3;

  predicate reset_ready{L}(agv_reset_button_t *r, agv_timers_t *t, agv_config_t *c) =
      \valid(r) && \valid(t) && \valid_read(c) && \separated(r, t, c) && r->button <= 3;
*/

/*@ requires \valid(reset) && reset->up_frames <= 3;
    assigns reset->button, reset->up_frames;
    ensures vcu_alive == 0 ==> reset->up_frames == \old(reset->up_frames);
    ensures vcu_alive != 0 ==> reset->up_frames == (remote_lost != 0 || down != 0 ? 0 :
                \old(reset->up_frames) < 3 ? \old(reset->up_frames) + 1 : 3);
    ensures reset->button == (vcu_alive == 0 ? \old(reset->button) : remote_lost != 0 ? 3 : down != 0 ? 1 : 2);
*/
void agv_reset_button_report(agv_reset_button_t *reset, bool vcu_alive, bool remote_lost, bool down);

/*@ requires \valid(reset);
    assigns reset->button, reset->up_frames;
    ensures reset->button == button && reset->up_frames == 3;
*/
void agv_reset_button_read(agv_reset_button_t *reset, uint8_t button);

/*@ requires \valid(reset);
    assigns reset->button, reset->up_frames;
    ensures reset->button == 0 && reset->up_frames == 0;
*/
void agv_reset_button_lose(agv_reset_button_t *reset);

/*@ // At the trip: a press that began before it is forgotten, and no condition has held yet.
    requires \valid(reset) && \valid(timers) && \separated(reset, timers);
    assigns reset->began_after, reset->answered, reset->was_up, reset->held_ms[0 .. 8];
    assigns timers->phase[press(reset)], timers->phase[long_press(reset)];
    ensures reset->began_after == 0 && (reset->was_up != 0 <==> surely_up(reset));
    ensures timers->phase[press(reset)] == 0 && timers->phase[long_press(reset)] == 0;
    ensures \forall integer i; 0 <= i < 9 ==> reset->held_ms[i] == 0;
*/
void agv_reset_button_trip(agv_reset_button_t *reset, agv_timers_t *timers);

/*@ // FSM-3: a reset if and only if it is the release of a press that began after the trip, that lasted for 1 s to 5 s, and in
    // all of whose last 1 s every condition held.
    requires reset_ready(reset, timers, config) && \valid(missing);
    requires \separated(missing, reset, timers, config);
    requires held_in_range(reset, config) && config->reset_hold_ms >= 1;
    assigns reset->held_ms[0 .. 8], reset->was_up, reset->began_after, reset->answered, *missing, timers->due_ms;
    assigns timers->since_ms[press(reset)], timers->since_ms[long_press(reset)];
    assigns timers->phase[press(reset)], timers->phase[long_press(reset)];
    ensures held_in_range(reset, config) && (reset->was_up != 0 <==> surely_up(reset));
    ensures \result == AGV_PRESS_RESETS <==>
                reset->button == 2 && \old(reset->began_after) != 0 && \old(reset->answered) == 0 &&
                \old(reached(timers, press(reset))) && !\old(reached(timers, long_press(reset))) &&
                all_held(reset, config);
    ensures \result == AGV_PRESS_RESETS ==> \forall integer i; 0 <= i < 9 ==> (lacking & bit_of(i)) == 0;
    // A press begins with a rising edge, and ends when the button is not down.
    ensures reset->began_after != 0 ==> reset->button == 1 && (\old(reset->began_after) != 0 || \old(reset->was_up) != 0);
    ensures reset->button != 1 ==> timers->phase[press(reset)] == 0 && timers->phase[long_press(reset)] == 0;
    ensures \forall integer i; 0 <= i < 9 && (lacking & bit_of(i)) != 0 ==> reset->held_ms[i] == 0;
    ensures \forall integer i; 0 <= i < 9 && (lacking & bit_of(i)) == 0 ==>
                reset->held_ms[i] == \old(held_for(reset, config, i, elapsed_ms));
*/
agv_press_result_t agv_reset_button_step(agv_reset_button_t *reset, agv_timers_t *timers, const agv_config_t *config,
                                         uint32_t elapsed_ms, uint32_t lacking, uint32_t *missing);

#endif

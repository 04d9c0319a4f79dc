/*
 * The timers (TIM-2) as a contract in ACSL: ages and limits for every time of the clock, also across its wrap, every
 * configuration in its ranges and every order of calls. Written from docs/requirements.md and the comments of the table of
 * timers: which setting limits a timer, and what kind it is. A compiler sees declarations only.
 */
#ifndef PROOF_UNBOUNDED_TIMERS_H
#define PROOF_UNBOUNDED_TIMERS_H

#include "arithmetic.h"
#include "base/timers.h"

/*@ predicate is_timer(integer timer) = 0 <= timer < AGV_TIMER_COUNT; */

// ---- The rows are proven on their own (ROWS). All else holds for any table of limits that a configuration has: no
// function here writes the configuration.
#ifdef ROWS
/*@
  // The limit of each timer. A duration is over at its limit, a deadline 1 ms later, a step, which is due 1 ms after the last
  // one, 2 ms later.
  logic integer limit{L}(agv_config_t *c, integer timer) =
      timer == AGV_TIMER_BUS_OFF ? c->bus_off_recovery_ms :
      timer == AGV_TIMER_AI_BUS_OFF ? c->bus_off_recovery_ms :
      timer == AGV_TIMER_WHEELS_SLOW ? c->standstill_ms :
      timer == AGV_TIMER_STANDSTILL ? c->standstill_ms :
      timer == AGV_TIMER_WHEELS_STOOD ? c->hold_standstill_ms :
      timer == AGV_TIMER_ANGLE ? c->hold_age_ms :
      timer == AGV_TIMER_ENGAGED ? c->engaged_grace_ms :
      timer == AGV_TIMER_DISENGAGED ? c->reengage_ms :
      timer == AGV_TIMER_ENGAGEMENT_1 ? c->mode_flapping_ms :
      timer == AGV_TIMER_ENGAGEMENT_2 ? c->mode_flapping_ms :
      timer == AGV_TIMER_ENGAGEMENT_3 ? c->mode_flapping_ms :
      timer == AGV_TIMER_BOTH_MODES ? c->mode_invalid_ms :
      timer == AGV_TIMER_NO_MODE ? c->mode_none_ms :
      timer == AGV_TIMER_AI_NEVER_SEEN ? c->ai_never_seen_timeout_ms :
      timer == AGV_TIMER_OTHER_TURN_SIGNAL ? c->wrong_id_set_ms :
      timer == AGV_TIMER_OTHER_VEHICLE_STATUS ? c->wrong_id_set_ms :
      timer == AGV_TIMER_INIT_GOOD ? c->init_hold_ms :
      timer == AGV_TIMER_STARTUP ? c->startup_timeout_ms :
      timer == AGV_TIMER_PARK_WAIT ? c->park_timeout_ms :
      timer == AGV_TIMER_CONFIRMED ? c->confirmed_ms :
      timer == AGV_TIMER_STOP ? c->stop_timeout_ms :
      timer == AGV_TIMER_PRESS ? c->reset_hold_ms :
      timer == AGV_TIMER_PRESS_LONG ? c->reset_hold_max_ms :
      timer == AGV_TIMER_PIN_PRESS ? c->reset_hold_ms :
      timer == AGV_TIMER_PIN_PRESS_LONG ? c->reset_hold_max_ms :
      timer == AGV_TIMER_WATCHDOG_FED ? c->watchdog_period_ms :
      AGV_TIMER_TX_TURN_SIGNAL <= timer <= AGV_TIMER_TX_AI ? c->tx_stalled_ms :
      timer == AGV_TIMER_MESSAGE_TURN_SIGNAL_COMMAND ? c->ai_heartbeat_timeout_ms :
      timer == AGV_TIMER_MESSAGE_GEAR_COMMAND ? c->gear_command_timeout_ms :
      timer == AGV_TIMER_MESSAGE_THROTTLE_COMMAND ? c->throttle_command_timeout_ms :
      timer == AGV_TIMER_MESSAGE_STEERING_COMMAND ? c->steering_command_timeout_ms :
      timer == AGV_TIMER_MESSAGE_VEHICLE_STATUS ? c->vcu_heartbeat_timeout_ms :
      timer == AGV_TIMER_MESSAGE_GEAR_STATUS ? c->gear_status_timeout_ms :
      timer == AGV_TIMER_MESSAGE_THROTTLE_STATUS ? c->throttle_status_timeout_ms :
      timer == AGV_TIMER_MESSAGE_STEERING_STATUS ? c->eps_heartbeat_timeout_ms :
      timer == AGV_TIMER_MESSAGE_EPS_STATUS ? c->eps_status_timeout_ms :
      timer == AGV_TIMER_MESSAGE_STEERING_POSITION ? c->steering_position_timeout_ms :
      timer == AGV_TIMER_MESSAGE_WHEEL_SPEED ? c->wheel_speed_timeout_ms :
      c->event_hold_ms; // a transient fault is active

  logic integer more(integer timer) = timer == AGV_TIMER_WATCHDOG_FED ? 2 :
      (timer == AGV_TIMER_ANGLE || timer == AGV_TIMER_DISENGAGED ||
      AGV_TIMER_ENGAGEMENT_1 <= timer <= AGV_TIMER_BOTH_MODES ||
      AGV_TIMER_AI_NEVER_SEEN <= timer <= AGV_TIMER_OTHER_VEHICLE_STATUS || timer == AGV_TIMER_STARTUP ||
      timer == AGV_TIMER_PRESS_LONG || timer == AGV_TIMER_PIN_PRESS_LONG || AGV_TIMER_TX_TURN_SIGNAL <= timer <= AGV_TIMER_TX_AI ||
      AGV_TIMER_MESSAGE_TURN_SIGNAL_COMMAND <= timer <= AGV_TIMER_MESSAGE_WHEEL_SPEED) ? 1 : 0;

  // The age at which a timer has reached its limit.
  logic integer span{L}(agv_config_t *c, integer timer) = limit(c, timer) + more(timer);
*/
#else
/*@ axiomatic rows {
      logic integer limit(agv_config_t *c, integer timer);
      logic integer span(agv_config_t *c, integer timer);
    }
*/
#endif

/*@
  // agv_config_check allows 60000 ms at most.
  predicate limits_in_range{L}(agv_config_t *c) = \forall integer timer; is_timer(timer) ==>
      0 <= limit(c, timer) <= 60000 && limit(c, timer) <= span(c, timer) <= limit(c, timer) + 2;

  // ---- A timer: stopped is 0, running 1, reached 2. The age counts only while it runs.
  predicate running{L}(agv_timers_t *t, integer timer) = t->phase[timer] == 1;
  predicate reached{L}(agv_timers_t *t, integer timer) = t->phase[timer] == 2;
  logic integer age{L}(agv_timers_t *t, integer timer) = (uint16_t)(t->now_ms - t->since_ms[timer]);

  // Between two calls: no running timer reaches its limit before due_ms; one that was started beyond its limit reaches it
  // when the time advances.
  logic integer until_due{L}(agv_timers_t *t) = (uint32_t)(t->due_ms - t->now_ms);
  predicate due_is_right{L}(agv_timers_t *t, agv_config_t *c) =
      until_due(t) <= 65535 &&
      \forall integer timer; is_timer(timer) && running(t, timer) && until_due(t) != 0 ==>
          until_due(t) + age(t, timer) <= span(c, timer);

  predicate same_timer{L, M}(agv_timers_t *t, integer timer) =
      \at(t->phase[timer], M) == \at(t->phase[timer], L) && \at(t->since_ms[timer], M) == \at(t->since_ms[timer], L);

  predicate others_same{L, M}(agv_timers_t *t, integer timer) =
      \forall integer k; is_timer(k) && k != timer ==> same_timer{L, M}(t, k);

  predicate timers_ready{L}(agv_timers_t *t) = \valid(t);
*/

/*@ assigns \nothing;
    ensures \result == ((uint32_t)(now_ms - then_ms) <= 0x7FFFFFFF ? (uint32_t)(now_ms - then_ms) : 0);
*/
uint32_t agv_age_ms(uint32_t now_ms, uint32_t then_ms);

/*@ requires \valid_read(config) && is_timer(timer);
    assigns \nothing;
    ensures \result == limit(config, timer);
*/
uint32_t agv_timer_limit_ms(const agv_config_t *config, uint32_t timer);

/*@ // The theorem: a running timer reaches its limit exactly in the step with which its age comes to it.
    requires timers_ready(timers) && \valid_read(config) && \separated(timers, config) && limits_in_range(config);
    requires due_is_right(timers, config);
    assigns timers->now_ms, timers->now_us, timers->due_ms, timers->phase[0 .. AGV_TIMER_COUNT - 1];
    ensures due_is_right(timers, config);
    behavior forward:
        assumes 1 <= (uint32_t)(time_ms - timers->now_ms) <= 0x7FFFFFFF;
        ensures timers->now_ms == time_ms;
        ensures \forall integer k; is_timer(k) && \old(running(timers, k)) &&
                    \old(age(timers, k)) + (uint32_t)(time_ms - \old(timers->now_ms)) >= span(config, k) ==>
                    reached(timers, k);
        ensures \forall integer k; is_timer(k) && \old(running(timers, k)) &&
                    \old(age(timers, k)) + (uint32_t)(time_ms - \old(timers->now_ms)) < span(config, k) ==>
                    running(timers, k) &&
                    age(timers, k) == \old(age(timers, k)) + (uint32_t)(time_ms - \old(timers->now_ms));
        ensures \forall integer k; is_timer(k) && !\old(running(timers, k)) ==>
                    timers->phase[k] == \old(timers->phase[k]);
    behavior not_forward:
        assumes !(1 <= (uint32_t)(time_ms - timers->now_ms) <= 0x7FFFFFFF);
        ensures timers->now_ms == \old(timers->now_ms) && timers->due_ms == \old(timers->due_ms);
        ensures \forall integer k; is_timer(k) ==> timers->phase[k] == \old(timers->phase[k]);
    complete behaviors;
    disjoint behaviors;
*/
void agv_timers_advance(agv_timers_t *timers, const agv_config_t *config, uint32_t time_ms, uint32_t time_us);

/*@ requires timers_ready(timers);
    assigns timers->now_ms, timers->now_us, timers->due_ms;
    ensures timers->now_ms == time_ms && until_due(timers) == 0;
*/
void agv_timers_set_time(agv_timers_t *timers, uint32_t time_ms);

/*@ requires timers_ready(timers);
    assigns timers->due_ms, timers->phase[0 .. AGV_TIMER_COUNT - 1];
    ensures until_due(timers) == 0;
    ensures \forall integer k; is_timer(k) ==> timers->phase[k] == 0;
*/
void agv_timers_start(agv_timers_t *timers);

/*@ requires timers_ready(timers) && is_timer(timer);
    assigns timers->due_ms, timers->since_ms[timer], timers->phase[timer];
    ensures running(timers, timer);
    ensures \let since = (uint32_t)(timers->now_ms - since_ms);
            age(timers, timer) == (since > 0x7FFFFFFF ? 0 : since > 65535 ? 65535 : since);
    ensures \forall agv_config_t *c; \separated(c, timers) && \old(due_is_right(timers, c)) ==> due_is_right(timers, c);
*/
void agv_timer_start_at(agv_timers_t *timers, uint32_t timer, uint32_t since_ms);

/*@ requires timers_ready(timers) && is_timer(timer);
    assigns timers->due_ms, timers->since_ms[timer], timers->phase[timer];
    ensures running(timers, timer) && age(timers, timer) == 0;
    ensures \forall agv_config_t *c; \separated(c, timers) && \old(due_is_right(timers, c)) ==> due_is_right(timers, c);
*/
void agv_timer_start(agv_timers_t *timers, uint32_t timer);

/*@ requires timers_ready(timers) && is_timer(timer);
    assigns timers->phase[timer];
    ensures timers->phase[timer] == 0;
    ensures \forall agv_config_t *c; \separated(c, timers) && \old(due_is_right(timers, c)) ==> due_is_right(timers, c);
*/
void agv_timer_stop(agv_timers_t *timers, uint32_t timer);

/*@ requires \valid_read(timers) && \valid_read(config) && is_timer(timer);
    assigns \nothing;
    ensures running(timers, timer) && age(timers, timer) <= limit(config, timer) ==> \result == age(timers, timer);
    ensures !running(timers, timer) ==> \result == limit(config, timer);
*/
uint32_t agv_timer_spent_ms(const agv_timers_t *timers, const agv_config_t *config, uint32_t timer);

/*@ requires \valid_read(timers) && is_timer(timer);
    assigns \nothing;
    ensures \result <==> reached(timers, timer);
*/
bool agv_timer_reached(const agv_timers_t *timers, uint32_t timer);

/*@ requires timers_ready(timers) && is_timer(timer);
    assigns timers->due_ms, timers->since_ms[timer], timers->phase[timer];
    ensures !condition ==> timers->phase[timer] == 0 && !\result;
    ensures condition && \old(timers->phase[timer]) == 0 ==> running(timers, timer) && age(timers, timer) == 0 && !\result;
    ensures condition && \old(timers->phase[timer]) != 0 ==>
                same_timer{Pre, Post}(timers, timer) && (\result <==> \old(reached(timers, timer)));
    ensures \result <==> reached(timers, timer);
    ensures \forall agv_config_t *c; \separated(c, timers) && \old(due_is_right(timers, c)) ==> due_is_right(timers, c);
*/
bool agv_timer_while(agv_timers_t *timers, uint32_t timer, bool condition);

/*@ requires \valid_read(timers) && is_timer(timer);
    assigns \nothing;
    ensures \result <==> running(timers, timer);
*/
bool agv_timer_is_within(const agv_timers_t *timers, uint32_t timer);

/*@ requires \valid_read(timers) && is_timer(timer);
    assigns \nothing;
    ensures \result <==> timers->phase[timer] != 0;
*/
bool agv_timer_is_started(const agv_timers_t *timers, uint32_t timer);

#endif

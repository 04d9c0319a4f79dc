/* What frama-c is given: the contracts, then the shipped source as it is. */
#include <stddef.h>
#include <string.h>

#include "timers.h"

// ---- Inside of the timers.

/*@ requires \valid_read(config) && is_timer(timer);
    assigns \nothing;
    ensures \result == limit(config, timer);
*/
static uint32_t limit_of(const agv_config_t *config, uint32_t timer);

/*@ requires \valid_read(config) && is_timer(timer) && limits_in_range(config);
    assigns \nothing;
    ensures \result == span(config, timer);
*/
static uint32_t time_to_limit_ms(const agv_config_t *config, uint32_t timer);

/*@ requires \valid_read(timers) && is_timer(timer);
    assigns \nothing;
    ensures \result <==> running(timers, timer);
*/
static bool is_running(const agv_timers_t *timers, uint32_t timer);

/*@ requires \valid_read(timers) && is_timer(timer);
    assigns \nothing;
    ensures \result == (uint16_t)(timers->now_ms - timers->since_ms[timer]);
*/
static uint32_t age_of(const agv_timers_t *timers, uint32_t timer);

/*@ requires timers_ready(timers) && \valid_read(config) && \separated(timers, config) && limits_in_range(config);
    requires step_ms <= 0x7FFFFFFF;
    assigns timers->phase[0 .. AGV_TIMER_COUNT - 1];
    ensures \forall integer k; is_timer(k) ==>
                (\old(running(timers, k)) && age(timers, k) + step_ms >= span(config, k) ?
                     reached(timers, k) : timers->phase[k] == \old(timers->phase[k]));
    ensures 1 <= \result <= 65535;
    ensures \forall integer k; is_timer(k) && running(timers, k) ==> \result + age(timers, k) + step_ms <= span(config, k);
*/
static uint32_t evaluate(agv_timers_t *timers, const agv_config_t *config, uint32_t step_ms);

/* The two bytes that limit_of copies are one setting: they stand in the order of their indices. */
#define AGV_SETTING(name, preset, lowest, highest, unit, weakens, scope, meaning)                                      \
    _Static_assert(offsetof(agv_config_t, name) == AGV_SETTING_##name * sizeof(uint16_t), #name);
#define AGV_CHOICE(name, words, last, weakens, scope, meaning) AGV_SETTING(name, 0, 0, 0, 0, 0, 0, 0)
#include "agv/config_settings.def"
#undef AGV_SETTING
#undef AGV_CHOICE

#ifdef __FRAMAC__
#define memcpy(to, from, size) (*(to) = ((const uint16_t *)config)[rows[timer].setting])
#endif

#include "base/timers.c"

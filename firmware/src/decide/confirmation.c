#include "decide/confirmation.h"

#include "base/score.h"

void agv_confirmation_start(agv_confirmation_t *confirmation, agv_timers_t *timers, bool at_tick) {
    *confirmation = (agv_confirmation_t){0};
    confirmation->off.at_tick = at_tick;
    confirmation->park.at_tick = at_tick;
    agv_timer_stop(timers, AGV_TIMER_CONFIRMED);
}

void agv_confirmation_park_sent(agv_confirmation_t *confirmation) {
    confirmation->park_sent = true;
}

/* Add the time since the last tick. Returns whether the confirmation is missing and the total has reached the limit. */
static bool add(agv_missing_t *missing, bool is_missing, uint32_t elapsed_ms, uint32_t limit_ms) {
    if (elapsed_ms == 0u) {
        return false;
    }
    if (agv_held_since_tick(missing->at_tick, is_missing, elapsed_ms)) {
        const uint32_t sum_ms = missing->sum_ms;
        missing->sum_ms = (uint16_t)((elapsed_ms < (limit_ms - sum_ms)) ? (sum_ms + elapsed_ms) : limit_ms);
    }
    missing->at_tick = is_missing;
    return is_missing && (missing->sum_ms == limit_ms);
}

void agv_confirmation_step(agv_confirmation_t *confirmation, agv_timers_t *timers, const agv_config_t *config,
                           uint32_t elapsed_ms, bool autopilot_off, bool in_park) {
    const bool off_late = add(&confirmation->off, !autopilot_off, elapsed_ms, config->confirm_timeout_ms);
    bool park_late = false;
    if (confirmation->park_sent) {
        park_late = add(&confirmation->park, !in_park, elapsed_ms, config->park_confirm_timeout_ms);
    } else {
        confirmation->park.at_tick = elapsed_ms != 0u; /* P may be sent in this step */
    }
    const bool both = autopilot_off && in_park;
    if (agv_timer_while(timers, AGV_TIMER_CONFIRMED, both)) {
        confirmation->off.sum_ms = 0u;
        confirmation->park.sum_ms = 0u;
    }
    confirmation->unconfirmed = off_late || park_late || (confirmation->unconfirmed && !both);
}

#include "decide/confirmation.h"

void agv_confirmation_start(agv_confirmation_t *confirmation, agv_timers_t *timers) {
    *confirmation = (agv_confirmation_t){0};
    agv_timer_stop(timers, AGV_TIMER_CONFIRMED);
}

void agv_confirmation_park_sent(agv_confirmation_t *confirmation) {
    confirmation->park_sent = true;
}

/* Add time without a confirmation. Returns whether the total has reached the limit. */
static bool add(uint16_t *sum_ms, bool missing, uint32_t elapsed_ms, uint32_t limit_ms) {
    if (missing) {
        const uint32_t room_ms = (*sum_ms < limit_ms) ? (limit_ms - *sum_ms) : 0u;
        *sum_ms = (uint16_t)(*sum_ms + ((elapsed_ms < room_ms) ? elapsed_ms : room_ms));
    }
    return missing && (*sum_ms >= limit_ms) && (elapsed_ms != 0u);
}

void agv_confirmation_step(agv_confirmation_t *confirmation, agv_timers_t *timers, const agv_config_t *config,
                           uint32_t elapsed_ms, bool autopilot_off, bool in_park) {
    const bool off_late = add(&confirmation->off_missing_ms, !autopilot_off, elapsed_ms, config->confirm_timeout_ms);
    const bool park_late = add(&confirmation->park_missing_ms, confirmation->park_sent && !in_park, elapsed_ms,
                               config->park_confirm_timeout_ms);
    const bool both = autopilot_off && in_park;
    if (agv_timer_while(timers, AGV_TIMER_CONFIRMED, both)) {
        confirmation->off_missing_ms = 0u;
        confirmation->park_missing_ms = 0u;
    }
    confirmation->unconfirmed = !both && (confirmation->unconfirmed || off_late || park_late);
}

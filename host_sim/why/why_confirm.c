/* The confirmations of the safe state: for how long each was missing in all (FSM-4). */
#include "agv/codec.h"
#include "agv/state.h"
#include "text/units.h"
#include "why/why_internal.h"

uint64_t why_off_until_us(const why_t *why) {
    const uint32_t both = AGV_VCU_FLAG_MANUAL | AGV_VCU_FLAG_AUTOPILOT;
    const bool off = !why->engagement.engaged && ((why->facts.mode_bits & both) != both);
    return off ? why_fresh_until_us(why, AGV_MSG_VEHICLE_STATUS) : 0;
}

uint64_t why_park_until_us(const why_t *why) {
    return (why->facts.gear == AGV_GEAR_P) ? why_fresh_until_us(why, AGV_MSG_GEAR_STATUS) : 0;
}

void why_confirm_start(why_t *why, uint64_t t_us) {
    why_confirmation_t *confirmation = &why->confirmation;
    const bool is_sent = confirmation->is_park_sent && (confirmation->park_sent_us / US_PER_MS >= t_us / US_PER_MS);
    *confirmation = (why_confirmation_t){.at_us = t_us, .missing_us = t_us, .is_park_sent = is_sent};
}

void why_confirm_park_sent(why_t *why, uint64_t t_us) {
    why_confirm_advance(why, t_us);
    why->confirmation.is_park_sent = true;
    why->confirmation.park_sent_us = t_us;
}

static uint64_t later(uint64_t one_us, uint64_t other_us) {
    return (one_us > other_us) ? one_us : other_us;
}

/** It was missing from a time on, which may be later than now. */
static void add(why_missing_t *missing, uint64_t from_us, uint64_t t_us) {
    if (from_us < t_us) {
        missing->began_us = (missing->sum_us == 0) ? from_us : missing->began_us;
        missing->sum_us += t_us - from_us;
    }
}

void why_confirm_advance(why_t *why, uint64_t t_us) {
    why_confirmation_t *confirmation = &why->confirmation;
    if (!agv_state_is_latched((agv_state_t)why->state) || (t_us <= confirmation->at_us)) {
        return;
    }
    const uint64_t off_us = later(why_off_until_us(why), confirmation->at_us);
    const uint64_t park_us = later(why_park_until_us(why), confirmation->at_us);
    const uint64_t both_until_us = (off_us < park_us) ? off_us : park_us;
    if (both_until_us >= confirmation->missing_us + ((uint64_t)why->config.confirmed_ms * US_PER_MS)) {
        confirmation->off.sum_us = 0;
        confirmation->park.sum_us = 0;
    }
    add(&confirmation->off, off_us, t_us);
    add(&confirmation->park, confirmation->is_park_sent ? park_us : t_us, t_us);
    confirmation->missing_us = (both_until_us < t_us) ? t_us : confirmation->missing_us;
    confirmation->at_us = t_us;
}

/** How much of a limit is left; less than 0: it was more. */
static int64_t left_us(const why_missing_t *missing, uint16_t limit_ms) {
    return ((int64_t)limit_ms * US_PER_MS) - (int64_t)missing->sum_us;
}

bool why_confirm_waits_for_park(const why_t *why, uint64_t t_us) {
    const why_confirmation_t *confirmation = &why->confirmation;
    const bool off_is_missing = why_off_until_us(why) <= t_us;
    const bool park_is_missing = why_park_until_us(why) <= t_us;
    return park_is_missing && (!off_is_missing || (left_us(&confirmation->park, why->config.park_confirm_timeout_ms) <
                                                   left_us(&confirmation->off, why->config.confirm_timeout_ms)));
}

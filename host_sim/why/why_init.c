/* What keeps the supervisor in INIT: nothing is supervised there but the way out of it. */
#include <stdlib.h>

#include "agv/codec.h"
#include "agv/recorder.h"
#include "agv/state.h"
#include "text/units.h"
#include "why/why_internal.h"

/* The first frames of a healthy bus come within some cycles. */
enum { CHECK_EVERY_US = 10000, FIRST_FRAMES_US = 200000 };

static bool is_fresh(const why_t *why, agv_message_t number, uint64_t t_us) {
    return t_us < why_fresh_until_us(why, number);
}

/** The messages whose silence trips must be fresh, apart from those with an alive counter: they have to beat. */
static bool are_fresh(const why_t *why, uint64_t t_us) {
    for (int i = 0; i < AGV_FAULT_COUNT; i++) {
        const why_row_t *row = why_row((agv_fault_t)i);
        const bool counts = (row->kind == WHY_SILENCE) && !why_is_command(row->message) &&
                            (message_counter_at(row->message) == MESSAGE_NO_COUNTER) &&
                            agv_config_is_trip(&why->config, (uint32_t)i);
        if (counts && !is_fresh(why, row->message, t_us)) {
            return false;
        }
    }
    return true;
}

static bool has_trip_cause(const why_t *why) {
    for (size_t i = 0; i < why->fault_count; i++) {
        const why_fault_t *fault = &why->faults[why->fault_order[i]];
        if (fault->active && (fault->fault_class == AGV_CLASS_TRIP)) {
            return true;
        }
    }
    return false;
}

bool why_wheels_are_slow(const why_t *why) {
    const int32_t limit = why->config.standstill_speed_mm_s;
    return (abs(why->facts.left_mm_s) < limit) && (abs(why->facts.right_mm_s) < limit);
}

bool why_vcu_is_slow(const why_t *why) {
    const uint32_t limit = why->config.standstill_vcu_counts;
    return (limit == AGV_STANDSTILL_VCU_ANY) || (why->facts.vcu_speed <= limit);
}

static bool is_slow(const why_t *why, uint64_t t_us) {
    return is_fresh(why, AGV_MSG_VEHICLE_STATUS, t_us) && is_fresh(why, AGV_MSG_WHEEL_SPEED, t_us) &&
           why_wheels_are_slow(why) && why_vcu_is_slow(why);
}

static uint32_t missing_now(const why_t *why, uint64_t t_us) {
    const bool manual = why->facts.mode_known && ((why->facts.mode_bits & AGV_VCU_FLAG_MANUAL) != 0) &&
                        ((why->facts.mode_bits & AGV_VCU_FLAG_AUTOPILOT) == 0);
    uint32_t missing = 0;
    missing |= is_fresh(why, AGV_MSG_VEHICLE_STATUS, t_us) ? 0 : AGV_MISSING_VCU_HEARTBEAT;
    missing |= is_fresh(why, AGV_MSG_STEERING_STATUS, t_us) ? 0 : AGV_MISSING_EPS_HEARTBEAT;
    missing |= manual ? 0 : AGV_MISSING_MANUAL;
    missing |= are_fresh(why, t_us) ? 0 : AGV_MISSING_MESSAGES;
    missing |= is_slow(why, t_us) ? 0 : AGV_MISSING_STANDSTILL;
    missing |= has_trip_cause(why) ? AGV_MISSING_TRIP_CAUSE : 0;
    missing |= (why->facts.throttle > why->config.throttle_idle_counts) ? AGV_MISSING_THROTTLE : 0;
    return missing;
}

uint16_t why_init_words(uint32_t missing) {
    const bool drives = (missing & (AGV_MISSING_MANUAL | AGV_MISSING_STANDSTILL)) != 0;
    return (uint16_t)(drives ? (missing & ~AGV_MISSING_THROTTLE) : missing);
}

void why_init_start(why_t *why) {
    for (size_t bit = 0; bit < WHY_MISSING_BITS; bit++) {
        why->missing_us[bit] = WHY_NEVER;
    }
}

void why_init_check(why_t *why, uint64_t t_us) {
    if ((why->state != AGV_STATE_INIT) || (t_us < why->init_due_us)) {
        return;
    }
    const uint32_t missing = missing_now(why, t_us);
    why->init_due_us = t_us + (uint64_t)CHECK_EVERY_US;
    for (size_t bit = 0; bit < WHY_MISSING_BITS; bit++) {
        if (((missing >> bit) & 1) != 0) {
            why->missing_us[bit] = t_us;
        }
    }
}

/** What is missing now, or was within the time for which everything has to be there, a start apart. */
void why_init_end(why_t *why, uint64_t t_us) {
    const uint64_t hold_us = ((uint64_t)why->config.init_hold_ms * US_PER_MS) + (2 * (uint64_t)CHECK_EVERY_US);
    uint32_t missing = missing_now(why, t_us);
    why->lacking_at_end = (uint16_t)missing;
    for (size_t bit = 0; bit < WHY_MISSING_BITS; bit++) {
        const uint64_t last_us = why->missing_us[bit];
        const bool counts = (last_us != WHY_NEVER) && (last_us > why->start_us + (uint64_t)FIRST_FRAMES_US);
        missing |= (counts && (last_us + hold_us >= t_us)) ? (1u << bit) : 0;
    }
    why->lacking = (uint16_t)missing;
    why->missing = why_init_words(missing);
}

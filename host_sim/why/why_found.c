/* What was found, for others to read. */
#include "text/units.h"
#include "why/why_internal.h"

size_t why_trip_count(const why_t *why) {
    return why->trip_count;
}

const why_trip_t *why_trip(const why_t *why, size_t index) {
    return &why->trips[index];
}

size_t why_fault_count(const why_t *why) {
    return why->fault_count;
}

const why_fault_t *why_fault(const why_t *why, size_t index) {
    return &why->faults[why->fault_order[index]];
}

uint64_t why_state_us(const why_t *why, size_t index) {
    return why->state_us[index];
}

uint64_t why_supervised_us(const why_t *why) {
    uint64_t sum = 0;
    for (size_t i = 1; i < WHY_STATES; i++) {
        sum += why->state_us[i];
    }
    return sum;
}

bool why_was_engaged(const why_t *why) {
    return (why->engagement.count > 0) || (why->state_us[WHY_ACTIVE] > 0); /* a flight recorder has no frames */
}

bool why_began_in_autopilot(const why_t *why) {
    return why->began_in_autopilot;
}

bool why_left_init_late(const why_t *why) {
    const uint64_t normal_us = ((uint64_t)why->config.init_hold_ms + (uint64_t)MS_PER_S) * US_PER_MS;
    return (why_supervised_us(why) == 0) || (why->state_us[WHY_INIT] > normal_us);
}

const char *why_unconfirmed(const why_trip_t *trip) {
    static const char *const words[2][2] = {{"P and autopilot off", "P"},
                                            {"autopilot off", "P together with autopilot off"}};
    return words[trip->parked][trip->disengaged];
}

uint16_t why_missing(const why_t *why) {
    return why->missing;
}

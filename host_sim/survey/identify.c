#include "survey/identify.h"

#include <string.h>

#include "common/message_facts.h"
#include "text/units.h"

enum { MEDIAN = 500, CYCLE_LOWEST_PCT = 60, CYCLE_HIGHEST_PCT = 160, PERCENT = 100 };
enum { FIRST_BYTE = 0, REPEATS_PER_STEP = 2 };

static bool has_cycle(const traffic_id_t *entry, uint32_t message) {
    const uint64_t cycle_us = (uint64_t)agv_message_cycle_ms(message) * US_PER_MS;
    const uint64_t median_us = gaps_quantile_us(&entry->gaps, MEDIAN);
    return (median_us * PERCENT >= cycle_us * CYCLE_LOWEST_PCT) &&
           (median_us * PERCENT <= cycle_us * CYCLE_HIGHEST_PCT);
}

/** Whether the byte at which a message has its alive counter counts. */
static bool has_counter(const traffic_id_t *entry, uint32_t message) {
    if (message_counter_at(message) == MESSAGE_NO_COUNTER) {
        return true;
    }
    const counter_use_t *use = &entry->candidates[(message_counter_at(message) == (uint8_t)FIRST_BYTE) ? 0 : 1];
    return (use->steps + use->other_steps) * REPEATS_PER_STEP >= use->frames;
}

/** Whether a bit beside the alive counter was ever set: a payload of zeros says nothing. */
static bool has_content(const traffic_id_t *entry, uint32_t message) {
    uint32_t bits = 0u;
    for (uint32_t i = 0u; i < AGV_DLC; i++) {
        bits |= (i == message_counter_at(message)) ? 0u : entry->bits_ever[i];
    }
    return bits != 0u;
}

static bool fits(const traffic_id_t *entry, uint32_t message) {
    return !entry->is_extended && (entry->message == TRAFFIC_UNKNOWN) && (entry->count >= IDENTIFY_FRAMES_MIN) &&
           ((entry->fits >> message) & 1u) != 0u && has_cycle(entry, message) && has_counter(entry, message) &&
           has_content(entry, message);
}

static void collect(const traffic_t *traffic, identify_t *result, uint32_t message) {
    identify_message_t *found = &result->of[message];
    const traffic_id_t *heard = traffic_message(traffic, message);
    found->is_missing = (heard == NULL) || (heard->count == 0u);
    for (size_t i = 0u; found->is_missing && (traffic_at(traffic, i) != NULL); i++) {
        const traffic_id_t *entry = traffic_at(traffic, i);
        if (fits(entry, message) && (found->count < IDENTIFY_CANDIDATES_MAX)) {
            found->candidates[found->count] = entry->id;
            found->count++;
        }
    }
}

/** An identifier is taken: it is no candidate of other messages any more. */
static void strike(identify_t *result, uint32_t taken_by, uint32_t id) {
    for (uint32_t message = 0u; message < (uint32_t)AGV_MSG_COUNT; message++) {
        identify_message_t *found = &result->of[message];
        size_t kept = 0u;
        for (size_t i = 0u; i < found->count; i++) {
            if ((message == taken_by) || (found->candidates[i] != id)) {
                found->candidates[kept] = found->candidates[i];
                kept++;
            }
        }
        found->count = kept;
    }
}

/** Whether another message has this identifier for its only candidate. */
static bool is_contested(const identify_t *result, uint32_t message, uint32_t id) {
    for (uint32_t other = 0u; other < (uint32_t)AGV_MSG_COUNT; other++) {
        const identify_message_t *found = &result->of[other];
        if ((other != message) && !found->is_assigned && (found->count == 1u) && (found->candidates[0] == id)) {
            return true;
        }
    }
    return false;
}

/** Assign what has one candidate. @return whether something was assigned */
static bool assign_once(identify_t *result) {
    for (uint32_t message = 0u; message < (uint32_t)AGV_MSG_COUNT; message++) {
        identify_message_t *found = &result->of[message];
        if (!found->is_assigned && (found->count == 1u) && !is_contested(result, message, found->candidates[0])) {
            found->is_assigned = true;
            strike(result, message, found->candidates[0]);
            return true;
        }
    }
    return false;
}

void identify(const traffic_t *traffic, identify_t *result) {
    (void)memset(result, 0, sizeof *result);
    for (uint32_t message = 0u; message < (uint32_t)AGV_MSG_COUNT; message++) {
        collect(traffic, result, message);
    }
    while (assign_once(result)) {
        /* what it strikes may leave one candidate to another message */
    }
}

size_t identify_assigned(const identify_t *result) {
    size_t count = 0u;
    for (size_t i = 0u; i < (size_t)AGV_MSG_COUNT; i++) {
        count += result->of[i].is_assigned ? 1u : 0u;
    }
    return count;
}

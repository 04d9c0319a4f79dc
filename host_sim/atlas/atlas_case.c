#include "atlas/atlas_case.h"

#include <stddef.h>

const uint32_t ATLAS_DISTANCE_MS[ATLAS_DISTANCES] = {0, 1, 50, 500};

const char *atlas_state_name(atlas_state_t state) {
    static const char *const names[ATLAS_STATES] = {"INIT", "STANDBY", "ACTIVE", "TRIPPED", "SAFE"};
    return names[state];
}

uint32_t atlas_case_count(void) {
    return 2 * (uint32_t)ATLAS_STATES * (uint32_t)(CAMPAIGN_ROW_COUNT * CAMPAIGN_ROW_COUNT) * ATLAS_DISTANCES;
}

static bool has_topology(const campaign_row_t *row, bool gateway) {
    return (row->flags & (gateway ? CAMPAIGN_SHARED : CAMPAIGN_GATEWAY)) == 0;
}

static bool is_like(const campaign_row_t *row, uint32_t flags) {
    return (row->flags & flags) != 0;
}

/** Whether the fault can be caused in this state. */
static bool has_state(const campaign_row_t *row, atlas_state_t state) {
    if (is_like(row, CAMPAIGN_START)) {
        return state == ATLAS_INIT;
    }
    if (is_like(row, CAMPAIGN_MANUAL)) {
        return state == ATLAS_STANDBY;
    }
    return !is_like(row, CAMPAIGN_ENGAGED) || (state == ATLAS_ACTIVE);
}

/** The second one comes later, perhaps in another state; but nobody engages after the first one. */
static bool may_follow(const atlas_case_t *pair) {
    const bool from_start = is_like(pair->second, CAMPAIGN_START);
    if (from_start) {
        return is_like(pair->first, CAMPAIGN_START) && (pair->distance == 0);
    }
    return has_state(pair->second, pair->state);
}

bool atlas_case_get(uint32_t number, atlas_case_t *pair) {
    const uint32_t rows = (uint32_t)CAMPAIGN_ROW_COUNT;

    pair->distance = number % ATLAS_DISTANCES;
    number /= ATLAS_DISTANCES;
    pair->second = &CAMPAIGN_ROWS[number % rows];
    number /= rows;
    pair->first = &CAMPAIGN_ROWS[number % rows];
    number /= rows;
    pair->state = (atlas_state_t)(number % ATLAS_STATES);
    pair->gateway = (number / ATLAS_STATES) != 0;
    return (pair->first != pair->second) && has_topology(pair->first, pair->gateway) &&
           has_topology(pair->second, pair->gateway) && has_state(pair->first, pair->state) && may_follow(pair);
}

static bool silences(const campaign_row_t *row) {
    static const agv_fault_t faults[] = {AGV_FAULT_MEMORY_CORRUPTED, AGV_FAULT_SUPERVISOR_RESET,
                                         AGV_FAULT_STEP_OVERRUN,     AGV_FAULT_BUS_OFF,
                                         AGV_FAULT_TX_STALLED,       AGV_FAULT_STORE_INVALID};
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
        if (row->fault == faults[i]) {
            return true;
        }
    }
    return false;
}

bool atlas_case_is_silent_twice(const atlas_case_t *pair) {
    return silences(pair->first) && silences(pair->second);
}

atlas_case_t atlas_case_half(const atlas_case_t *pair, bool second) {
    atlas_case_t half = *pair;
    if (second) {
        half.first = NULL;
    } else {
        half.second = NULL;
    }
    return half;
}

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

static bool is_like(const campaign_row_t *row, uint32_t flags) {
    return (row->flags & flags) != 0;
}

enum {
    ALL = ATLAS_IN(ATLAS_STATES) - 1u,
    STANDBY_OR_ACTIVE = ATLAS_IN(ATLAS_STANDBY) | ATLAS_IN(ATLAS_ACTIVE),
    ACTIVE_OR_TRIPPED = ATLAS_IN(ATLAS_ACTIVE) | ATLAS_IN(ATLAS_TRIPPED)
};

/**
 * Faults that happen in more states, or in more topologies, than their rows say: a campaign needs a cause whose time of
 * reaction is known exactly. [0]: on the shared bus, [1]: on the gateway.
 */
static const struct {
    agv_fault_t fault;
    uint32_t states[2];
} WIDER[] = {
    {AGV_FAULT_TX_STALLED, {ALL, ALL}},         /* any frame of the supervisor may wait */
    {AGV_FAULT_AI_HEARTBEAT_LOST, {ALL, ALL}},  /* with ai_lost_in_manual: trip */
    {AGV_FAULT_AI_HEARTBEAT_STUCK, {ALL, ALL}}, /* the same */
    {AGV_FAULT_MODE_FLAPPING, {STANDBY_OR_ACTIVE, STANDBY_OR_ACTIVE}},
    {AGV_FAULT_MODE_NONE, {STANDBY_OR_ACTIVE, STANDBY_OR_ACTIVE}},
    /* on the gateway, 43Fh of the AI computer is not passed on in INIT, TRIPPED and SAFE */
    {AGV_FAULT_AUTOPILOT_OFF_IGNORED, {ALL, STANDBY_OR_ACTIVE}},
    {AGV_FAULT_SAFE_STATE_UNCONFIRMED,
     {ACTIVE_OR_TRIPPED | ATLAS_IN(ATLAS_SAFE), ACTIVE_OR_TRIPPED | ATLAS_IN(ATLAS_SAFE)}},
    {AGV_FAULT_VEHICLE_NOT_STOPPING, {ACTIVE_OR_TRIPPED, ACTIVE_OR_TRIPPED}},
    {AGV_FAULT_WRONG_ID_SET, {ALL, ALL}},
};

/** The states in which the fault can be caused, as bits. */
static uint32_t states_of(const campaign_row_t *row, bool gateway) {
    for (size_t i = 0; i < sizeof WIDER / sizeof WIDER[0]; i++) {
        if (WIDER[i].fault == row->fault) {
            return WIDER[i].states[gateway ? 1 : 0];
        }
    }
    if (is_like(row, gateway ? CAMPAIGN_SHARED : CAMPAIGN_GATEWAY)) {
        return 0;
    }
    if (is_like(row, CAMPAIGN_START)) {
        return ATLAS_IN(ATLAS_INIT);
    }
    if (is_like(row, CAMPAIGN_MANUAL)) {
        return ATLAS_IN(ATLAS_STANDBY);
    }
    return is_like(row, CAMPAIGN_ENGAGED) ? ATLAS_IN(ATLAS_ACTIVE) : (uint32_t)ALL;
}

/** Faults of the safe state: the trip that they need may be that of the first fault. */
static bool needs_a_trip(const campaign_row_t *row) {
    return (row->fault == AGV_FAULT_SAFE_STATE_UNCONFIRMED) || (row->fault == AGV_FAULT_VEHICLE_NOT_STOPPING);
}

/** Nobody engages after the first fault, and a fault that is there from the start on has no later time. */
static bool may_follow(const atlas_case_t *pair) {
    const bool in_state = (states_of(pair->second, pair->gateway) & ATLAS_IN(pair->state)) != 0;
    if (is_like(pair->second, CAMPAIGN_START)) {
        return in_state && is_like(pair->first, CAMPAIGN_START) && (pair->distance == 0);
    }
    return in_state || (needs_a_trip(pair->second) && (pair->state != ATLAS_SAFE));
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
    return (pair->first != pair->second) && ((states_of(pair->first, pair->gateway) & ATLAS_IN(pair->state)) != 0) &&
           may_follow(pair);
}

bool atlas_case_silences(const campaign_row_t *row) {
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
    return atlas_case_silences(pair->first) && atlas_case_silences(pair->second);
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

/**
 * @file atlas_case.h
 * The cases of the atlas: every ordered pair of faults, in every state in which both can be caused, in both topologies,
 * at four distances.
 */
#ifndef HOST_SIM_ATLAS_CASE_H
#define HOST_SIM_ATLAS_CASE_H

#include <stdbool.h>
#include <stdint.h>

#include "campaign/campaign_rows.h"

/** The state of the supervisor when the first fault comes. */
typedef enum { ATLAS_INIT, ATLAS_STANDBY, ATLAS_ACTIVE, ATLAS_TRIPPED, ATLAS_SAFE, ATLAS_STATES } atlas_state_t;

/** A state as a bit. */
#define ATLAS_IN(state) (1u << (state))

/** "ACTIVE" */
const char *atlas_state_name(atlas_state_t state);

#define ATLAS_DISTANCES 4u

/** From the first fault to the second, in ms: 0, 1, 50, 500. */
extern const uint32_t ATLAS_DISTANCE_MS[ATLAS_DISTANCES];

/** Two faults, or one of them alone: then the other is NULL. */
typedef struct {
    const campaign_row_t *first;
    const campaign_row_t *second;
    bool gateway;
    atlas_state_t state;
    uint32_t distance; /**< index in ATLAS_DISTANCE_MS */
} atlas_case_t;

/** Numbers of cases are below this. Many of them cannot happen. */
uint32_t atlas_case_count(void);

/**
 * The case of a number.
 * @return false: it cannot happen, for example a fault that counts while engaged only, in STANDBY
 */
bool atlas_case_get(uint32_t number, atlas_case_t *pair);

/** The fault takes the supervisor from the bus for a while: it hangs, restarts, or its controller is off. */
bool atlas_case_silences(const campaign_row_t *row);

/** Both faults take the supervisor from the bus for a while. */
bool atlas_case_is_silent_twice(const atlas_case_t *pair);

/** One fault of a pair alone, at the same time. */
atlas_case_t atlas_case_half(const atlas_case_t *pair, bool second);

#endif

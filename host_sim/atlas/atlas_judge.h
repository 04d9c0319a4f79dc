/**
 * @file atlas_judge.h
 * Compares a pair of faults with each of the two alone. A pair must not be weaker than its worse baseline.
 */
#ifndef HOST_SIM_ATLAS_JUDGE_H
#define HOST_SIM_ATLAS_JUDGE_H

#include "atlas/atlas_play.h"

/** How a pair is weaker than its worse baseline: the first of these that applies. */
typedef enum {
    ATLAS_SOUND,
    ATLAS_NOT_READY,   /**< the supervisor was not in the state of the case when the first fault came */
    ATLAS_HAZARD,      /**< the hunt's judge found a hazard that neither baseline has */
    ATLAS_NOT_LATCHED, /**< a baseline ends in TRIPPED, SAFE or INIT, the pair does not */
    ATLAS_LATE_FRAME,  /**< the first safe command comes later than in both baselines, or never */
    ATLAS_LATE_OUTPUT, /**< the output opens later than in both baselines, or never */
    ATLAS_LATE_STOP,   /**< the vehicle stops later than in both baselines, or never */
    ATLAS_WEAKNESSES
} atlas_weakness_t;

/** "LATE_FRAME"; "" for ATLAS_SOUND. */
const char *atlas_weakness_name(atlas_weakness_t weakness);

/**
 * Judge a pair by its baselines. Two exceptions: where both faults take the supervisor from the bus, the first safe command
 * may come 400 ms later, and 1600 ms later if the second one is TX_STALLED; and where the first one comes in INIT, the
 * second one may be over before INIT has ended.
 */
atlas_weakness_t atlas_judge(const atlas_case_t *of, const atlas_outcome_t *pair, const atlas_outcome_t *first,
                             const atlas_outcome_t *second);

/** Why a pair is weaker than its worse baseline, where that is known and cannot be otherwise; NULL: it is a finding. */
const char *atlas_known_reason(const atlas_case_t *of, atlas_weakness_t weakness);

#endif

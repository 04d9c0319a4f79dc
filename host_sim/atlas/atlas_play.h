/**
 * @file atlas_play.h
 * Plays a case of the atlas, and notes what came of it.
 */
#ifndef HOST_SIM_ATLAS_PLAY_H
#define HOST_SIM_ATLAS_PLAY_H

#include <stdbool.h>
#include <stdint.h>

#include "atlas/atlas_case.h"
#include "scenario/hazard/hazard.h"
#include "scenario/scenario_play.h"
#include "text/text.h"

/** It did not happen. */
#define ATLAS_NEVER INT32_MAX

/** What came of a case. Times are in us after the first fault, or where it would have been. */
typedef struct {
    bool ready; /**< the supervisor was in the state of the case, and in TRIPPED and SAFE for the reason of the case */
    int reason; /**< agv_fault_t of the trip; -1: none */
    int state;  /**< agv_state_t at the end */
    int32_t safe_us; /**< the first safe command after the fault, in INIT or since a trip */
    int32_t open_us; /**< the output is open from then on */
    int32_t stop_us; /**< the vehicle stands from then on */
    hazard_kind_t hazard;
} atlas_outcome_t;

/** What it takes to play; large: on the heap. All zero at the start. */
typedef struct {
    atlas_outcome_t outcome;
    const atlas_case_t *pair;
    uint64_t first_us;
    bool tripped;
    bool was_open;
    bool was_moving;
    scenario_t scenario;
    scenario_testbed_t testbed;
    hazard_t hazard;
    text_t text;
} atlas_play_t;

/** Play a case. @return false: it is no scenario; was reported */
bool atlas_play(atlas_play_t *play, const atlas_case_t *pair);

#endif

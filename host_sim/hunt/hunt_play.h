/**
 * @file hunt_play.h
 * Plays a program of a hunt on the simulated bus, has it evaluated, and notes what was seen.
 */
#ifndef HOST_SIM_HUNT_PLAY_H
#define HOST_SIM_HUNT_PLAY_H

#include "hunt/hunt_program.h"
#include "scenario/hazard/hazard.h"

enum { HUNT_FEATURES = 16384, HUNT_FEATURE_BYTES = HUNT_FEATURES / 8 };

/** All that one run needs; some 500 KiB: allocate it, all zero. */
typedef struct {
    text_t text; /**< the scenario as it was played */
    scenario_t scenario;
    scenario_testbed_t testbed;
    hazard_t hazard;
    uint8_t features[HUNT_FEATURE_BYTES]; /**< one bit for each thing that was seen */
    uint32_t played_ms;
    uint32_t last_step_ms; /**< the last step, repeated ones not counted */
    uint32_t quiet_ms;     /**< until then a hazard was possible */
} hunt_play_t;

/** Play it to its end or to the first hazard. @return false: not a valid scenario; reported */
bool hunt_play(hunt_play_t *play, const hunt_program_t *program);

#endif

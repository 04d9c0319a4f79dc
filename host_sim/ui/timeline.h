/**
 * @file timeline.h
 * A run of a scenario as text: a line for each action and event, with the state of the vehicle.
 */
#ifndef HOST_SIM_TIMELINE_H
#define HOST_SIM_TIMELINE_H

#include <stdbool.h>
#include <stdint.h>

#include "scenario/scenario.h"
#include "scenario/scenario_testbed.h"

/** A timeline. Members are for the functions. */
typedef struct {
    const scenario_testbed_t *testbed;
    uint64_t trip_us; /* time of the last trip */
    uint64_t step_us; /* time of the last step */
    const char *step_actor;
    const char *step_word;
    uint32_t shown; /* bit m: a frame of message m was shown since the last change of state */
    bool wants_reaction;
    bool header_done;
    uint8_t gear; /* as last reported on the bus; 0 = not yet */
    int mode;     /* bits 7 and 8 of 363h byte 7; -1 = not yet */
    int32_t speed_mm_s;
} timeline_t;

/** Begin. @param testbed that the scenario is played in */
void timeline_init(timeline_t *timeline, const scenario_testbed_t *testbed);

/** The watch to hand to scenario_run(). */
scenario_watch_t timeline_watch(timeline_t *timeline);

/** A step is about to be done; a scenario_step_fn with the timeline as context. */
void timeline_step(void *ctx, const scenario_step_t *step);

#endif

/**
 * @file timeline.h
 * A run as text: a line for each action and event, with the state of the vehicle.
 */
#ifndef HOST_SIM_TIMELINE_H
#define HOST_SIM_TIMELINE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "hal/can.h"
#include "scenario/scenario.h"
#include "scenario/scenario_testbed.h"
#include "session/session.h"

/** A timeline. Members are for the functions. */
typedef struct {
    agv_ids_t ids;
    const scenario_testbed_t *testbed; /* NULL: not that of a scenario */
    uint64_t now_us;                   /* of the last frame; without a testbed */
    uint64_t trip_us;                  /* time of the last trip */
    uint64_t step_us;                  /* time of the last step */
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

/** Begin the timeline of a run that is no scenario. */
void timeline_init_run(timeline_t *timeline, const agv_config_t *config);

/** An event of the supervisor: a session_observer_fn with the timeline as context. */
void timeline_event(void *ctx, const session_event_t *event);

/** What the vehicle reported last, from an event of a flight recorder; prints nothing. */
void timeline_snapshot(timeline_t *timeline, const agv_event_t *event);

/** A frame was received. */
void timeline_received(timeline_t *timeline, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us);

/** A frame of the supervisor was sent. */
void timeline_sent(timeline_t *timeline, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us);

/** The watch to hand to scenario_run(). */
scenario_watch_t timeline_watch(timeline_t *timeline);

/** A step is about to be done; a scenario_step_fn with the timeline as context. */
void timeline_step(void *ctx, uint64_t t_ms, const scenario_step_t *step);

#endif

/**
 * @file scenario_check.h
 * Checks a run against the expectations of a scenario. The caller passes events, frames and states as they happen; at
 * the end the failed expectations are listed. It knows no bus and no supervisor.
 */
#ifndef HOST_SIM_SCENARIO_CHECK_H
#define HOST_SIM_SCENARIO_CHECK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "agv/counters.h"
#include "scenario/scenario.h"
#include "session/session.h"
#include "vehicle/vehicle.h"

#define SCENARIO_FAILURES_MAX 40u
#define SCENARIO_FAILURE_SIZE 320u
#define SCENARIO_WINDOW_TEXT_SIZE 48u

/** What was seen of one expected frame so far. */
typedef struct {
    uint32_t count;
    uint32_t last_ms;
    size_t again;
    uint32_t nearest_ms; /* of a match outside its time */
    bool near;
    bool first_done;
    bool broken; /* reported already */
} scenario_frame_seen_t;

/** What was seen of one expected fault so far. */
typedef struct {
    bool raised;
    bool ended;
    bool early_or_late;
    uint32_t seen_ms;
    uint16_t parts; /**< at that time */
} scenario_fault_seen_t;

/** An evaluation. Read `failures`; all else is for the functions. */
typedef struct {
    char failures[SCENARIO_FAILURES_MAX][SCENARIO_FAILURE_SIZE]; /**< "LINE: what was expected, what was seen" */
    size_t failure_count;                                        /**< may be larger than SCENARIO_FAILURES_MAX */
    size_t expectation_count; /**< how many there are; one more for each failure without a line */
    const scenario_t *scenario;
    scenario_expect_t expect; /* that of the scenario; times that count from an event are replaced when it comes */
    scenario_events_t events;
    uint32_t ids[SCENARIO_EXPECT_MAX];
    uint32_t never_ids[SCENARIO_EXPECT_MAX];
    scenario_frame_seen_t frames[SCENARIO_EXPECT_MAX];
    scenario_fault_seen_t faults[SCENARIO_EXPECT_MAX];
    uint32_t never_count[SCENARIO_EXPECT_MAX];
    bool led_broken[SCENARIO_EXPECT_MAX];
    bool led_seen[SCENARIO_EXPECT_MAX];     /* of those at some time */
    bool vehicle_seen[SCENARIO_EXPECT_MAX]; /* or reported */
    size_t next_state;
    size_t next_output;
    size_t next_reset;
    size_t next_startup;
    uint32_t led_since_ms;
    int8_t led_code;
    bool closed;
    bool only_supervisor; /* no expectation is about frames of other nodes */
} scenario_check_t;

/** Begin. @param scenario must outlive the check */
void scenario_check_init(scenario_check_t *check, const scenario_t *scenario);

/** The supervisor reported an event. */
void scenario_check_event(scenario_check_t *check, const session_event_t *event);

/** A frame was on a bus, complete at @p t_us. @param from SCENARIO_FROM_SUPERVISOR or a vehicle_node_t */
void scenario_check_frame(scenario_check_t *check, uint64_t t_us, hal_can_side_t side, int from,
                          const hal_can_frame_t *frame);

/** The safety output is closed or open; at every millisecond. */
void scenario_check_output(scenario_check_t *check, uint32_t t_ms, bool closed);

/** The state of the vehicle; at least for every millisecond for which scenario_check_wants_vehicle() returns true. */
void scenario_check_vehicle(scenario_check_t *check, uint32_t t_ms, const vehicle_view_t *view);
bool scenario_check_wants_vehicle(const scenario_check_t *check, uint32_t t_ms);

/** The run is over. @param counters of the supervisor; NULL: it has none */
void scenario_check_finish(scenario_check_t *check, const agv_counters_t *counters);

/** Note a failure of the expectation on a line of the file (0: of the file as a whole). */
void scenario_check_fail(scenario_check_t *check, size_t line, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/** @name Private: the parts. @{ */
void scenario_check_frames_init(scenario_check_t *check);
void scenario_check_frames_finish(scenario_check_t *check);
void scenario_check_window_text(scenario_window_t window, char text[SCENARIO_WINDOW_TEXT_SIZE]);
bool scenario_check_is_in(uint32_t t_ms, scenario_window_t window);
bool scenario_check_waits(scenario_window_t window);  /* for an event that has not come */
void scenario_check_resolve(scenario_check_t *check); /* an event has come that times may count from */
void scenario_check_vehicle_finish(scenario_check_t *check);
/** @} */

#endif

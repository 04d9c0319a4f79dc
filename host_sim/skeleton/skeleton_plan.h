/**
 * @file skeleton_plan.h
 * A skeleton as it is put together: when its steps come, what the run of it showed, and its text.
 */
#ifndef HOST_SIM_SKELETON_PLAN_H
#define HOST_SIM_SKELETON_PLAN_H

#include "scenario/run/scenario_run.h"
#include "skeleton/skeleton_facts.h"

#define SKELETON_CHANGES_MAX 24u

/** A change of state or of the safety output that was seen. */
typedef struct {
    bool is_output;
    uint8_t to; /**< agv_state_t; 1: closed */
    uint8_t reason;
    uint32_t t_ms;
} skeleton_change_t;

/** The plan of a scenario. */
typedef struct {
    const skeleton_facts_t *facts;
    uint32_t engage_ms; /**< 0: not engaged */
    uint32_t cause_ms;
    uint32_t duration_ms;
    bool is_shorter; /**< less time passes before the cause than in the log */
    text_t steps;    /**< that bring the cause about; the first one has the name `fault` */
} skeleton_plan_t;

/** What a run showed. */
typedef struct {
    skeleton_change_t changes[SKELETON_CHANGES_MAX];
    size_t count;
    bool has_tripped;
    uint8_t reason; /**< of the first trip */
    uint32_t trip_ms;
    bool gear_p_came; /**< within some ms after the trip */
    vehicle_view_t end;
} skeleton_seen_t;

/** Choose the times. */
void skeleton_plan_times(skeleton_plan_t *plan);

/** Write the steps of the cause by what the log shows. @return false: there is no such way */
bool skeleton_cause_by_evidence(skeleton_plan_t *plan);

/** Write the steps by which a campaign causes this fault. @return false: it cannot */
bool skeleton_cause_by_campaign(skeleton_plan_t *plan);

/** The text of the file. @param seen NULL: nothing is expected yet */
void skeleton_text(text_t *text, const skeleton_plan_t *plan, const skeleton_seen_t *seen);

/** Its expectations. */
void skeleton_expect(text_t *text, const skeleton_plan_t *plan, const skeleton_seen_t *seen);

/** Play a text, and look. @return false: it is no scenario, which was reported */
bool skeleton_play(scenario_run_t *run, const text_t *text, const agv_config_t *config, skeleton_seen_t *seen);

#endif

/**
 * @file scenario_parse_step_keys.h
 * The keys of a step, sorted; for scenario_parse_steps.c only.
 */
#ifndef HOST_SIM_SCENARIO_PARSE_STEP_KEYS_H
#define HOST_SIM_SCENARIO_PARSE_STEP_KEYS_H

#include "scenario/scenario_actions.h"

#define SCENARIO_NO_TIME UINT32_MAX /**< not given */

/** A step that is being read. */
typedef struct {
    const yaml_node_t *node;
    uint32_t at_ms; /**< with `after`: how long after it */
    uint32_t wait_ms;
    uint32_t again_every_ms; /**< 0: once */
    uint32_t again_until_ms;
    bool has_after;
    scenario_actor_t actor;
    const yaml_node_t *word; /**< what the actor does */
    const yaml_node_t *value_of[SCENARIO_PARAMETERS];
} scenario_reading_t;

/** Sort the keys of a step. @return false: reported */
bool scenario_read_step_keys(const yaml_reader_t *reader, const yaml_node_t *node, scenario_reading_t *reading);

/** What the action needs is there, and nothing else. @return false: reported */
bool scenario_has_what_it_needs(const yaml_reader_t *reader, const scenario_reading_t *reading,
                                const scenario_action_row_t *row);

#endif

/**
 * @file scenario_parse.h
 * Shared by the parts of the scenario reader; also for reading single steps.
 */
#ifndef HOST_SIM_SCENARIO_PARSE_H
#define HOST_SIM_SCENARIO_PARSE_H

#include "io/yaml_reader.h"
#include "io/yaml_shape.h"
#include "scenario/scenario.h"
#include "text/suggest.h"

extern const yaml_word_t SCENARIO_GEARS[];
extern const yaml_word_t SCENARIO_SIDES[];
extern const yaml_word_t SCENARIO_CAUSES[];
extern const yaml_word_t SCENARIO_ID_SETS[];

/** @name What may stand in a file @{ */
extern const yaml_shape_t SCENARIO_SHAPE; /**< all of it, but for `config` and each of `steps` */
extern const yaml_shape_t SCENARIO_VEHICLE_SHAPE;
extern const yaml_shape_t SCENARIO_EXPECT_SHAPE;
extern const yaml_shape_t SCENARIO_FRAME_SHAPE;
extern const yaml_shape_t SCENARIO_NEVER_SHAPE;
extern const yaml_shape_t SCENARIO_SEEN_SHAPE;
extern const yaml_shape_t SCENARIO_COUNTERS_SHAPE;
extern const yaml_shape_t SCENARIO_BOARD_SHAPE;
extern const yaml_shape_t SCENARIO_SELF_TEST_SHAPE;
extern const yaml_shape_t SCENARIO_TESTED_PART_SHAPE;
extern const yaml_shape_t SCENARIO_BOUNCE_SHAPE;
extern const yaml_shape_t SCENARIO_MESSAGE_SHAPE;
extern const yaml_shape_t SCENARIO_FAULT_SHAPE;
extern const yaml_shape_t SCENARIO_TEXT_SHAPE;
/** @} */

/** The end of a message about an unknown word: what was meant, or the page that lists them all. @return text */
const char *scenario_parse_meant(const suggestion_t *suggestion, char text[SUGGEST_SIZE]);

/** The next free place of a list; NULL when it is full, which was reported. */
#define SCENARIO_NEXT(reader, node, list)                                                                              \
    (((list).count < SCENARIO_EXPECT_MAX)                                                                              \
         ? &(list).items[(list).count++]                                                                               \
         : (yaml_reader_fail((reader), (node), "more than %u of them", SCENARIO_EXPECT_MAX), NULL))

/** When something is expected. */
typedef struct {
    const scenario_t *scenario;
    const char *what; /**< names the expectation in messages */
    const char *key;  /**< of the time since the start: "at_ms" */
    bool is_optional;
} scenario_when_t;

/** The rows of a table for the time of an expectation: since the start, or `after` and `within`. */
#define SCENARIO_WHEN(type, key, member)                                                                               \
    YAML_OPTIONAL(YAML_TIME_RANGE(key, type, member, 0, SCENARIO_DURATION_MAX_MS)), SCENARIO_AFTER(type, member)
#define SCENARIO_AFTER(type, member)                                                                                   \
    YAML_OPTIONAL(YAML_CALL("after", scenario_parse_any_text, &SCENARIO_TEXT_SHAPE)),                                  \
        YAML_OPTIONAL(YAML_TIME_RANGE("within", type, member, 0, SCENARIO_DURATION_MAX_MS))
yaml_read_fn scenario_parse_any_text;

/** How these rows go together. */
#define SCENARIO_WHEN_RULES(key)                                                                                       \
    {YAML_RULE_ONE_OF, (key), "after"}, {YAML_RULE_NEEDS, "after", "within"}, {YAML_RULE_NEEDS, "within", "after"}

/** What these rows have read, taken together: an anchor that is a step is counted in. */
bool scenario_parse_when(const yaml_reader_t *reader, const yaml_node_t *node, const scenario_when_t *when,
                         scenario_window_t *window);

/** `after`: an event, or a step by its name, which is as much as its own anchor and a time. */
bool scenario_parse_after(const yaml_reader_t *reader, const yaml_node_t *node, const scenario_t *scenario,
                          scenario_anchor_t *anchor, uint32_t *offset_ms);

/** @name Single expectations @{ */
yaml_read_fn scenario_parse_frame;
yaml_read_fn scenario_parse_never;
yaml_read_fn scenario_parse_vehicle;
yaml_read_fn scenario_parse_counters;
/** @} */

/** How the vehicle is built; the target is a vehicle_config_t. */
yaml_read_fn scenario_parse_vehicle_config;

/** The steps and the expectations; their target is the scenario_t. */
yaml_read_fn scenario_parse_steps;
yaml_read_fn scenario_parse_expect;

/** @name The hard-wired parts; their target is the scenario_t @{ */
yaml_read_fn scenario_parse_board;
yaml_read_fn scenario_parse_self_test;
/** @} */

/** @name Parameters of the board's actions @{ */
yaml_read_fn scenario_parse_tested_part; /**< the target: a uint32_t of HAL_SELF_TEST_* */
bool scenario_parse_bounce(const yaml_reader_t *reader, const yaml_node_t *node, scenario_action_t *action);
/** @} */

/** Whether the board has what a step needs. */
bool scenario_parse_board_fits(const yaml_reader_t *reader, const yaml_node_t *node, scenario_t *scenario,
                               const scenario_step_t *step);

/**
 * One step.
 * @param config of its supervisor: the ID set and the topology decide what a step may name
 */
bool scenario_parse_step(const yaml_reader_t *reader, const yaml_node_t *node, const agv_config_t *config,
                         scenario_step_t *step);

/** A time in milliseconds. */
bool scenario_parse_ms(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, uint32_t lowest,
                       uint32_t highest, uint32_t *ms);

/** A time: 0 .. SCENARIO_DURATION_MAX_MS. */
bool scenario_parse_time(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, uint32_t *ms);

/** A message by its name. */
bool scenario_parse_message(const yaml_reader_t *reader, const yaml_node_t *node, agv_message_t *message);

/** A fault by its name. */
bool scenario_parse_fault(const yaml_reader_t *reader, const yaml_node_t *node, agv_fault_t *fault);

#endif

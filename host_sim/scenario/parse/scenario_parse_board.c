/* Scenario files: the hard-wired parts of the supervisor's board. */
#include "hal/self_test.h"
#include "scenario/parse/scenario_parse.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

enum { NO_PART = -1, BOUNCE_LONGEST_MS = 10000 };

/** The optional parts, in the order of their words. */
enum { OUTPUT_FEEDBACK, EMERGENCY_STOP, RESET_BUTTON, SECOND_CLOCK };
static const yaml_word_t PARTS[] = {{"output_feedback", OUTPUT_FEEDBACK},
                                    {"emergency_stop", EMERGENCY_STOP},
                                    {"reset_button", RESET_BUTTON},
                                    {"second_clock", SECOND_CLOCK},
                                    {NULL, 0}};

/** Parts of the self-test that a port tests; the supervisor tests "core" itself. */
static const yaml_word_t TESTS[] = {{"flash", HAL_SELF_TEST_FLASH},
                                    {"ram", HAL_SELF_TEST_RAM},
                                    {"processor", HAL_SELF_TEST_PROCESSOR},
                                    {"watchdog", HAL_SELF_TEST_WATCHDOG},
                                    {"devices", HAL_SELF_TEST_DEVICES},
                                    {"supply", HAL_SELF_TEST_SUPPLY},
                                    {NULL, 0}};
static const yaml_word_t RESULTS[] = {{"passed", 0}, {"failed", HAL_SELF_TEST_PROCESSOR}, {NULL, 0}};

static const yaml_shape_t PART = {.kind = YAML_KIND_WORD, .words = PARTS};
const yaml_shape_t SCENARIO_BOARD_SHAPE = {.kind = YAML_KIND_LIST, .items = &PART, .is_unique = true};
const yaml_shape_t SCENARIO_TESTED_PART_SHAPE = {.kind = YAML_KIND_WORD, .words = TESTS};
static const yaml_shape_t FAILED_PARTS = {.kind = YAML_KIND_LIST, .items = &SCENARIO_TESTED_PART_SHAPE};
const yaml_shape_t SCENARIO_SELF_TEST_SHAPE = {.kind = YAML_KIND_WORD, .words = RESULTS, .other = &FAILED_PARTS};

static const yaml_shape_t BOUNCE_TIME = {
    .kind = YAML_KIND_TIME, .unit = DURATION_MS, .lowest = 1, .highest = BOUNCE_LONGEST_MS};
const yaml_shape_t SCENARIO_BOUNCE_SHAPE = {
    .kind = YAML_KIND_LIST, .items = &BOUNCE_TIME, .lowest = 1, .highest = SCENARIO_BOUNCE_MAX};

static bool *part_of(sim_board_t *board, int part) {
    bool *const parts[] = {&board->has_feedback, &board->has_emergency_stop, &board->has_reset_button,
                           &board->has_second_clock};
    return parts[part];
}

static bool read_part(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    sim_board_t *board = target;
    int part = 0;

    if (!yaml_reader_word(reader, node, "board", PARTS, &part)) {
        return false;
    }
    if (*part_of(board, part)) {
        return yaml_reader_fail(reader, node, "board: '%s' is given twice", PARTS[part].word);
    }
    *part_of(board, part) = true;
    return true;
}

bool scenario_parse_board(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return yaml_reader_list(reader, node, "board", read_part, &((scenario_t *)target)->board);
}

bool scenario_parse_tested_part(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    int part = 0;

    if (!yaml_reader_word(reader, node, "a part of the self-test", TESTS, &part)) {
        return false;
    }
    *(uint32_t *)target |= (uint32_t)part;
    return true;
}

bool scenario_parse_self_test(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    uint32_t *failed = &((scenario_t *)target)->board.failed;
    int result = 0;

    if (node->type == YAML_SEQUENCE_NODE) {
        return yaml_reader_list(reader, node, "self_test", scenario_parse_tested_part, failed);
    }
    if (!yaml_reader_word(reader, node, "self_test (or a list of parts)", RESULTS, &result)) {
        return false;
    }
    *failed = (uint32_t)result;
    return true;
}

static bool read_bounce_time(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_action_t *action = target;
    uint32_t ms = 0;

    if (action->bounce_count == SCENARIO_BOUNCE_MAX) {
        return yaml_reader_fail(reader, node, "pattern_ms: more than %u durations", SCENARIO_BOUNCE_MAX);
    }
    if (!scenario_parse_ms(reader, node, "pattern_ms", 1, BOUNCE_LONGEST_MS, &ms)) {
        return false;
    }
    action->bounce_ms[action->bounce_count] = (uint16_t)ms;
    action->bounce_count++;
    return true;
}

bool scenario_parse_bounce(const yaml_reader_t *reader, const yaml_node_t *node, scenario_action_t *action) {
    return yaml_reader_list(reader, node, "pattern_ms", read_bounce_time, action) &&
           ((action->bounce_count > 0) || yaml_reader_fail(reader, node, "pattern_ms: is empty"));
}

/** The part of the board that an action needs. */
static int part_needed(scenario_do_t what) {
    switch (what) {
    case SCENARIO_FEEDBACK_INVERTED:
        return OUTPUT_FEEDBACK;
    case SCENARIO_STOP_OPEN:
        return EMERGENCY_STOP;
    case SCENARIO_BUTTON:
    case SCENARIO_BUTTON_BOUNCES:
        return RESET_BUTTON;
    case SCENARIO_CLOCK:
        return SECOND_CLOCK;
    default:
        return NO_PART;
    }
}

bool scenario_parse_board_fits(const yaml_reader_t *reader, const yaml_node_t *node, scenario_t *scenario,
                               const scenario_step_t *step) {
    const int part = step->of_vehicle ? (int)NO_PART : part_needed(step->supervisor.what);

    return (part == NO_PART) || *part_of(&scenario->board, part) ||
           yaml_reader_fail(reader, node, "'%s' needs a board with '%s'; list it under 'board'", step->word,
                            PARTS[part].word);
}

/* Scenario files: frames that are expected, and frames that must not be. */
#include "io/yaml_file.h"
#include "scenario/parse/scenario_parse.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define ENDLESS UINT32_MAX
#define JITTER_PRESET_MS 2u

static const yaml_word_t SENDERS[] = {{"supervisor", SCENARIO_FROM_SUPERVISOR},
                                      {"vcu", VEHICLE_VCU},
                                      {"eps", VEHICLE_EPS},
                                      {"ai", VEHICLE_AI},
                                      {"stranger", VEHICLE_ROGUE},
                                      {"anybody", SCENARIO_FROM_ANY},
                                      {NULL, 0}};

static const yaml_shape_t SIDE = {.kind = YAML_KIND_WORD, .words = SCENARIO_SIDES};
static const yaml_shape_t PAYLOAD = {.kind = YAML_KIND_BYTES, .highest = AGV_DLC, .may_be_open = true};

static bool read_frame_side(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_frame_t *frame = target;
    int value = 0;

    if (!yaml_reader_word(reader, node, "side", SCENARIO_SIDES, &value)) {
        return false;
    }
    frame->side = (hal_can_side_t)value;
    frame->any_side = false;
    return true;
}

static bool read_frame_message(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_message(reader, node, &((scenario_frame_t *)target)->message);
}

static bool read_frame_bytes(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_frame_t *frame = target;
    frame->exact_length = true;
    return yaml_reader_bytes(reader, node, "bytes", frame->value, frame->mask, &frame->length);
}

#define FRAME_MEMBER(kind, key, ...) YAML_##kind(key, scenario_frame_t, __VA_ARGS__)
/* What expected and forbidden frames have in common. */
#define WHICH_FRAME(id_max)                                                                                            \
    YAML_OPTIONAL(FRAME_MEMBER(WORD, "from", from, SENDERS)),                                                          \
        YAML_OPTIONAL(YAML_CALL("side", read_frame_side, &SIDE)), YAML_OPTIONAL(FRAME_MEMBER(ID, "id", id, id_max)),   \
        YAML_OPTIONAL(YAML_CALL("message", read_frame_message, &SCENARIO_MESSAGE_SHAPE)),                              \
        YAML_OPTIONAL(YAML_CALL("bytes", read_frame_bytes, &PAYLOAD))

static void preset_frame(scenario_frame_t *frame, const yaml_node_t *node) {
    frame->line = yaml_node_line(node);
    frame->from = SCENARIO_FROM_SUPERVISOR;
    frame->any_side = true;
    frame->id = SCENARIO_NO_ID;
    frame->message = AGV_MSG_NONE;
    frame->at_ms = (scenario_window_t){.from = 0, .to = ENDLESS};
    frame->count = (scenario_window_t){.from = 1, .to = ENDLESS};
    frame->jitter_ms = JITTER_PRESET_MS;
}

static bool names_one_id(const yaml_reader_t *reader, const yaml_node_t *node, const scenario_frame_t *frame) {
    return (frame->id == SCENARIO_NO_ID) || (frame->message == AGV_MSG_NONE) ||
           yaml_reader_fail(reader, node, "either 'id' or 'message', not both");
}

static const yaml_key_t FRAME[] = {
    WHICH_FRAME(AGV_ID_MAX), /* the messages have 11 bits */
    SCENARIO_WHEN(scenario_frame_t, "at_ms", at_ms),
    YAML_OPTIONAL(FRAME_MEMBER(TIME, "first_since_ms", first_since_ms, 0, SCENARIO_DURATION_MAX_MS),
                  YAML_GIVEN(scenario_frame_t, is_first)),
    YAML_OPTIONAL(FRAME_MEMBER(RANGE, "count", count, 0, SCENARIO_DURATION_MAX_MS)),
    YAML_OPTIONAL(FRAME_MEMBER(TIME, "every_ms", every_ms, 1, 60000)),
    YAML_OPTIONAL(FRAME_MEMBER(TIME, "jitter_ms", jitter_ms, 0, 60000)),
};
const yaml_shape_t SCENARIO_FRAME_SHAPE = {
    YAML_MAP_SHAPE(FRAME), .rules = {SCENARIO_WHEN_RULES("at_ms"), {YAML_RULE_ONE_OF, "id", "message"}}};

bool scenario_parse_frame(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    const scenario_when_t when = {.scenario = target, .what = "an expected frame", .key = "at_ms"};
    scenario_frame_t *frame = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.frames);

    if (frame == NULL) {
        return false;
    }
    preset_frame(frame, node);
    if (!yaml_reader_map(reader, node, when.what, FRAME, COUNT(FRAME), frame) || !names_one_id(reader, node, frame) ||
        !scenario_parse_when(reader, node, &when, &frame->at_ms)) {
        return false;
    }
    if (frame->is_first && (frame->at_ms.after.kind == SCENARIO_FROM_START) &&
        (frame->first_since_ms > frame->at_ms.from)) {
        return yaml_reader_fail(reader, node, "first_since_ms is after at_ms");
    }
    return ((frame->id != SCENARIO_NO_ID) || (frame->message != AGV_MSG_NONE)) ||
           yaml_reader_fail(reader, node, "an expected frame: 'id' or 'message' is missing");
}

/* An extended frame must not be, either: a gateway may not pass it. */
static const yaml_key_t NEVER_KEYS[] = {WHICH_FRAME(0x1FFFFFFF), SCENARIO_WHEN(scenario_frame_t, "at_ms", at_ms)};
const yaml_shape_t SCENARIO_NEVER_SHAPE = {YAML_MAP_SHAPE(NEVER_KEYS),
                                           .rules = {{YAML_RULE_NOT_BOTH, "at_ms", "after"},
                                                     {YAML_RULE_NEEDS, "after", "within"},
                                                     {YAML_RULE_NEEDS, "within", "after"},
                                                     {YAML_RULE_NOT_BOTH, "id", "message"}}};

bool scenario_parse_never(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    const scenario_when_t when = {.scenario = target, .what = "a forbidden frame", .key = "at_ms", .is_optional = true};
    scenario_frame_t *frame = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.never);

    if (frame == NULL) {
        return false;
    }
    preset_frame(frame, node);
    return yaml_reader_map(reader, node, when.what, NEVER_KEYS, COUNT(NEVER_KEYS), frame) &&
           names_one_id(reader, node, frame) && scenario_parse_when(reader, node, &when, &frame->at_ms);
}

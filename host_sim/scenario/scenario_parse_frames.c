/* Scenario files: frames that are expected, and frames that must not be. */
#include "io/yaml_file.h"
#include "scenario/scenario_parse.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define ENDLESS UINT32_MAX
#define JITTER_PRESET_MS 2u

static bool read_frame_from(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_word_t words[] = {{"supervisor", SCENARIO_FROM_SUPERVISOR},
                                        {"vcu", VEHICLE_VCU},
                                        {"eps", VEHICLE_EPS},
                                        {"ai", VEHICLE_AI},
                                        {"stranger", VEHICLE_STRANGER},
                                        {"anybody", SCENARIO_FROM_ANY},
                                        {NULL, 0}};
    return yaml_reader_word(reader, node, "from", words, &((scenario_frame_t *)target)->from);
}

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

static bool read_frame_id(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return yaml_reader_hex(reader, node, "id", 0x1FFFFFFFu, &((scenario_frame_t *)target)->id);
}

static bool read_frame_message(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_message(reader, node, &((scenario_frame_t *)target)->message);
}

static bool read_frame_bytes(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_frame_t *frame = target;
    frame->exact_length = true;
    return yaml_reader_bytes(reader, node, "bytes", frame->value, frame->mask, &frame->length);
}

static bool read_frame_time(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_window(reader, node, "at_ms", &((scenario_frame_t *)target)->at_ms);
}

static bool read_frame_first(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_frame_t *frame = target;
    frame->is_first = true;
    return scenario_parse_time(reader, node, "first_since_ms", &frame->first_since_ms);
}

static bool read_frame_count(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_window(reader, node, "count", &((scenario_frame_t *)target)->count);
}

static bool read_frame_every(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_u32(reader, node, "every_ms", 1u, 60000u, &((scenario_frame_t *)target)->every_ms);
}

static bool read_frame_jitter(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_u32(reader, node, "jitter_ms", 0u, 60000u, &((scenario_frame_t *)target)->jitter_ms);
}

static void preset_frame(scenario_frame_t *frame, const yaml_node_t *node) {
    frame->line = yaml_node_line(node);
    frame->from = SCENARIO_FROM_SUPERVISOR;
    frame->any_side = true;
    frame->id = SCENARIO_NO_ID;
    frame->message = AGV_MSG_NONE;
    frame->at_ms = (scenario_window_t){0u, ENDLESS};
    frame->count = (scenario_window_t){1u, ENDLESS};
    frame->jitter_ms = JITTER_PRESET_MS;
}

static bool names_one_id(const yaml_reader_t *reader, const yaml_node_t *node, const scenario_frame_t *frame) {
    return (frame->id == SCENARIO_NO_ID) || (frame->message == AGV_MSG_NONE) ||
           yaml_reader_fail(reader, node, "either 'id' or 'message', not both");
}

bool scenario_parse_frame(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_key_t keys[] = {
        {"from", read_frame_from, false},
        {"side", read_frame_side, false},
        {"id", read_frame_id, false},
        {"message", read_frame_message, false},
        {"bytes", read_frame_bytes, false},
        {"at_ms", read_frame_time, true},
        {"first_since_ms", read_frame_first, false},
        {"count", read_frame_count, false},
        {"every_ms", read_frame_every, false},
        {"jitter_ms", read_frame_jitter, false},
    };
    scenario_frame_t *frame = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.frames);

    if (frame == NULL) {
        return false;
    }
    preset_frame(frame, node);
    if (!yaml_reader_map(reader, node, "an expected frame", keys, COUNT(keys), frame) ||
        !names_one_id(reader, node, frame)) {
        return false;
    }
    if (frame->is_first && (frame->first_since_ms > frame->at_ms.from)) {
        return yaml_reader_fail(reader, node, "first_since_ms lies after at_ms");
    }
    return ((frame->id != SCENARIO_NO_ID) || (frame->message != AGV_MSG_NONE)) ||
           yaml_reader_fail(reader, node, "an expected frame: 'id' or 'message' is missing");
}

bool scenario_parse_never(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_key_t keys[] = {
        {"from", read_frame_from, false},       {"side", read_frame_side, false},   {"id", read_frame_id, false},
        {"message", read_frame_message, false}, {"bytes", read_frame_bytes, false}, {"at_ms", read_frame_time, false},
    };
    scenario_frame_t *frame = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.never);

    if (frame == NULL) {
        return false;
    }
    preset_frame(frame, node);
    return yaml_reader_map(reader, node, "a frame that must not be", keys, COUNT(keys), frame) &&
           names_one_id(reader, node, frame);
}

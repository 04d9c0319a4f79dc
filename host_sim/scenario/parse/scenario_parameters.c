/* The parameters of steps, and the words of `kind`. */
#include "hal/can.h"
#include "scenario/parse/scenario_parse.h"
#include "scenario/scenario_actions.h"

enum { COUNT_MAX = UINT16_MAX - 1, SHORT_MAX_MS = 60000, LONG_MAX_MS = 3600000, BIT_MAX = 1000000 };
enum { PERMILLE_MAX = 900, STEER_MAX_DEG = 900, PCT_S_MAX = 10000, ID_MAX = 0x1FFFFFFF };

const yaml_word_t SCENARIO_GARBAGE[] = {{"random", VEHICLE_GARBAGE_RANDOM},
                                        {"wrong_length", VEHICLE_GARBAGE_LENGTH},
                                        {"extended", VEHICLE_GARBAGE_EXTENDED},
                                        {"remote", VEHICLE_GARBAGE_REMOTE},
                                        {NULL, 0}};
const yaml_word_t SCENARIO_FRAME_KINDS[] = {
    {"data", 0},        {"extended", HAL_CAN_EXTENDED}, {"remote", HAL_CAN_REMOTE},
    {"fd", HAL_CAN_FD}, {"error", HAL_CAN_ERROR},       {NULL, 0}};

static const yaml_shape_t OTHER_BYTES = {.kind = YAML_KIND_BYTES, .highest = AGV_DLC, .may_be_open = true};

#define NUMBER(name_, low, high) {.name = (name_), .kind = YAML_KIND_NUMBER, .lowest = (low), .highest = (high)}
#define TIME(name_, low, high)                                                                                         \
    {.name = (name_), .kind = YAML_KIND_TIME, .unit = DURATION_MS, .lowest = (low), .highest = (high)}
#define WORD(name_, list) {.name = (name_), .kind = YAML_KIND_WORD, .words = (list)}
#define OTHER(name_, shape_) {.name = (name_), .kind = YAML_KIND_CALL, .shape = (shape_)}

const yaml_key_t SCENARIO_PARAMETER_ROWS[SCENARIO_PARAMETERS] = {
    OTHER("message", &SCENARIO_MESSAGE_SHAPE),
    NUMBER("frames", 1, COUNT_MAX),
    TIME("by_ms", 0, SHORT_MAX_MS),
    NUMBER("times", 0, COUNT_MAX),
    OTHER("kind", &SCENARIO_TEXT_SHAPE),
    TIME("every_ms", 1, SHORT_MAX_MS),
    OTHER("bytes", &OTHER_BYTES),
    OTHER("field", &SCENARIO_TEXT_SHAPE),
    {.name = "value", .kind = YAML_KIND_HEX, .highest = UINT32_MAX},
    WORD("gear", SCENARIO_GEARS),
    NUMBER("throttle_pct", 0, 100),
    NUMBER("steer_deg", -STEER_MAX_DEG, STEER_MAX_DEG),
    NUMBER("button", 1, 2),
    WORD("side", SCENARIO_SIDES),
    {.name = "id", .kind = YAML_KIND_ID, .highest = ID_MAX},
    WORD("cause", SCENARIO_CAUSES),
    TIME("off_ms", 0, LONG_MAX_MS),
    TIME("for_ms", 1, LONG_MAX_MS),
    NUMBER("bit", 0, BIT_MAX),
    NUMBER("every_frames", 2, COUNT_MAX),
    NUMBER("pct_s", 1, PCT_S_MAX),
    NUMBER("speed_mm_s", -VEHICLE_ROLL_MAX_MM_S, VEHICLE_ROLL_MAX_MM_S),
    OTHER("pattern_ms", &SCENARIO_BOUNCE_SHAPE),
    NUMBER("permille", 1, PERMILLE_MAX),
    OTHER("part", &SCENARIO_TESTED_PART_SHAPE),
};

const yaml_key_t *scenario_parameter(uint32_t parameter) {
    size_t bit = 0;
    while ((bit < SCENARIO_PARAMETERS - 1) && ((parameter >> bit) != 1)) {
        bit++;
    }
    return &SCENARIO_PARAMETER_ROWS[bit];
}

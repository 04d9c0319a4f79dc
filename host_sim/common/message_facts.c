#include "common/message_facts.h"

#include "hal/can.h"

enum { NO_COUNTER = MESSAGE_NO_COUNTER, STEP_MAX = 3, STEPS_AFTER_WRONG = 2 };

static const struct {
    uint16_t deadline;
    uint8_t counter_at;
} facts[AGV_MSG_COUNT] = {
#define AGV_COMMAND AGV_STATUS
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter)                                        \
    [AGV_MSG_##NAME] = {AGV_SETTING_##deadline, (counter)},
#include "agv/message_table.def"
#undef AGV_COMMAND
#undef AGV_STATUS
};

message_sender_t message_sender(uint32_t message) {
    const bool is_of_eps = (message == AGV_MSG_STEERING_STATUS) || (message == AGV_MSG_EPS_STATUS) ||
                           (message == AGV_MSG_STEERING_POSITION);
    const message_sender_t other = (message < AGV_COMMAND_COUNT) ? MESSAGE_FROM_AI : MESSAGE_FROM_VCU;
    return is_of_eps ? MESSAGE_FROM_EPS : other;
}

bool message_id_is_heard(const agv_ids_t *ids, uint32_t id) {
    return (agv_ids_find(ids, id) != AGV_MSG_NONE) || (agv_message_from_id(id, AGV_ID_SET_HEADING) != AGV_MSG_NONE) ||
           (agv_message_from_id(id, AGV_ID_SET_TABLE) != AGV_MSG_NONE);
}

uint8_t message_counter_at(uint32_t message) {
    return facts[message].counter_at;
}

uint16_t message_deadline_setting(uint32_t message) {
    return facts[message].deadline;
}

bool message_has_to_increment(const agv_config_t *config, uint32_t message) {
    const uint16_t choices[] = {[MESSAGE_FROM_AI] = config->ai_counter,
                                [MESSAGE_FROM_VCU] = config->vcu_counter,
                                [MESSAGE_FROM_EPS] = config->eps_counter};
    return choices[message_sender(message)] == AGV_COUNTER_INCREMENTS;
}

/** Whether a counter that has to increment does so: after a wrong step only the second right one counts. */
static bool increments(message_beat_t *beat, uint8_t step) {
    if ((step == 0) || (step > STEP_MAX)) {
        beat->steps_needed = STEPS_AFTER_WRONG;
        return false;
    }
    if (beat->steps_needed > 0) {
        beat->steps_needed--;
    }
    return beat->steps_needed == 0;
}

bool message_beats(message_beat_t *beat, const agv_config_t *config, uint32_t message, uint8_t value) {
    const uint8_t step = (uint8_t)(value - beat->value);
    const bool is_first = !beat->is_heard;
    beat->value = value;
    beat->is_heard = true;
    if (is_first) {
        return true;
    }
    return message_has_to_increment(config, message) ? increments(beat, step) : (step != 0);
}

const char *message_form(uint32_t flags) {
    if ((flags & HAL_CAN_ERROR) != 0) {
        return "error frame";
    }
    if ((flags & HAL_CAN_REMOTE) != 0) {
        return "remote frame";
    }
    if ((flags & HAL_CAN_FD) != 0) {
        return "CAN FD frame";
    }
    return (flags != 0) ? "extended frame" : "";
}

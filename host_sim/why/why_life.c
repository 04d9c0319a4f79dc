/* When each message came last, and when its alive counter changed last (SUP-2, SUP-3). */
#include "why/why_internal.h"

enum { NO_COUNTER = 0xFF, STEP_MAX = 3, STEPS_AFTER_WRONG = 2 };

/** The index of the alive counter in data[] of each message. */
static const uint8_t counters_at[AGV_MSG_COUNT] = {
#define AGV_COMMAND AGV_STATUS
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter) [AGV_MSG_##NAME] = (counter),
#include "agv/message_table.def"
#undef AGV_COMMAND
#undef AGV_STATUS
};

void why_life_start(why_t *why) {
    for (size_t i = 0u; i < (size_t)AGV_MSG_COUNT; i++) {
        why_message_t *message = &why->messages[i];
        message->last_us = WHY_NEVER;
        message->beat_us = WHY_NEVER;
        message->beat = why_no_evidence();
        message->first_repeat = why_no_evidence();
    }
}

static bool counts_up(const why_t *why, agv_message_t message) {
    const uint16_t choice = (message == AGV_MSG_VEHICLE_STATUS)    ? why->config.vcu_counter
                            : (message == AGV_MSG_STEERING_STATUS) ? why->config.eps_counter
                                                                   : why->config.ai_counter;
    return choice == (uint16_t)AGV_COUNTER_INCREMENTS;
}

/** Whether an alive counter has changed as it should. */
static bool is_changed(why_message_t *message, uint8_t counter, bool increments) {
    const uint32_t step = ((uint32_t)counter - message->counter) & 0xFFu;
    if (!increments) {
        return step != 0u;
    }
    if ((step == 0u) || (step > (uint32_t)STEP_MAX)) {
        message->steps_needed = STEPS_AFTER_WRONG;
        return false;
    }
    if (message->steps_needed > 0u) {
        message->steps_needed--;
    }
    return message->steps_needed == 0u;
}

static void beat(why_message_t *message, const why_evidence_t *frame) {
    message->beat_us = frame->t_us;
    message->beat = *frame;
    message->repeats = false;
    message->first_repeat = why_no_evidence();
}

static void follow_counter(why_t *why, agv_message_t number, const why_evidence_t *frame) {
    why_message_t *message = &why->messages[number];
    const uint8_t counter = frame->frame.data[counters_at[number]];
    const bool changed = (message->count == 0u) || is_changed(message, counter, counts_up(why, number));
    message->counter = counter;
    if (changed) {
        beat(message, frame);
    } else if (!message->repeats) {
        message->repeats = true;
        message->first_repeat = *frame;
    } else {
        /* it still does not change */
    }
}

void why_life_frame(why_t *why, agv_message_t number, const why_evidence_t *frame) {
    why_message_t *message = &why->messages[number];
    if (counters_at[number] != (uint8_t)NO_COUNTER) {
        follow_counter(why, number, frame);
    } else {
        message->beat_us = frame->t_us;
    }
    message->history[message->count % (uint32_t)WHY_HISTORY] = *frame;
    message->count++;
    message->last_us = frame->t_us;
}

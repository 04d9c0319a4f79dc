/* When each message came last, and when its alive counter changed last (SUP-2, SUP-3). */
#include "why/why_internal.h"

void why_life_start(why_t *why) {
    for (size_t i = 0u; i < (size_t)AGV_MSG_COUNT; i++) {
        why_message_t *message = &why->messages[i];
        message->last_us = WHY_NEVER;
        message->beat_us = WHY_NEVER;
        message->beat = why_no_evidence();
        message->first_repeat = why_no_evidence();
    }
}

static void beat(why_message_t *message, const why_evidence_t *frame) {
    message->beat_us = frame->t_us;
    message->beat = *frame;
    message->repeats = false;
    message->first_repeat = why_no_evidence();
}

static void follow_counter(why_t *why, agv_message_t number, const why_evidence_t *frame) {
    why_message_t *message = &why->messages[number];
    const uint8_t counter = frame->frame.data[message_counter_at(number)];
    if (message_beats(&message->counter, &why->config, number, counter)) {
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
    if (message_counter_at(number) != MESSAGE_NO_COUNTER) {
        follow_counter(why, number, frame);
    } else {
        message->beat_us = frame->t_us;
    }
    message->history[message->count % (uint32_t)WHY_HISTORY] = *frame;
    message->count++;
    message->last_us = frame->t_us;
}

/* When each message came last, and when its alive counter changed last (SUP-2, SUP-3). */
#include "agv/codec.h"
#include "text/units.h"
#include "why/why_internal.h"

void why_life_start(why_t *why) {
    for (size_t i = 0; i < AGV_MSG_COUNT; i++) {
        why_message_t *message = &why->messages[i];
        message->last_us = WHY_NEVER;
        message->beat_us = WHY_NEVER;
        message->beat = why_no_evidence();
        message->first_repeat = why_no_evidence();
    }
}

/** The usual time between two: it follows a shorter one at once, a longer one slowly. */
static uint64_t usual(uint64_t usual_us, uint64_t gap_us) {
    return ((usual_us == 0) || (gap_us < usual_us)) ? gap_us : (usual_us + ((gap_us - usual_us) / 8));
}

static void beat(why_message_t *message, const why_evidence_t *frame) {
    message->usual_us = (message->beat_us != WHY_NEVER) ? usual(message->usual_us, frame->t_us - message->beat_us) : 0;
    message->beat_us = frame->t_us;
    message->beat = *frame;
    message->repeats = false;
    message->steps = false;
    message->first_repeat = why_no_evidence();
    message->refused.count = 0;
}

static void follow_counter(why_t *why, agv_message_t number, const why_evidence_t *frame) {
    why_message_t *message = &why->messages[number];
    const uint8_t counter = frame->frame.data[message_counter_at(number)];
    const uint8_t before = message->counter.value;
    if (message_beats(&message->counter, &why->config, number, counter)) {
        beat(message, frame);
        return;
    }
    message->first_repeat = message->repeats ? message->first_repeat : *frame;
    message->repeats = true;
    message->steps = message->steps || (counter != before);
}

/** A gateway keeps a command of motion from a vehicle that does not report autopilot: its deadline runs on (TOP-2). */
static bool is_withheld(const why_t *why, agv_message_t number) {
    const uint32_t mode = why->facts.mode_bits & (AGV_VCU_FLAG_MANUAL | AGV_VCU_FLAG_AUTOPILOT);
    return why->is_gateway && why_is_command(number) && (number != AGV_MSG_TURN_SIGNAL_COMMAND) &&
           why->engagement.engaged && (mode != AGV_VCU_FLAG_AUTOPILOT);
}

uint64_t why_fresh_until_us(const why_t *why, agv_message_t number) {
    const why_message_t *message = &why->messages[number];
    const bool has_counter = message_counter_at(number) != MESSAGE_NO_COUNTER;
    const uint64_t deadline_ms = agv_config_get(&why->config, message_deadline_setting(number));
    const bool is_running = message->count > (has_counter ? 1 : 0); /* one value alone does not show life */
    return is_running ? ((message->beat_us / US_PER_MS) + deadline_ms + 1) * US_PER_MS : 0;
}

void why_life_refuse(why_t *why, agv_message_t number, const why_evidence_t *frame) {
    if (number == AGV_MSG_NONE) {
        return;
    }
    why_refused_t *refused = &why->messages[number].refused;
    refused->first = (refused->count == 0) ? *frame : refused->first;
    refused->count++;
}

void why_life_frame(why_t *why, agv_message_t number, const why_evidence_t *frame) {
    why_message_t *message = &why->messages[number];
    if (is_withheld(why, number)) {
        why_life_refuse(why, number, frame);
    } else if (message_counter_at(number) != MESSAGE_NO_COUNTER) {
        follow_counter(why, number, frame);
    } else {
        beat(message, frame);
    }
    message->history[message->count % WHY_HISTORY] = *frame;
    message->count++;
    message->last_us = frame->t_us;
}

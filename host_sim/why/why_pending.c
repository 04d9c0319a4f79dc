/* What had begun and was not decided yet when the run ended. */
#include <inttypes.h>

#include "agv/names.h"
#include "agv/state.h"
#include "text/units.h"
#include "why/why_internal.h"
#include "why/why_words.h"

/** Whether the silence of a message counts now. */
static bool counts(const why_t *why, agv_message_t message) {
    const bool needs_engagement = why_is_command(message) && (message != AGV_MSG_TURN_SIGNAL_COMMAND);
    return (why->messages[message].count > 0u) && (!needs_engagement || why->engagement.engaged);
}

static bool is_active(const why_t *why, agv_fault_t fault) {
    return why->faults[fault].active;
}

static bool add_silence(text_t *text, const why_t *why, agv_fault_t fault) {
    const why_row_t *row = why_row(fault);
    const why_message_t *message = &why->messages[row->message];
    const uint64_t cycle_us = (uint64_t)agv_message_cycle_ms(row->message) * US_PER_MS;
    if (!counts(why, row->message) || (message->beat_us == WHY_NEVER)) {
        return false;
    }
    const uint64_t age_us = why->now_us - message->beat_us;
    const bool stuck = message->repeats;
    if ((age_us <= 2u * cycle_us) || (stuck != (row->kind == WHY_STUCK))) {
        return false;
    }
    text_add(text, "%03Xh %s %s for %" PRIu64 " ms, deadline %u ms", why->ids.of[row->message],
             agv_message_name(row->message), stuck ? "kept its alive counter" : "was silent", age_us / US_PER_MS,
             (unsigned)agv_config_get(&why->config, row->setting));
    return true;
}

static bool add_tracked(text_t *text, const why_t *why, agv_fault_t fault) {
    const why_tracker_t *tracker = &why->trackers[fault];
    if ((tracker->value == 0u) || !tracker->bad) {
        return false;
    }
    text_add(text, "%s had begun at ", agv_fault_name(fault));
    why_words_time(text, tracker->began_us);
    return true;
}

bool why_words_pending(text_t *text, const why_t *why, agv_fault_t fault) {
    const why_kind_t kind = why_row(fault)->kind;
    const bool decided = agv_state_is_latched((agv_state_t)why->state) || (why->state == (uint8_t)AGV_STATE_INIT);
    if (decided || is_active(why, fault)) {
        return false;
    }
    if ((kind == WHY_SILENCE) || (kind == WHY_STUCK)) {
        return add_silence(text, why, fault);
    }
    return add_tracked(text, why, fault);
}

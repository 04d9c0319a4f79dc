/* What had begun and was not decided yet when the run ended. */
#include <inttypes.h>

#include "agv/names.h"
#include "agv/state.h"
#include "text/units.h"
#include "why/why_internal.h"
#include "why/why_words.h"

/** A 43Fh that never came has a deadline of its own, from the engagement on (SUP-8). */
static bool is_never_seen(const why_t *why, agv_message_t message) {
    return (message == AGV_MSG_TURN_SIGNAL_COMMAND) && (why->messages[message].count == 0);
}

/** Since when the silence of a message counts; WHY_NEVER: it does not. */
static uint64_t counts_from(const why_t *why, agv_message_t message) {
    const uint64_t beat_us = why->messages[message].beat_us;
    if (!why_is_command(message) || ((message == AGV_MSG_TURN_SIGNAL_COMMAND) && !is_never_seen(why, message))) {
        return beat_us;
    }
    const uint64_t engaged_us = why->engagement.engaged ? why->engagement.began_us : WHY_NEVER;
    return ((beat_us == WHY_NEVER) || (beat_us < engaged_us)) ? engaged_us : beat_us;
}

/** A silence up to this time is usual: for the protocol, or for this sender. */
static uint64_t usual_us(const why_t *why, agv_message_t message) {
    const uint64_t two_cycles_us = 2 * (uint64_t)agv_message_cycle_ms(message) * US_PER_MS;
    const uint64_t sender_us = why->messages[message].usual_us * 3 / 2;
    return (sender_us > two_cycles_us) ? sender_us : two_cycles_us;
}

static bool is_active(const why_t *why, agv_fault_t fault) {
    return why->faults[fault].active;
}

static bool add_silence(text_t *text, const why_t *why, agv_fault_t fault) {
    const why_row_t *row = why_row(fault);
    const why_message_t *message = &why->messages[row->message];
    const uint64_t from_us = counts_from(why, row->message);
    const uint64_t age_us = (from_us != WHY_NEVER) ? why->now_us - from_us : 0;
    const bool stuck = message->repeats;
    const uint16_t setting =
        is_never_seen(why, row->message) ? (uint16_t)AGV_SETTING_ai_never_seen_timeout_ms : row->setting;
    if ((age_us <= usual_us(why, row->message)) || (stuck != (row->kind == WHY_STUCK))) {
        return false;
    }
    text_add(text, "%03Xh %s %s for %" PRIu64 " ms, deadline %u ms", why->ids.of[row->message],
             agv_message_name(row->message),
             !stuck           ? "was silent"
             : message->steps ? WHY_WRONG_STEPS
                              : "kept its alive counter",
             age_us / US_PER_MS, (unsigned)agv_config_get(&why->config, setting));
    return true;
}

static bool add_tracked(text_t *text, const why_t *why, agv_fault_t fault) {
    const why_tracker_t *tracker = why_tracker(why, fault);
    if ((tracker == NULL) || !tracker->bad) {
        return false;
    }
    text_add(text, "%s had begun at ", agv_fault_name(fault));
    why_words_time(text, tracker->began_us);
    return true;
}

bool why_words_pending(text_t *text, const why_t *why, agv_fault_t fault) {
    const why_kind_t kind = why_row(fault)->kind;
    const bool decided = agv_state_is_latched((agv_state_t)why->state) || (why->state == AGV_STATE_INIT);
    if (decided || is_active(why, fault)) {
        return false;
    }
    if ((kind == WHY_SILENCE) || (kind == WHY_STUCK)) {
        return add_silence(text, why, fault);
    }
    return (kind != WHY_BIT) && add_tracked(text, why, fault); /* a bit is decided with its frame */
}

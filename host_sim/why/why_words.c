#include "why/why_words.h"

#include <inttypes.h>

#include "agv/codec.h"
#include "agv/names.h"
#include "agv/recorder.h"
#include "text/units.h"
#include "text/words.h"
#include "why/why_internal.h"

enum { DDEG_PER_DEG = 10 };

/**
 * What a fault means, after the name of its message. %L stands for the limit, %T for the setting of its time, %C for the
 * message with which its own is compared, %V for the identifier of 363h.
 */
typedef struct {
    const char *words;
    uint16_t time; /**< setting of %T */
} meaning_t;

#define SAYS(fault, words_) [AGV_FAULT_##fault] = {(words_), 0u}
#define LASTS(fault, words_, setting) [AGV_FAULT_##fault] = {(words_), AGV_SETTING_##setting}

static const meaning_t meanings[AGV_FAULT_COUNT] = {
    SAYS(SELF_TEST_FAILED, "a self-test failed"),
    SAYS(MEMORY_CORRUPTED, "the memory of the supervisor was changed by something else"),
    SAYS(CONFIG_INVALID, "the configuration is not valid"),
    SAYS(OUTPUT_FEEDBACK, "the contact of the safety output differed from its command for %L"),
    SAYS(SUPERVISOR_RESET, "the processor was reset during a run"),
    SAYS(EMERGENCY_STOP, "the emergency stop input opened"),
    SAYS(TX_GATE_REFUSED, "the gate refused a frame of the supervisor"),
    SAYS(STEP_OVERRUN, "a step came later than %L"),
    SAYS(CLOCK_DEVIATION, "the two clocks of the supervisor differed by more than 5 %%"),
    SAYS(BUS_OFF, "the vehicle-side controller was bus-off"),
    SAYS(TX_STALLED, "a frame waited for longer than %L to be sent"),
    SAYS(MODE_INVALID, "reported manual and autopilot together for %L"),
    SAYS(MODE_FLAPPING,
         "changed the mode too often (more than three engagements in %L, or manual that flickered while engaged)"),
    SAYS(MODE_NONE, "reported no valid mode for %L while the vehicle moved"),
    SAYS(EPS_MODE_OFF, "reported that the EPS is off"),
    SAYS(EPS_MODE_INVALID, "reported an EPS mode that does not exist"),
    SAYS(EPS_MODE_NOT_ANGLE, "reported an EPS mode other than angle control"),
    SAYS(GEAR_STATUS_INVALID, "reported a gear that does not exist"),
    SAYS(THROTTLE_STATUS_INVALID, "reported a throttle above 100 %%"),
    SAYS(STEERING_ANGLE_INVALID, "reported an angle above 900 deg"),
    LASTS(STEERING_DEVIATION, "was more than %L off %C for %T", steering_deviation_ms),
    LASTS(THROTTLE_DEVIATION, "was more than %L above %C for %T", throttle_deviation_ms),
    SAYS(GEAR_DEVIATION, "reported a gear that was not commanded, with throttle, for %L"),
    SAYS(AUTOPILOT_OFF_IGNORED, "still reported autopilot after %C had requested autopilot off for %L"),
    SAYS(THROTTLE_IN_PARK, "was above idle in gear P for %L"),
    SAYS(SPEED_IMPLAUSIBLE, "differed from the speed in %C for %L"),
    SAYS(VEHICLE_NOT_STOPPING, "reported no standing wheels within %L after the trip, or %V contradicted them"),
    SAYS(MOVING_WHILE_SAFE,
         "reported turning wheels for %L after the vehicle had stood, or standing wheels that %V contradicted"),
    SAYS(STARTUP_TIMEOUT, "the conditions to leave INIT did not hold within %L"),
    SAYS(RX_OVERRUN, "the controller lost received frames"),
    SAYS(ERROR_PASSIVE, "the vehicle-side controller was error-passive"),
    SAYS(AI_BUS_OFF, "the AI-side controller was bus-off"),
    SAYS(WRONG_ID_SET, "came in place of the configured identifier for %L"),
    SAYS(STORE_INVALID, "the stored latch was damaged"),
};

void why_words_time(text_t *text, uint64_t t_us) {
    text_add(text, "%" PRIu64 ".%03" PRIu64 " s", t_us / US_PER_S, (t_us % US_PER_S) / US_PER_MS);
}

/** "065h steering_command" */
static void add_message(text_t *text, const why_t *why, agv_message_t message) {
    text_add(text, "%03Xh %s", why->ids.of[message], agv_message_name(message));
}

/** What the sentence is about where it is not known which message it was. */
static const char *unknown_name(agv_fault_t reason) {
    switch (reason) {
    case AGV_FAULT_AI_COMMAND_OUT_OF_RANGE:
    case AGV_FAULT_FOREIGN_COMMAND_SENDER:
    case AGV_FAULT_COMMAND_TOO_FAST:
        return "a command ";
    case AGV_FAULT_WRONG_ID_SET:
        return "an identifier of the other set ";
    default:
        return "";
    }
}

static void add_name(text_t *text, const why_trip_t *trip) {
    const char *name = agv_message_name(trip->message);
    if (trip->id == WHY_NO_ID) {
        text_add(text, "%s", unknown_name(trip->reason));
    } else {
        text_add(text, "%03" PRIX32 "h%s%s ", trip->id, (name != NULL) ? " " : "", (name != NULL) ? name : "");
    }
}

static void add_limit(text_t *text, const why_trip_t *trip) {
    if (trip->unit == NULL) {
        return;
    }
    if (trip->unit[0] == 'd') {
        text_add(text, "%" PRId64 ".%" PRId64 " deg", trip->limit / DDEG_PER_DEG, trip->limit % DDEG_PER_DEG);
    } else {
        text_add(text, "%" PRId64 " %s", trip->limit, trip->unit);
    }
}

/** Add what a letter after a per cent sign stands for. */
static void add_part(text_t *text, const why_t *why, const why_trip_t *trip, char letter) {
    if (letter == 'L') {
        add_limit(text, trip);
    } else if (letter == 'T') {
        text_add(text, "%u ms", (unsigned)agv_config_get(&why->config, meanings[trip->reason].time));
    } else if (letter == 'C') {
        add_message(text, why, why_compared_with(trip->reason));
    } else if (letter == 'V') {
        text_add(text, "%03Xh", why->ids.of[AGV_MSG_VEHICLE_STATUS]);
    } else {
        text_add(text, "%c", letter);
    }
}

static void add_meaning(text_t *text, const why_t *why, const why_trip_t *trip, agv_fault_t fault) {
    const char *words = meanings[fault].words;
    for (const char *at = (words != NULL) ? words : ""; *at != '\0'; at++) {
        if (*at == '%') {
            at++;
            add_part(text, why, trip, *at);
        } else {
            text_add(text, "%c", *at);
        }
    }
}

static void add_from(text_t *text, const char *words, uint64_t t_us) {
    if (t_us != WHY_NEVER) {
        text_add(text, "%s", words);
        why_words_time(text, t_us);
    }
}

/** "from 1.200 s on"; nothing where a flight recorder does not know the time. */
static void add_since(text_t *text, const char *words, uint64_t t_us) {
    if (t_us != WHY_NEVER) {
        add_from(text, words, t_us);
        text_add(text, " on");
    }
}

/** Add since when it lasted. */
static void add_began(text_t *text, const why_trip_t *trip) {
    if (trip->cause_us != WHY_NEVER) {
        add_since(text, ", from ", trip->cause_us);
        text_add(text, trip->at_the_latest ? " at the latest" : "");
    }
}

void why_words_refused(text_t *text, const why_trip_t *trip) {
    const hal_can_frame_t *frame = &trip->refused.first.frame;
    const unsigned count = (unsigned)trip->refused.count;
    const bool is_other_form = !why_was_withheld(trip) && (frame->flags != 0);
    text_add(text, "%u %s%s came", count, is_other_form ? message_form(frame->flags) : "frame", words_plural(count));
    if (why_was_withheld(trip)) {
        text_add(text, " while the VCU did not report autopilot");
    } else if (!is_other_form) {
        text_add(text, " with a length of %u", (unsigned)frame->length);
    }
    add_from(text, ", the first at ", trip->refused.first.t_us);
}

static void say_silence(text_t *text, const why_t *why, const why_trip_t *trip) {
    text_add(text, why_was_withheld(trip) ? "was not passed on"
                   : trip->was_heard      ? "was silent"
                                          : "was never received");
    add_from(text, ": last at ", trip->last_good_us);
    if (trip->from_engagement) {
        add_from(text, ", engaged at ", trip->cause_us);
    }
    text_add(text, ", deadline %" PRId64 " ms", trip->limit);
    if (trip->next_us != WHY_NEVER) {
        add_from(text, ", next at ", trip->next_us);
    } else if ((trip->last_good_us != WHY_NEVER) && !why->is_recorder) {
        text_add(text, ", none since");
    } else {
        /* that it was never heard says it; a flight recorder does not know */
    }
    if (trip->refused.count > 0) {
        text_add(text, "; ");
        why_words_refused(text, trip);
    }
}

/** Add the payload of the first bad frame. */
static void add_payload(text_t *text, const why_trip_t *trip) {
    const hal_can_frame_t *frame = &trip->bad.frame;
    if (trip->bad.t_us == WHY_NEVER) {
        return;
    }
    text_add(text, " [");
    for (size_t i = 0; (i < frame->length) && (i < sizeof frame->data); i++) {
        text_add(text, "%s%02X", (i > 0) ? " " : "", frame->data[i]);
    }
    text_add(text, "]");
}

static void say_stuck(text_t *text, const why_trip_t *trip) {
    text_add(text, trip->wrong_steps ? WHY_WRONG_STEPS : "kept its alive counter");
    add_since(text, " from ", trip->cause_us);
    add_payload(text, trip);
    add_from(text, trip->wrong_steps ? ": last right step at " : ": last change at ", trip->last_good_us);
    text_add(text, ", deadline %" PRId64 " ms", trip->limit);
}

static void say_bit(text_t *text, const why_trip_t *trip) {
    text_add(text, "reported %s", agv_fault_name(trip->reason));
    add_from(text, " at ", trip->cause_us);
    add_payload(text, trip);
}

/** Frames that were not bad may have come between them: then they are more than the limit. */
static int64_t bad_frames(const why_trip_t *trip) {
    return (trip->bad_frames != 0) ? (int64_t)trip->bad_frames : trip->limit;
}

static void say_score(text_t *text, const why_t *why, const why_trip_t *trip) {
    const agv_fault_t said = trip->is_mixed ? AGV_FAULT_EPS_MODE_NOT_ANGLE : trip->reason;
    if (meanings[said].words != NULL) {
        add_meaning(text, why, trip, said);
    } else {
        text_add(text, "reported %s", agv_fault_name(trip->reason));
    }
    text_add(text, " in %" PRId64 " frames", bad_frames(trip));
    if (trip->from_engagement) {
        add_from(text, " since the engagement at ", trip->cause_us);
        text_add(text, "; earlier frames were bad, too");
        return;
    }
    add_from(text, ", the first at ", trip->cause_us);
    text_add(text, trip->at_the_latest ? " at the latest" : "");
    add_payload(text, trip);
}

static void say_value(text_t *text, const why_trip_t *trip) {
    const hal_can_frame_t *bad = &trip->bad.frame;
    const bool malformed = (trip->bad.t_us != WHY_NEVER) && ((bad->length != AGV_DLC) || (bad->flags != 0));
    if (trip->id == WHY_NO_ID) {
        text_add(text, "had an invalid value, a wrong length or a wrong format"); /* a recorder has values only */
    } else {
        text_add(text, malformed ? "had a wrong length or format" : "commanded an invalid value");
    }
    add_from(text, " at ", trip->cause_us);
    add_payload(text, trip);
}

static void say_intrusion(text_t *text, const why_trip_t *trip) {
    if (trip->reason == AGV_FAULT_COMMAND_TOO_FAST) {
        text_add(text, "came in less than half its cycle %" PRId64 " times", bad_frames(trip));
        add_from(text, ", the first time at ", trip->cause_us);
    } else {
        text_add(text, (trip->reason == AGV_FAULT_STATUS_ID_IN_USE) ? "is sent by another node"
                                                                    : "came from the vehicle side");
        add_from(text, ": at ", trip->cause_us);
        add_payload(text, trip);
    }
}

static void say_vehicle(text_t *text, const why_t *why, const why_trip_t *trip) {
    if (trip->reason == AGV_FAULT_SAFE_STATE_UNCONFIRMED) {
        text_add(text, "did not confirm %s for %" PRId64 " ms",
                 (trip->message == AGV_MSG_GEAR_STATUS) ? "gear P" : "that the autopilot is off", trip->limit);
    } else {
        add_meaning(text, why, trip, trip->reason);
    }
    add_began(text, trip);
}

static void say_lasting(text_t *text, const why_t *why, const why_trip_t *trip) {
    if ((trip->reason == AGV_FAULT_SUPERVISOR_RESET) && (why->config.after_power_on != AGV_AFTER_POWER_ON_INIT)) {
        text_add(text, "a power-on (after_power_on: tripped), or ");
    }
    add_meaning(text, why, trip, trip->reason);
    if (trip->cause_us != trip->t_us) {
        add_began(text, trip);
    }
}

void why_words_cause(text_t *text, const why_t *why, const why_trip_t *trip) {
    if (trip->from_earlier_run) {
        text_add(text, "latched in an earlier run");
        return;
    }
    add_name(text, trip);
    switch (trip->kind) {
    case WHY_SILENCE:
        say_silence(text, why, trip);
        break;
    case WHY_STUCK:
        say_stuck(text, trip);
        break;
    case WHY_BIT:
        say_bit(text, trip);
        break;
    case WHY_SCORE:
        say_score(text, why, trip);
        break;
    case WHY_VALUE:
        say_value(text, trip);
        break;
    case WHY_INTRUSION:
        say_intrusion(text, trip);
        break;
    case WHY_VEHICLE:
        say_vehicle(text, why, trip);
        break;
    default:
        say_lasting(text, why, trip);
        break;
    }
}

/** Add how a message that carries a heartbeat fails. */
static void say_no_beat(text_t *text, const why_t *why, agv_message_t number) {
    const why_message_t *message = &why->messages[number];
    const unsigned id = why->ids.of[number];
    if (message->count == 0) {
        text_add(text, "%03Xh never received", id);
    } else if (message->repeats) {
        text_add(text,
                 message->steps ? "alive counter of %03Xh does not step by 1 to 3"
                                : "alive counter of %03Xh stuck at %u",
                 id, message->counter.value);
    } else {
        text_add(text, "%03Xh last received at ", id);
        why_words_time(text, message->last_us);
    }
}

static void say_no_manual(text_t *text, const why_t *why) {
    const unsigned id = why->ids.of[AGV_MSG_VEHICLE_STATUS];
    const uint32_t bits = why->facts.mode_bits & (AGV_VCU_FLAG_MANUAL | AGV_VCU_FLAG_AUTOPILOT);
    if (!why->facts.mode_known) {
        text_add(text, "%03Xh never received", id);
        return;
    }
    const char *mode = (bits == 0)                        ? "neither mode"
                       : (bits == AGV_VCU_FLAG_MANUAL)    ? "manual only part of the time"
                       : (bits == AGV_VCU_FLAG_AUTOPILOT) ? "autopilot"
                                                          : "both modes";
    text_add(text, "%03Xh reports %s%s", id, mode, why->manual_was_seen ? "" : " from its first frame");
}

/** Name the messages that INIT waits for, apart from the two that have to beat. */
static void say_no_messages(text_t *text, const why_t *why, bool heard) {
    const char *between = "";
    for (int i = (int)AGV_COMMAND_COUNT; i < AGV_MSG_COUNT; i++) {
        const why_message_t *message = &why->messages[i];
        const uint64_t age_us = why->now_us - ((message->count > 0) ? message->last_us : 0);
        const bool late =
            age_us > (uint64_t)agv_config_get(&why->config, message_deadline_setting((uint32_t)i)) * US_PER_MS;
        const bool counts = message_counter_at((uint32_t)i) == MESSAGE_NO_COUNTER;
        if (counts && (heard == (message->count > 0)) && (!heard || late)) {
            text_add(text, "%s%03Xh", between, why->ids.of[i]);
            between = ", ";
        }
    }
    if (between[0] != '\0') {
        text_add(text, heard ? " silent" : " never received");
    }
}

static void say_trip_causes(text_t *text, const why_t *why) {
    const char *between = "";
    for (size_t i = 0; i < why->fault_count; i++) {
        const why_fault_t *fault = &why->faults[why->fault_order[i]];
        if (fault->active && (fault->fault_class == AGV_CLASS_TRIP)) {
            text_add(text, "%s%s", between, agv_fault_name(fault->fault));
            between = ", ";
        }
    }
}

/** Where the words of the VCU's heartbeat say it already, nothing. */
static void say_no_standstill(text_t *text, const why_t *why) {
    const uint32_t wheels = why->ids.of[AGV_MSG_WHEEL_SPEED];
    if (why->messages[AGV_MSG_WHEEL_SPEED].count == 0) {
        text_add(text, "%03Xh never received", (unsigned)wheels);
    } else if (!why_wheels_are_slow(why)) {
        text_add(text, "%03Xh reports left %d mm/s, right %d mm/s", (unsigned)wheels, (int)why->facts.left_mm_s,
                 (int)why->facts.right_mm_s);
    } else if (!why_vcu_is_slow(why)) {
        text_add(text, "%03Xh reports a speed of %u m/h", (unsigned)why->ids.of[AGV_MSG_VEHICLE_STATUS],
                 (unsigned)why->facts.vcu_speed);
    } else {
        /* one of the two messages is silent */
    }
}

void why_words_missing(text_t *text, const why_t *why, uint8_t bit) {
    if (((why->lacking >> bit) & 1) == 0) {
        return; /* it was there in the end: how it is now says nothing */
    }
    if ((((why->lacking_at_end >> bit) & 1) == 0) && ((1u << bit) != AGV_MISSING_MANUAL)) {
        text_add(text, "not all the time");
        return;
    }
    switch (1u << bit) {
    case AGV_MISSING_VCU_HEARTBEAT:
        say_no_beat(text, why, AGV_MSG_VEHICLE_STATUS);
        break;
    case AGV_MISSING_EPS_HEARTBEAT:
        say_no_beat(text, why, AGV_MSG_STEERING_STATUS);
        break;
    case AGV_MISSING_MANUAL:
        say_no_manual(text, why);
        break;
    case AGV_MISSING_MESSAGES:
        say_no_messages(text, why, false);
        say_no_messages(text, why, true);
        break;
    case AGV_MISSING_STANDSTILL:
        say_no_standstill(text, why);
        break;
    case AGV_MISSING_TRIP_CAUSE:
        say_trip_causes(text, why);
        break;
    case AGV_MISSING_THROTTLE:
        text_add(text, "%03Xh last reported %u counts", (unsigned)why->ids.of[AGV_MSG_THROTTLE_STATUS],
                 (unsigned)why->facts.throttle);
        break;
    default:
        break;
    }
}

#include "report/sentence.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "text/units.h"
#include "text/words.h"
#include "why/why_words.h"

enum { TIME_SIZE = 32, LIMIT_SIZE = 64, STOOD_US = 20000, US_PER_TENTH = 100, EXACT_TENTHS = 100 };

/* Every fault has its phrase: a fault that is added to fault_table.def needs one here. */
enum {
#define FAULT_PHRASE(fault_, phrase) PHRASE_OF_##fault_,
#include "report/fault_phrases.def"
#undef FAULT_PHRASE
    PHRASES
};
_Static_assert((int)PHRASES == AGV_FAULT_COUNT, "a fault has no phrase in fault_phrases.def");

const char *sentence_phrase(agv_fault_t fault) {
    static const char *const phrases[AGV_FAULT_COUNT] = {
#define FAULT_PHRASE(fault_, phrase) [AGV_FAULT_##fault_] = (phrase),
#include "report/fault_phrases.def"
#undef FAULT_PHRASE
    };
    return ((uint32_t)fault < AGV_FAULT_COUNT) ? phrases[fault] : "";
}

const char *sentence_missing(unsigned index) {
    static const char *const texts[] = {
        "the supervisor is not in the state for it",
        "the VCU is not alive",
        "the EPS is not alive",
        "the cause of a trip is present",
        "the vehicle does not stand",
        "the VCU does not report manual",
        "the reset button was pressed before the trip, or its signal was lost",
        "a status message is missing or late",
        "the throttle status is above idle, invalid or missing",
        "the button was held for too long",
        "the contact of the safety output does not read open",
    };
    return (index < sizeof texts / sizeof texts[0]) ? texts[index] : "";
}

uint64_t sentence_trip_us(const why_trip_t *trip) {
    const bool is_within = (trip->cause_us != WHY_NEVER) && (trip->cause_us / US_PER_MS == trip->t_us / US_PER_MS);
    return (is_within && (trip->cause_us > trip->t_us)) ? trip->cause_us : trip->t_us;
}

/** Append to a text of SENTENCE_SIZE; what does not fit is cut. */
static void say(char text[SENTENCE_SIZE], const char *format, ...) __attribute__((format(printf, 2, 3)));
static void say(char text[SENTENCE_SIZE], const char *format, ...) {
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(&text[used], SENTENCE_SIZE - used, format, arguments);
    va_end(arguments);
}

/** A time since the start: "62.109 s". */
static const char *at(uint64_t t_us, char text[TIME_SIZE]) {
    const uint64_t t_ms = t_us / US_PER_MS;
    (void)snprintf(text, TIME_SIZE, "%" PRIu64 ".%03" PRIu64 " s", t_ms / US_PER_MS, t_ms % US_PER_MS);
    return text;
}

/** A duration: "0.3 ms", "272 ms", "1.254 s". From 10 ms on it is the difference of the times as they are shown. */
static const char *lasting(uint64_t from_us, uint64_t to_us, char text[TIME_SIZE]) {
    const uint64_t tenths = (to_us - from_us) / US_PER_TENTH;
    const uint64_t ms = shown_ms(from_us, to_us);
    if (tenths < EXACT_TENTHS) {
        (void)snprintf(text, TIME_SIZE, "%" PRIu64 ".%" PRIu64 " ms", tenths / 10, tenths % 10);
    } else if (ms < MS_PER_S) {
        (void)snprintf(text, TIME_SIZE, "%" PRIu64 " ms", ms);
    } else {
        (void)snprintf(text, TIME_SIZE, "%" PRIu64 ".%03" PRIu64 " s", ms / MS_PER_S, ms % MS_PER_S);
    }
    return text;
}

/** The limit with its unit as people write it. */
static const char *limit_text(const why_trip_t *trip, char text[LIMIT_SIZE]) {
    const long long limit = (long long)trip->limit;
    if (strcmp(trip->unit, "ddeg") == 0) {
        (void)snprintf(text, LIMIT_SIZE, "%lld.%lld°", limit / 10, limit % 10);
    } else if (strcmp(trip->unit, "counts") == 0) {
        (void)snprintf(text, LIMIT_SIZE, "%lld counts (%lld.%lld %%)", limit, limit * 4 / 10, limit * 4 % 10);
    } else if ((strcmp(trip->unit, "ms") == 0) && (limit >= 1000) && (limit % 100 == 0)) {
        (void)snprintf(text, LIMIT_SIZE, "%lld.%lld s", limit / 1000, limit / 100 % 10);
    } else {
        (void)snprintf(text, LIMIT_SIZE, "%lld %s", limit, trip->unit);
    }
    return text;
}

static bool has_limit(const why_trip_t *trip) {
    return (trip->limit != WHY_NO_LIMIT) && (trip->unit != NULL);
}

/** "steering_command (065h)" */
static void say_message(char text[SENTENCE_SIZE], const why_trip_t *trip) {
    const char *name = agv_message_name(trip->message);
    if (name != NULL) {
        say(text, "%s (%03" PRIX32 "h)", name, trip->id);
    } else if (trip->id != WHY_NO_ID) {
        say(text, "%03" PRIX32 "h", trip->id);
    } else {
        say(text, "The message");
    }
}

static bool never_came(const why_trip_t *trip) {
    return (trip->kind == WHY_SILENCE) && (trip->last_good_us == WHY_NEVER) && !trip->was_heard &&
           !trip->from_earlier_run;
}

/* The phrase of every silence has these words: they fit a message that came before. */
#define NO_LONGER "no longer "

/** What failed. */
static void say_phrase(char text[SENTENCE_SIZE], const why_trip_t *trip) {
    const char *phrase = sentence_phrase(trip->reason);
    if (trip->wrong_steps) {
        say(text, "the alive counter of ");
        say_message(text, trip);
        say(text, " did not always step by 1 to 3");
    } else if (why_was_withheld(trip)) {
        say(text, "the gateway withheld ");
        say_message(text, trip);
        say(text, ", because the VCU did not report autopilot");
    } else if (trip->refused.count > 0) {
        say_message(text, trip);
        say(text, " came in a form that the protocol does not have");
    } else if (never_came(trip)) {
        const char *verb = phrase;
        while (strncmp(verb, NO_LONGER, strlen(NO_LONGER)) != 0) {
            verb++;
        }
        say(text, "%.*snever %s", (int)(verb - phrase), phrase, &verb[strlen(NO_LONGER)]);
    } else {
        say(text, "%s", phrase);
    }
}

/** A flight recorder may not know since when. */
static void say_since(char text[SENTENCE_SIZE], const why_trip_t *trip) {
    char time[TIME_SIZE];
    if (trip->cause_us != WHY_NEVER) {
        say(text, " from %s%s on", trip->from_engagement ? "the engagement at " : "", at(trip->cause_us, time));
    }
    say(text, ".");
}

static void say_silence(char text[SENTENCE_SIZE], const why_trip_t *trip) {
    const bool is_stuck = trip->kind == WHY_STUCK;
    char time[TIME_SIZE];
    char limit[LIMIT_SIZE];
    const bool never = never_came(trip);
    if (never) {
        say_message(text, trip);
        say(text, " never came.");
    } else if (trip->last_good_us == WHY_NEVER) {
        say(text, is_stuck ? "The alive counter of " : "");
        say_message(text, trip);
        say(text, " did not %s", is_stuck ? "change" : "come");
        say_since(text, trip);
    } else {
        say(text, is_stuck ? "The alive counter of " : "");
        say_message(text, trip);
        say(text, " %s for the last time at %s.",
            trip->wrong_steps        ? "stepped by 1 to 3"
            : is_stuck               ? "changed"
            : why_was_withheld(trip) ? "was passed on"
                                     : "came",
            at(trip->last_good_us, time));
    }
    if (has_limit(trip)) {
        say(text, " %s is %s.", never ? "The deadline for the first one" : "Its deadline", limit_text(trip, limit));
    }
    if (trip->next_us != WHY_NEVER) {
        say(text, " The next one came at %s.", at(trip->next_us, time));
    }
    if (trip->refused.count > 0) {
        text_t refused = {.used = 0};
        why_words_refused(&refused, trip);
        say(text, " %s.", refused.bytes);
    }
}

/** The time budget of a fault whose limit is not that time; 0: none. */
static uint16_t budget_ms(const agv_config_t *config, agv_fault_t reason) {
    switch (reason) {
    case AGV_FAULT_STEERING_DEVIATION:
        return config->steering_deviation_ms;
    case AGV_FAULT_THROTTLE_DEVIATION:
        return config->throttle_deviation_ms;
    default:
        return 0;
    }
}

static void say_limit(char text[SENTENCE_SIZE], const agv_config_t *config, const why_trip_t *trip) {
    char limit[LIMIT_SIZE];
    const uint16_t budget = budget_ms(config, trip->reason);
    const char *space = (text[0] != '\0') ? " " : "";
    say(text, "%sThe limit of this fault is %s", space, limit_text(trip, limit));
    if (budget > 0) {
        say(text, " for %u ms in all", budget);
    }
    say(text, ".");
}

static void say_cause(char text[SENTENCE_SIZE], const agv_config_t *config, const why_trip_t *trip) {
    char time[TIME_SIZE];
    if (trip->from_earlier_run) {
        say(text, "This trip was latched in an earlier run.");
        return;
    }
    if ((trip->kind == WHY_SILENCE) || (trip->kind == WHY_STUCK)) {
        say_silence(text, trip);
        return;
    }
    if (trip->cause_us != WHY_NEVER) {
        say(text, trip->from_engagement ? "The cause counted from the engagement at %s on" : "The cause began at %s",
            at(trip->cause_us, time));
        say(text, trip->at_the_latest ? " at the latest" : "");
        if ((trip->message != AGV_MSG_NONE) || (trip->id != WHY_NO_ID)) {
            say(text, ", as ");
            say_message(text, trip);
            say(text, " shows");
        }
        say(text, ".");
    }
    if (has_limit(trip)) {
        say_limit(text, config, trip);
    }
}

static void say_output(char text[SENTENCE_SIZE], const why_trip_t *trip, uint64_t opened_us) {
    char time[TIME_SIZE];
    if (opened_us == WHY_NEVER) {
        say(text, " The safety output stayed closed.");
    } else if (opened_us == 0) {
        say(text, " The safety output was open already.");
    } else if (opened_us <= trip->t_us + US_PER_MS) {
        say(text, " The safety output was opened at once.");
    } else {
        say(text, " The safety output was opened %s after the trip.", lasting(trip->t_us, opened_us, time));
    }
}

static void say_action(char text[SENTENCE_SIZE], const report_page_t *page, const why_trip_t *trip) {
    char time[TIME_SIZE];
    const bool is_shadow = page->config->shadow == AGV_SHADOW_ON;
    say(text, "The supervisor tripped at %s (%s).", at(trip->t_us, time), agv_fault_name(trip->reason));
    if (is_shadow) {
        say(text, " It sent nothing, because it runs in shadow mode.");
    } else if (trip->first_safe_us == WHY_NEVER) {
        say(text, " No safe command was sent until the end of the run.");
    } else {
        const uint64_t trip_us = sentence_trip_us(trip);
        const bool at_once = trip->first_safe_us < trip_us + (uint64_t)US_PER_TENTH;
        const bool parks = page->config->park == AGV_PARK_AT_ONCE;
        say(text, " %s%s it began to send the safe commands: %sthrottle 0, autopilot off",
            at_once ? "At once" : lasting(trip_us, trip->first_safe_us, time), at_once ? "" : " later",
            parks ? "gear P, " : "");
        if (!parks) {
            say(text, ", and gear P when the wheels stand, or %u ms after the trip", page->config->park_timeout_ms);
        }
        say(text, ".");
    }
}

static bool stood_already(const why_trip_t *trip) {
    return (trip->stopped_us != WHY_NEVER) && (trip->stopped_us < trip->t_us + STOOD_US);
}

static void say_outcome(char text[SENTENCE_SIZE], const report_page_t *page, const why_trip_t *trip) {
    char time[TIME_SIZE];
    if (page->is_recording) {
        say(text, "This is a recording: the vehicle did not receive the supervisor's commands, and what it did after "
                  "the trip "
                  "is no reaction to them.");
    }
    if (trip->confirmed_us != WHY_NEVER) {
        say(text, "%sThe VCU reported gear P and autopilot off %s after the trip.", (text[0] != '\0') ? " " : "",
            lasting(sentence_trip_us(trip), trip->confirmed_us, time));
    }
    const char *space = (text[0] != '\0') ? " " : "";
    if (stood_already(trip)) {
        say(text, "%sThe vehicle stood already.", space);
    } else if (trip->stopped_us != WHY_NEVER) {
        say(text, "%sThe wheels stood %s after the trip.", space,
            lasting(sentence_trip_us(trip), trip->stopped_us, time));
    } else if (!page->is_recording) {
        say(text, "%sNo standstill of the wheels was reported until the end of the run.", space);
    }
    const bool is_resettable = (agv_fault_flags((uint32_t)trip->reason) & AGV_FAULT_FLAG_UNRESETTABLE) == 0;
    say(text, is_resettable ? " Only the operator can end the safe state, by a reset at standstill in manual."
                            : " Only a power-on can end the safe state.");
}

void sentence_trip(sentence_t *sentence, const report_page_t *page, const why_trip_t *trip, uint64_t opened_us) {
    memset(sentence, 0, sizeof *sentence);
    const char *begin = "The supervisor stopped the vehicle";
    if (page->is_recording || (page->config->shadow == AGV_SHADOW_ON)) {
        begin = "The supervisor would have stopped this vehicle";
    } else if (stood_already(trip)) {
        begin = "The supervisor keeps the vehicle at standstill";
    } else if (trip->stopped_us != WHY_NEVER) {
        begin = "The vehicle stands";
    }
    say(sentence->headline, "%s because ", begin);
    say_phrase(sentence->headline, trip);
    say(sentence->headline, ".");
    say_cause(sentence->cause, page->config, trip);
    say_action(sentence->action, page, trip);
    say_output(sentence->action, trip, opened_us);
    say_outcome(sentence->outcome, page, trip);
}

static void say_missing(char text[SENTENCE_SIZE], const why_t *why) {
    const uint16_t missing = why_missing(why);
    const char *between = " The supervisor stayed in INIT because ";
    for (uint8_t bit = 0; bit < 16; bit++) {
        if ((missing & (1u << bit)) != 0) {
            text_t details = {.used = 0};
            why_words_missing(&details, why, bit);
            say(text, "%s%s", between, sentence_missing(bit));
            if (details.used > 0) {
                say(text, " (%s)", details.bytes);
            }
            between = "; ";
        }
    }
    say(text, (missing != 0) ? "." : "");
}

void sentence_no_trip(sentence_t *sentence, const why_t *why, uint64_t end_us) {
    const uint64_t supervised_us = why_supervised_us(why);
    char supervised[TIME_SIZE];
    char whole[TIME_SIZE];
    memset(sentence, 0, sizeof *sentence);
    if (supervised_us == 0) {
        say(sentence->headline, "Nothing was supervised: the supervisor never left INIT.");
        say(sentence->cause, "The run took %s.", at(end_us, whole));
        say_missing(sentence->cause, why);
        say(sentence->outcome, "This says nothing about the vehicle, and does not count as passed.");
        return;
    }
    say(sentence->headline, "No trip: the supervisor found no reason to stop the vehicle.");
    say(sentence->cause, "It supervised %s of %s.", at(supervised_us, supervised), at(end_us, whole));
    if (supervised_us < end_us) {
        const uint64_t init_ms = shown_ms(supervised_us, end_us);
        say(sentence->cause, " For the other %s it was in INIT.", at(init_ms * US_PER_MS, whole));
    }
    size_t in_init = 0;
    for (size_t i = 0; i < why_fault_count(why); i++) {
        in_init += why_did_not_trip(why_fault(why, i)) ? 1u : 0u;
    }
    const size_t warned = why_fault_count(why) - in_init;
    if (warned > 0) {
        say(sentence->action, "It warned of %zu fault%s.", warned, words_plural(warned));
    }
    if (in_init > 0) {
        say(sentence->action, "%s%zu fault%s occurred in INIT, where nothing trips.", (warned > 0) ? " " : "", in_init,
            words_plural(in_init));
    }
    if (!why_was_engaged(why)) {
        say(sentence->outcome, "The autopilot was never engaged: the commands of the AI computer were not judged.");
    }
}

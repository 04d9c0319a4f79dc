#include "replay/replay_text.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "agv/names.h"
#include "agv/recorder.h"
#include "common/units.h"
#include "replay/replay_hints.h"
#include "why/why_words.h"

enum { COLUMNS = 100, LABEL = 12, NOT_SUPERVISED_LABEL = 16, TRIPS_SHOWN = 8 };
enum { MANUAL_BIT = 5 };
_Static_assert((1u << MANUAL_BIT) == AGV_MISSING_MANUAL, "the bit of manual");
enum { CLOCK_SIZE = 40, DATE = 10, US_PER_10_MS = 10000, START_MS = 1000 };

/** A stamp before the year 2000 is no time of day. */
#define CLOCK_FROM_S 946684800u

/** Print "LABEL text": broken at blanks, so that no line is longer than COLUMNS. */
static void print_labelled(const char *label, int width, const char *text) {
    size_t room = (size_t)(COLUMNS - width);
    (void)printf("%-*s", width, label);
    while (strlen(text) > room) {
        size_t length = room;
        while ((length > 0u) && (text[length] != ' ')) {
            length--;
        }
        length = (length > 0u) ? length : room;
        (void)printf("%.*s\n%*s", (int)length, text, width, "");
        text = &text[length + ((text[length] == ' ') ? 1u : 0u)];
    }
    (void)printf("%s\n", text);
}

static bool has_clock(const replay_text_t *replay) {
    return replay->first_us / US_PER_S >= (uint64_t)CLOCK_FROM_S;
}

/** A time as date and time of day: "2026-11-20 10:33:06.209". @return text */
static const char *clock_text(char text[CLOCK_SIZE], uint64_t at_us) {
    const time_t seconds = (time_t)(at_us / US_PER_S);
    struct tm parts;
    text[0] = '\0';
    if (localtime_r(&seconds, &parts) != NULL) {
        const size_t used = strftime(text, CLOCK_SIZE, "%Y-%m-%d %H:%M:%S", &parts);
        (void)snprintf(&text[used], CLOCK_SIZE - used, ".%03" PRIu64, (at_us % US_PER_S) / US_PER_MS);
    }
    return text;
}

/** The time of day alone. */
static void add_time_of_day(text_t *text, const replay_text_t *replay, uint64_t t_us) {
    char clock[CLOCK_SIZE];
    if (has_clock(replay)) {
        const char *full = clock_text(clock, replay->first_us + t_us);
        text_add(text, " (%s)", (strlen(full) > (size_t)DATE) ? &full[DATE + 1] : full);
    }
}

static void print_head(const replay_text_t *replay) {
    const replay_heard_t *heard = replay->heard;
    (void)printf("%s: %" PRIu64 ".%03" PRIu64 " s on ", replay->name, replay->duration_us / US_PER_S,
                 (replay->duration_us % US_PER_S) / US_PER_MS);
    for (size_t i = 0u; i < heard->name_count; i++) {
        (void)printf("%s%s", (i > 0u) ? ", " : "", heard->names[i]);
    }
    (void)printf("%s", heard->more_names ? " and others" : "");
    if (has_clock(replay)) {
        char from[CLOCK_SIZE];
        char to[CLOCK_SIZE];
        (void)clock_text(from, replay->first_us);
        (void)clock_text(to, replay->first_us + replay->duration_us);
        const bool same_day = strncmp(from, to, DATE) == 0;
        (void)printf(", %s to %s", from, same_day ? &to[DATE + 1] : to);
    }
    (void)printf("\n");
}

static void print_hints(const replay_text_t *replay) {
    text_t text = {.used = 0u};
    for (int hint = 0; hint < (int)REPLAY_HINTS; hint++) {
        text_clear(&text);
        if (replay_hint(&text, (replay_hint_t)hint, replay->config, replay->heard)) {
            print_labelled("  hint", LABEL, text.bytes);
        }
    }
}

/** Add a condition for leaving INIT that did not hold. @param details say why: of the end of the run */
static void add_condition(text_t *text, const replay_text_t *replay, uint8_t bit, bool details) {
    text_t detail = {.used = 0u};
    text_add(text, "%s", agv_missing_name(bit));
    why_words_missing(&detail, replay->why, bit);
    if (details && (detail.used > 0u)) {
        text_add(text, " (%s)", detail.bytes);
    }
}

/** Add all that did not hold; the mode first, which is what most logs lack. */
static void add_missing(text_t *text, const replay_text_t *replay, bool details) {
    const uint32_t missing = why_missing(replay->why);
    const char *between = "";
    if ((missing & AGV_MISSING_MANUAL) != 0u) {
        add_condition(text, replay, MANUAL_BIT, details);
        between = ", ";
    }
    for (uint8_t bit = 0u; agv_missing_name(bit) != NULL; bit++) {
        if ((bit != (uint8_t)MANUAL_BIT) && (((missing >> bit) & 1u) != 0u)) {
            text_add(text, "%s", between);
            add_condition(text, replay, bit, details);
            between = ", ";
        }
    }
}

/** What was not supervised: all of it, or a beginning that is longer than a start takes. */
static void print_not_supervised(const replay_text_t *replay) {
    const bool never = why_supervised_us(replay->why) == 0u;
    const uint64_t init_us = why_state_us(replay->why, 0u);
    const uint64_t normal_us = ((uint64_t)replay->config->init_hold_ms + (uint64_t)START_MS) * US_PER_MS;
    text_t text = {.used = 0u};
    if (never) {
        text_add(&text, "never left INIT");
        if (why_missing(replay->why) == 0u) {
            text_add(&text, ": the log is too short, a start takes %u ms", (unsigned)replay->config->init_hold_ms);
        }
    } else if (init_us > normal_us) {
        why_words_time(&text, init_us);
        text_add(&text, " in INIT");
    } else {
        return;
    }
    if (why_missing(replay->why) != 0u) {
        text_add(&text, never ? ", missing: " : ", until then missing: ");
        add_missing(&text, replay, never);
    }
    print_labelled("NOT SUPERVISED: ", NOT_SUPERVISED_LABEL, text.bytes);
}

/** "12.30": seconds with two decimals. */
static void add_seconds(text_t *text, uint64_t t_us) {
    const uint64_t rounded = (t_us + (US_PER_10_MS / 2)) / US_PER_10_MS;
    text_add(text, "%" PRIu64 ".%02" PRIu64, rounded / 100u, rounded % 100u);
}

static void print_supervised(const replay_text_t *replay) {
    static const char *const names[WHY_STATES] = {"INIT", "STANDBY", "ACTIVE", "TRIPPED", "SAFE"};
    text_t text = {.used = 0u};
    add_seconds(&text, why_supervised_us(replay->why));
    text_add(&text, " s ");
    for (size_t i = 0u; i < (size_t)WHY_STATES; i++) {
        text_add(&text, "  %s ", names[i]);
        add_seconds(&text, why_state_us(replay->why, i));
    }
    print_labelled("supervised", LABEL, text.bytes);
}

/** Add what came after a trip, or that it did not come. */
static void add_then(text_t *text, const char *what, const char *never, uint64_t t_us) {
    if (t_us == WHY_NEVER) {
        text_add(text, "%s", never);
    } else {
        text_add(text, "%s ", what);
        why_words_time(text, t_us);
    }
}

static void print_trip(const replay_text_t *replay, const why_trip_t *trip, const char *label) {
    text_t text = {.used = 0u};
    text_add(&text, "at ");
    why_words_time(&text, trip->t_us);
    add_time_of_day(&text, replay, trip->t_us);
    text_add(&text, ": %s", agv_fault_name(trip->reason));
    print_labelled(label, LABEL, text.bytes);
    text_clear(&text);
    why_words_cause(&text, replay->why, trip);
    print_labelled("  why", LABEL, text.bytes);
    text_clear(&text);
    add_then(&text, "first safe frame",
             (replay->config->shadow == AGV_SHADOW_ON) ? "no safe frame (shadow)" : "no safe frame",
             trip->first_safe_us);
    text_add(&text, "; ");
    add_then(&text, "P confirmed", "P not confirmed", trip->confirmed_us);
    text_add(&text, "; ");
    add_then(&text, "stands", "does not stand", trip->stopped_us);
    if ((trip->confirmed_us == WHY_NEVER) || (trip->stopped_us == WHY_NEVER)) {
        text_add(&text, " (a recording cannot obey)");
    }
    print_labelled("  then", LABEL, text.bytes);
}

/** Whether something had begun when the log ended. */
static bool has_pending(const replay_text_t *replay) {
    bool pending = false;
    for (int fault = 0; fault < (int)AGV_FAULT_COUNT; fault++) {
        text_t text = {.used = 0u};
        pending = pending || why_words_pending(&text, replay->why, (agv_fault_t)fault);
    }
    return pending;
}

static bool is_consequence(const why_trip_t *trip) {
    return trip->kind == WHY_VEHICLE;
}

static void print_trips(const replay_text_t *replay) {
    size_t shown = 0u;
    size_t count = 0u;
    for (size_t i = 0u; i < why_trip_count(replay->why); i++) {
        const why_trip_t *trip = why_trip(replay->why, i);
        if (is_consequence(trip)) {
            continue; /* among the faults */
        }
        count++;
        if (shown < (size_t)TRIPS_SHOWN) {
            print_trip(replay, trip, (shown == 0u) ? "tripped" : "");
            shown++;
        }
    }
    if (count == 0u) {
        print_labelled("tripped", LABEL, has_pending(replay) ? "never, but see what the log ends in" : "never");
    } else if (count > shown) {
        (void)printf("%*sand %zu times more: --why FILE has them all\n", LABEL, "", count - shown);
    } else {
        /* all of them were shown */
    }
}

/** Widths of the columns. */
typedef struct {
    size_t name;
    size_t time;
    size_t times;
    size_t lasted;
} widths_t;

static void widen(size_t *width, size_t length) {
    *width = (length > *width) ? length : *width;
}

/** How often a fault was raised, in words. @return text */
static const char *times_text(text_t *text, const why_fault_t *fault) {
    text_clear(text);
    text_add(text, "%u %s", (unsigned)fault->times, (fault->times == 1u) ? "time" : "times");
    return text->bytes;
}

static const char *time_text(text_t *text, uint64_t t_us) {
    text_clear(text);
    why_words_time(text, t_us);
    return text->bytes;
}

static widths_t measure(const why_t *why) {
    widths_t widths = {0};
    text_t text;
    for (size_t i = 0u; i < why_fault_count(why); i++) {
        const why_fault_t *fault = why_fault(why, i);
        widen(&widths.name, strlen(agv_fault_name(fault->fault)));
        widen(&widths.time, strlen(time_text(&text, fault->first_us)));
        widen(&widths.times, strlen(times_text(&text, fault)));
        widen(&widths.lasted, strlen(time_text(&text, fault->active_us)));
    }
    return widths;
}

static void print_fault(const why_fault_t *fault, const widths_t *widths, bool is_first) {
    text_t time;
    text_t times;
    text_t lasted;
    text_t text = {.used = 0u};
    text_add(&text, "%-*s  %s  %*s   %-*s   %*s", (int)widths->name, agv_fault_name(fault->fault),
             agv_class_name(fault->fault_class), (int)widths->time, time_text(&time, fault->first_us),
             (int)widths->times, times_text(&times, fault), (int)widths->lasted, time_text(&lasted, fault->active_us));
    if (fault->from_recording) {
        text_add(&text, "  (a recording cannot obey)");
    } else if (fault->in_init && (fault->fault_class == AGV_CLASS_TRIP)) {
        text_add(&text, "  in INIT: no trip");
    } else if (fault->active) {
        text_add(&text, "  active at the end");
    } else {
        /* nothing more to say */
    }
    print_labelled(is_first ? "faults" : "", LABEL, text.bytes);
}

static void print_faults(const why_t *why) {
    const widths_t widths = measure(why);
    for (size_t i = 0u; i < why_fault_count(why); i++) {
        print_fault(why_fault(why, i), &widths, i == 0u);
    }
    if (why_fault_count(why) == 0u) {
        print_labelled("faults", LABEL, "none");
    }
}

/** What the log ends in: a pass of something that had begun would be a lie. */
static void print_pending(const replay_text_t *replay) {
    const char *label = "at the end";
    for (int fault = 0; fault < (int)AGV_FAULT_COUNT; fault++) {
        text_t text = {.used = 0u};
        if (why_words_pending(&text, replay->why, (agv_fault_t)fault)) {
            text_add(&text, ": the log ends first");
            print_labelled(label, LABEL, text.bytes);
            label = "";
        }
    }
}

/** What was odd about the log. */
static void print_lines(const events_summary_t *summary) {
    const agv_counters_t *counters = &summary->counters;
    uint64_t rejected = 0u;
    for (size_t i = 0u; i < (size_t)AGV_REJECTED_KINDS; i++) {
        rejected += counters->rejected[i];
    }
    if ((summary->skipped_lines == 0u) && (summary->backward_stamps == 0u) && (rejected == 0u)) {
        return;
    }
    (void)printf("%-*slines skipped: %" PRIu64 ", time stamps that went backwards: %" PRIu64
                 ", malformed frames: %" PRIu64 "\n",
                 LABEL, "log", summary->skipped_lines, summary->backward_stamps, rejected);
}

void replay_text_print(const replay_text_t *replay) {
    print_not_supervised(replay);
    print_hints(replay);
    print_head(replay);
    print_supervised(replay);
    print_trips(replay);
    print_faults(replay->why);
    print_pending(replay);
    print_lines(replay->summary);
}

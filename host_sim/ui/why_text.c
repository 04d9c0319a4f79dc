#include "ui/why_text.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "text/civil.h"
#include "text/text.h"
#include "text/units.h"
#include "text/words.h"
#include "why/why_words.h"

enum { TRIPS_SHOWN = 8, US_PER_10_MS = 10000 };

/** A stamp before the year 2000 is no time of day. */
#define CLOCK_FROM_S 946684800u

void why_text_line(const char *label, int width, const char *text) {
    (void)printf("%-*s", width, label);
    text_print_from(width, text);
}

bool why_text_has_clock(uint64_t first_us) {
    return first_us / US_PER_S >= CLOCK_FROM_S;
}

/** The time of day, with its date where that is not the one of the first frame. */
static void add_time_of_day(text_t *text, const why_text_t *shown, uint64_t t_us) {
    char first[CIVIL_LOCAL_SIZE];
    char clock[CIVIL_LOCAL_SIZE] = "";
    if (why_text_has_clock(shown->first_us)) {
        (void)civil_local(first, shown->first_us);
        (void)civil_local(clock, shown->first_us + t_us);
        const bool same_day = strncmp(first, clock, CIVIL_DATE_LENGTH) == 0;
        text_add(text, " (%s)", same_day ? &clock[CIVIL_DATE_LENGTH + 1] : clock);
    }
}

/** "12.30": seconds with two decimals. */
static void add_seconds(text_t *text, uint64_t t_us) {
    const uint64_t rounded = (t_us + (US_PER_10_MS / 2)) / US_PER_10_MS;
    text_add(text, "%" PRIu64 ".%02" PRIu64, rounded / 100, rounded % 100);
}

void why_text_supervised(const why_t *why) {
    static const char *const names[WHY_STATES] = {"INIT", "STANDBY", "ACTIVE", "TRIPPED", "SAFE"};
    text_t text = {.used = 0};
    add_seconds(&text, why_supervised_us(why));
    text_add(&text, " s ");
    for (size_t i = 0; i < WHY_STATES; i++) {
        text_add(&text, "  %s ", names[i]);
        add_seconds(&text, why_state_us(why, i));
    }
    why_text_line("supervised", WHY_TEXT_LABEL, text.bytes);
}

static void add_time(text_t *text, const char *what, uint64_t t_us) {
    text_add(text, "%s", what);
    if (t_us != WHY_NEVER) {
        why_words_time(text, t_us);
    }
}

static void print_then(const why_text_t *shown, const why_trip_t *trip) {
    text_t text = {.used = 0};
    if (!shown->is_recorder) {
        const bool none = trip->first_safe_us == WHY_NEVER;
        const bool is_shadow = why_is_shadow(shown->why);
        add_time(&text,
                 !none       ? "first safe frame "
                 : is_shadow ? "no safe frame (shadow mode)"
                             : "no safe frame",
                 trip->first_safe_us);
        text_add(&text, "; ");
    }
    const char *mark = shown->is_recorder ? "" : " (a recording cannot obey)"; /* behind the last that it explains */
    if (trip->confirmed_us == WHY_NEVER) {
        text_add(&text, "%s not confirmed%s", shown->is_recorder ? "safe state" : why_unconfirmed(trip),
                 (trip->stopped_us == WHY_NEVER) ? "" : mark);
    } else {
        add_time(&text, "P confirmed ", trip->confirmed_us);
    }
    if (shown->is_recorder) {
        /* it has no wheel speeds */
    } else if (trip->stopped_us == WHY_NEVER) {
        text_add(&text, "; wheels never at standstill%s", mark);
    } else {
        add_time(&text, "; stands ", trip->stopped_us);
    }
    why_text_line("  then", WHY_TEXT_LABEL, text.bytes);
}

static void print_trip(const why_text_t *shown, const why_trip_t *trip, const char *label) {
    text_t text = {.used = 0};
    text_add(&text, "at ");
    why_words_time(&text, trip->t_us);
    add_time_of_day(&text, shown, trip->t_us);
    text_add(&text, ": %s", agv_fault_name(trip->reason));
    why_text_line(label, WHY_TEXT_LABEL, text.bytes);
    text_clear(&text);
    why_words_cause(&text, shown->why, trip);
    why_text_line("  why", WHY_TEXT_LABEL, text.bytes);
    print_then(shown, trip);
}

static bool is_consequence(const why_trip_t *trip) {
    return trip->kind == WHY_VEHICLE;
}

void why_text_trips(const why_text_t *shown) {
    size_t printed = 0;
    size_t count = 0;
    for (size_t i = 0; i < why_trip_count(shown->why); i++) {
        const why_trip_t *trip = why_trip(shown->why, i);
        if (is_consequence(trip)) {
            continue; /* among the faults */
        }
        count++;
        if (printed < TRIPS_SHOWN) {
            print_trip(shown, trip, (printed == 0) ? "tripped" : "");
            printed++;
        }
    }
    if (count == 0) {
        why_text_line("tripped", WHY_TEXT_LABEL, shown->never);
    } else if (count > printed) {
        (void)printf("%*sand %zu time%s more: --why FILE has them all\n", WHY_TEXT_LABEL, "", count - printed,
                     words_plural(count - printed));
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
    text_add(text, "%u %s", (unsigned)fault->times, (fault->times == 1) ? "time" : "times");
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
    for (size_t i = 0; i < why_fault_count(why); i++) {
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
    text_t text = {.used = 0};
    text_add(&text, "%-*s  %s  %*s   %-*s   %*s", (int)widths->name, agv_fault_name(fault->fault),
             agv_class_name(fault->fault_class), (int)widths->time, time_text(&time, fault->first_us),
             (int)widths->times, times_text(&times, fault), (int)widths->lasted, time_text(&lasted, fault->active_us));
    if (fault->from_recording) {
        text_add(&text, "  (a recording cannot obey)");
    } else if (why_did_not_trip(fault)) {
        text_add(&text, "  in INIT: no trip");
    } else if ((fault->fault_class == AGV_CLASS_TRIP) && (fault->trip_us > fault->first_us)) {
        text_add(&text, "  a warning until ");
        why_words_time(&text, fault->trip_us);
    } else if (fault->active) {
        text_add(&text, "  active at the end");
    } else {
        /* nothing more to say */
    }
    if (fault->left_out > 0) {
        text_add(&text, "  %u more event%s left out", (unsigned)fault->left_out, words_plural(fault->left_out));
    }
    why_text_line(is_first ? "faults" : "", WHY_TEXT_LABEL, text.bytes);
}

void why_text_faults(const why_t *why) {
    const widths_t widths = measure(why);
    for (size_t i = 0; i < why_fault_count(why); i++) {
        print_fault(why_fault(why, i), &widths, i == 0);
    }
    if (why_fault_count(why) == 0) {
        why_text_line("faults", WHY_TEXT_LABEL, "none");
    }
}

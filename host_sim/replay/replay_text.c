#include "replay/replay_text.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "agv/recorder.h"
#include "replay/replay_hints.h"
#include "text/civil.h"
#include "text/text.h"
#include "text/units.h"
#include "ui/why_text.h"
#include "why/why_words.h"

enum { MANUAL_BIT = 5 };
_Static_assert((1u << MANUAL_BIT) == AGV_MISSING_MANUAL, "the bit of manual");
enum { NOT_SUPERVISED_LABEL = 16, BACK_US = 10 * US_PER_MS };

/** Whether something had begun when the log ended. */
static bool has_pending(const replay_text_t *replay) {
    bool pending = false;
    for (int fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        text_t text = {.used = 0};
        pending = pending || why_words_pending(&text, replay->why, (agv_fault_t)fault);
    }
    return pending;
}

/** Add how long the log is, its interfaces and its time of day. */
static void add_head(text_t *text, const replay_text_t *replay) {
    const replay_heard_t *heard = replay->heard;
    const uint64_t ms = shown_ms(replay->first_us, replay->first_us + replay->duration_us);
    text_add(text, "%" PRIu64 ".%03" PRIu64 " s on ", ms / MS_PER_S, ms % MS_PER_S);
    for (size_t i = 0; i < heard->name_count; i++) {
        text_add(text, "%s%s", (i > 0) ? ", " : "", heard->names[i]);
    }
    text_add(text, "%s", heard->more_names ? " and others" : "");
    if (why_text_has_clock(replay->first_us)) {
        char from[CIVIL_LOCAL_SIZE];
        char to[CIVIL_LOCAL_SIZE];
        (void)civil_local(from, replay->first_us);
        (void)civil_local(to, replay->first_us + replay->duration_us);
        const bool same_day = strncmp(from, to, CIVIL_DATE_LENGTH) == 0;
        text_add(text, ", %s to %s", from, same_day ? &to[CIVIL_DATE_LENGTH + 1] : to);
    }
}

/** The name of the log has a line of its own where the rest does not fit behind it. */
static void print_head(const replay_text_t *replay) {
    text_t text = {.used = 0};
    text_t copy;
    const char *name = text_one_line(&copy, replay->name);
    add_head(&text, replay);
    if (strlen(name) + strlen(": ") + text.used <= TEXT_COLUMNS) {
        (void)printf("%s: %s\n", name, text.bytes);
    } else {
        text_t line = {.used = 0};
        text_add(&line, "%s:", name);
        why_text_line("", 0, line.bytes);
        why_text_line("", WHY_TEXT_LABEL, text.bytes);
    }
}

static replay_clues_t clues_of(const replay_text_t *replay) {
    return (replay_clues_t){
        .config = replay->config, .heard = replay->heard, .ai_interface = replay->ai_interface, .why = replay->why};
}

/** @param has_parent a line above it says what was not supervised */
static void print_hints(const replay_text_t *replay, bool has_parent) {
    const replay_clues_t clues = clues_of(replay);
    text_t text = {.used = 0};
    for (int hint = 0; hint < REPLAY_HINTS; hint++) {
        text_clear(&text);
        if (replay_hint(&text, (replay_hint_t)hint, &clues)) {
            why_text_line(has_parent ? "  hint" : "hint", WHY_TEXT_LABEL, text.bytes);
        }
    }
}

/** Add a condition for leaving INIT that did not hold. @param details say why: of the end of the run */
static void add_condition(text_t *text, const replay_text_t *replay, uint8_t bit, bool details) {
    text_t detail = {.used = 0};
    text_add(text, "%s", agv_missing_name(bit));
    why_words_missing(&detail, replay->why, bit);
    if (details && (detail.used > 0)) {
        text_add(text, " (%s)", detail.bytes);
    }
}

/** Add all that did not hold; the mode first, which is what most logs lack. */
static void add_missing(text_t *text, const replay_text_t *replay, bool details) {
    const uint32_t missing = why_missing(replay->why);
    const char *between = "";
    if ((missing & AGV_MISSING_MANUAL) != 0) {
        add_condition(text, replay, MANUAL_BIT, details);
        between = ", ";
    }
    for (uint8_t bit = 0; agv_missing_name(bit) != NULL; bit++) {
        if ((bit != MANUAL_BIT) && (((missing >> bit) & 1) != 0)) {
            text_add(text, "%s", between);
            add_condition(text, replay, bit, details);
            between = ", ";
        }
    }
}

/** What was not supervised: all of it, or a beginning that is longer than a start takes. @return false: neither */
static bool add_not_supervised(text_t *text, const replay_text_t *replay) {
    const bool never = why_supervised_us(replay->why) == 0;
    if (!why_left_init_late(replay->why)) {
        return false;
    }
    if (never) {
        text_add(text, "never left INIT");
        if (why_missing(replay->why) == 0) {
            text_add(text, ": the log is too short, a start takes more than %u ms",
                     (unsigned)replay->config->init_hold_ms);
        }
    } else {
        why_words_time(text, why_state_us(replay->why, WHY_INIT));
        text_add(text, " in INIT");
    }
    if (why_missing(replay->why) != 0) {
        text_add(text, never ? ", missing: " : ", until then missing: ");
        add_missing(text, replay, never);
    }
    return true;
}

bool replay_text_goes_back(text_t *text, const replay_heard_t *heard) {
    if (heard->back_us < BACK_US) {
        return false;
    }
    text_add(text, "the time stamps go back by ");
    why_words_time(text, heard->back_us);
    text_add(text, " at line %" PRIu64 ": from there on, lines with an earlier time stamp get the time ",
             heard->back_line);
    why_words_time(text, heard->back_at_us);
    text_add(text, "; cut the log there, or sort it");
    return true;
}

/** @return false: there is nothing to say */
static bool print_not_supervised(const replay_text_t *replay) {
    text_t text = {.used = 0};
    const bool is_part = add_not_supervised(&text, replay);
    if (is_part) {
        why_text_line("NOT SUPERVISED: ", NOT_SUPERVISED_LABEL, text.bytes);
    }
    text_clear(&text);
    const bool goes_back = replay_text_goes_back(&text, replay->heard);
    if (goes_back) {
        why_text_line("NOT SUPERVISED: ", NOT_SUPERVISED_LABEL, text.bytes);
    }
    return is_part || goes_back;
}

/** Without an engagement nothing is known of the AI computer. */
static void print_not_judged(const replay_text_t *replay) {
    if ((why_supervised_us(replay->why) > 0) && !why_was_engaged(replay->why)) {
        why_text_line("not judged", WHY_TEXT_LABEL, "the commands of the AI computer: the autopilot was never engaged");
    }
}

/** Add what of a fault had begun when the log ended. @return false: nothing had */
static bool add_pending(text_t *text, const replay_text_t *replay, agv_fault_t fault) {
    const bool pending = why_words_pending(text, replay->why, fault);
    if (pending) {
        text_add(text, ": the log ended too early");
    }
    return pending;
}

/** What the log ends in: a pass of something that had begun would be a lie. */
static void print_pending(const replay_text_t *replay) {
    const char *label = "at the end";
    for (int fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        text_t text = {.used = 0};
        if (add_pending(&text, replay, (agv_fault_t)fault)) {
            why_text_line(label, WHY_TEXT_LABEL, text.bytes);
            label = "";
        }
    }
}

void replay_text_remarks(const replay_text_t *replay, analysis_t *analysis) {
    const replay_clues_t clues = clues_of(replay);
    text_t text = {.used = 0};
    if ((why_supervised_us(replay->why) > 0) && add_not_supervised(&text, replay)) { /* else the page says it first */
        analysis_remark(analysis, ANALYSIS_NOT_SUPERVISED, text.bytes);
    }
    text_clear(&text);
    if (replay_text_goes_back(&text, replay->heard)) {
        analysis_remark(analysis, ANALYSIS_GOES_BACK, text.bytes);
    }
    for (int fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        text_clear(&text);
        if (add_pending(&text, replay, (agv_fault_t)fault)) {
            analysis_remark(analysis, ANALYSIS_NOT_SUPERVISED, text.bytes);
        }
    }
    for (int hint = 0; hint < REPLAY_HINTS; hint++) {
        text_clear(&text);
        if (replay_hint(&text, (replay_hint_t)hint, &clues)) {
            analysis_remark(analysis, ANALYSIS_HINT, text.bytes);
        }
    }
}

/** What was odd about the log. */
static void print_lines(const events_summary_t *summary) {
    static const char *const kinds[AGV_REJECTED_KINDS] = {
        [AGV_REJECTED_LENGTH] = "messages of a wrong length",
        [AGV_REJECTED_FD] = "CAN FD frames",
        [AGV_REJECTED_REMOTE] = "remote frames",
        [AGV_REJECTED_EXTENDED] = "frames with 29-bit identifiers",
        [AGV_REJECTED_ERROR] = "error frames",
    };
    text_t text = {.used = 0};
    text_add_count(&text, "lines skipped", summary->skipped_lines);
    text_add_count(&text, "time stamps that went backwards", summary->backward_stamps);
    for (size_t i = 0; i < AGV_REJECTED_KINDS; i++) {
        text_add_count(&text, kinds[i], summary->counters.rejected[i]);
    }
    if (text.used > 0) {
        why_text_line("log", WHY_TEXT_LABEL, text.bytes);
    }
}

void replay_text_print(const replay_text_t *replay) {
    print_hints(replay, print_not_supervised(replay));
    print_head(replay);
    why_text_supervised(replay->why);
    print_not_judged(replay);
    const why_text_t shown = {
        .why = replay->why,
        .first_us = replay->first_us,
        .never = has_pending(replay) ? "never; see the line 'at the end'" : "never",
    };
    why_text_trips(&shown);
    why_text_faults(replay->why);
    print_pending(replay);
    print_lines(replay->summary);
}

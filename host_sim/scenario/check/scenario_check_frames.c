/* Judging: frames that are expected, and frames that must not be. */
#include <stdio.h>

#include "scenario/check/scenario_check.h"
#include "text/units.h"

enum { FRAME_TEXT_SIZE = 80 };

void scenario_check_frames_init(scenario_check_t *check) {
    const scenario_expect_t *expect = &check->expect;

    check->only_supervisor = true;
    for (size_t i = 0; i < expect->frames.count; i++) {
        check->ids[i] = scenario_frame_id(check->scenario, &expect->frames.items[i]);
        check->frames[i].last_ms = expect->frames.items[i].at_ms.from;
        check->only_supervisor = check->only_supervisor && (expect->frames.items[i].from == SCENARIO_FROM_SUPERVISOR);
    }
    for (size_t i = 0; i < expect->never.count; i++) {
        check->never_ids[i] = scenario_frame_id(check->scenario, &expect->never.items[i]);
        check->only_supervisor = check->only_supervisor && (expect->never.items[i].from == SCENARIO_FROM_SUPERVISOR);
    }
}

/** Whether sender, side and identifier are those that the expectation is about. */
static bool is_about(const scenario_frame_t *expected, uint32_t id, hal_can_side_t side, int from,
                     const hal_can_frame_t *frame) {
    return ((expected->from == SCENARIO_FROM_ANY) || (expected->from == from)) &&
           (expected->any_side || (expected->side == side)) && ((id == SCENARIO_NO_ID) || (id == frame->id));
}

static bool bytes_match(const scenario_frame_t *expected, const hal_can_frame_t *frame) {
    if (!expected->exact_length) {
        return true;
    }
    for (unsigned i = 0; i < AGV_DLC; i++) {
        if ((frame->data[i] & expected->mask[i]) != expected->value[i]) {
            return false;
        }
    }
    return frame->length == expected->length;
}

static const char *frame_text(const hal_can_frame_t *frame, char text[FRAME_TEXT_SIZE]) {
    int used = snprintf(text, FRAME_TEXT_SIZE, "%03Xh [", (unsigned)frame->id);
    for (unsigned i = 0; i < frame->length; i++) {
        used += snprintf(&text[used], FRAME_TEXT_SIZE - (size_t)used, "%s%02X", (i > 0) ? " " : "", frame->data[i]);
    }
    (void)snprintf(&text[used], FRAME_TEXT_SIZE - (size_t)used, "]");
    return text;
}

static const char *expected_text(const scenario_frame_t *expected, uint32_t id, char text[FRAME_TEXT_SIZE]) {
    int used = (id == SCENARIO_NO_ID) ? snprintf(text, FRAME_TEXT_SIZE, "a frame")
                                      : snprintf(text, FRAME_TEXT_SIZE, "%03Xh", (unsigned)id);
    if (!expected->exact_length) {
        return text;
    }
    used += snprintf(&text[used], FRAME_TEXT_SIZE - (size_t)used, " [");
    for (unsigned i = 0; i < expected->length; i++) {
        const char *separator = (i > 0) ? " " : "";
        used += (expected->mask[i] != 0)
                    ? snprintf(&text[used], FRAME_TEXT_SIZE - (size_t)used, "%s%02X", separator, expected->value[i])
                    : snprintf(&text[used], FRAME_TEXT_SIZE - (size_t)used, "%s..", separator);
    }
    (void)snprintf(&text[used], FRAME_TEXT_SIZE - (size_t)used, "]");
    return text;
}

/** The first frame with this identifier since first_since_ms is the one that has to match. */
static void check_first(scenario_check_t *check, size_t index, uint32_t t_ms, const hal_can_frame_t *frame) {
    const scenario_frame_t *expected = &check->expect.frames.items[index];
    scenario_frame_seen_t *seen = &check->frames[index];
    char window[SCENARIO_WINDOW_TEXT_SIZE];
    char wanted[FRAME_TEXT_SIZE];
    char got[FRAME_TEXT_SIZE];

    if (!expected->is_first || seen->first_done || (t_ms < expected->first_since_ms)) {
        return;
    }
    seen->first_done = true;
    if (!bytes_match(expected, frame) || !scenario_check_is_in(t_ms, expected->at_ms)) {
        seen->broken = true;
        scenario_check_window_text(expected->at_ms, window);
        scenario_check_fail(check, expected->line, "%s is expected as the first %s, seen: %s at %u ms",
                            expected_text(expected, check->ids[index], wanted), window, frame_text(frame, got),
                            (unsigned)t_ms);
    }
}

static bool gap_is_good(const scenario_frame_t *expected, bool is_first, uint32_t gap_ms) {
    return (expected->every_ms == 0) || ((is_first || (gap_ms + expected->jitter_ms >= expected->every_ms)) &&
                                         (gap_ms <= expected->every_ms + expected->jitter_ms));
}

static void check_frame(scenario_check_t *check, size_t index, uint32_t t_ms, const hal_can_frame_t *frame) {
    const scenario_frame_t *expected = &check->expect.frames.items[index];
    scenario_frame_seen_t *seen = &check->frames[index];
    char wanted[FRAME_TEXT_SIZE];

    check_first(check, index, t_ms, frame);
    if (!bytes_match(expected, frame)) {
        return;
    }
    if (!scenario_check_is_in(t_ms, expected->at_ms)) {
        if ((seen->count == 0) && !seen->near) {
            seen->near = t_ms > expected->at_ms.to;
            seen->nearest_ms = t_ms;
        }
        return;
    }
    const uint32_t gap_ms = t_ms - seen->last_ms;
    if ((seen->count > 0) && (gap_ms < expected->again_ms) && (seen->again < expected->again_max)) {
        seen->again++;
        return;
    }
    if (!gap_is_good(expected, seen->count == 0, gap_ms) && !seen->broken) {
        seen->broken = true;
        scenario_check_fail(check, expected->line,
                            "%s is expected every %u ms, seen: %u ms after the previous one at %u ms",
                            expected_text(expected, check->ids[index], wanted), (unsigned)expected->every_ms,
                            (unsigned)gap_ms, (unsigned)seen->last_ms);
    }
    seen->count++;
    seen->last_ms = t_ms;
}

static void check_never(scenario_check_t *check, size_t index, uint32_t t_ms, const hal_can_frame_t *frame) {
    const scenario_frame_t *never = &check->expect.never.items[index];
    char window[SCENARIO_WINDOW_TEXT_SIZE];
    char got[FRAME_TEXT_SIZE];

    if (!bytes_match(never, frame) || !scenario_check_is_in(t_ms, never->at_ms)) {
        return;
    }
    check->never_count[index]++;
    if (check->never_count[index] == 1) {
        scenario_check_window_text(never->at_ms, window);
        scenario_check_fail(check, never->line, "a frame is forbidden %s, seen: %s at %u ms", window,
                            frame_text(frame, got), (unsigned)t_ms);
    }
}

void scenario_check_frame(scenario_check_t *check, uint64_t t_us, hal_can_side_t side, int from,
                          const hal_can_frame_t *frame) {
    const scenario_expect_t *expect = &check->expect;
    const uint32_t t_ms = (uint32_t)(t_us / US_PER_MS);

    if (check->only_supervisor && (from != SCENARIO_FROM_SUPERVISOR)) {
        return;
    }
    for (size_t i = 0; i < expect->frames.count; i++) {
        if (is_about(&expect->frames.items[i], check->ids[i], side, from, frame)) {
            check_frame(check, i, t_ms, frame);
        }
    }
    for (size_t i = 0; i < expect->never.count; i++) {
        if (is_about(&expect->never.items[i], check->never_ids[i], side, from, frame)) {
            check_never(check, i, t_ms, frame);
        }
    }
}

static void finish_frame(scenario_check_t *check, size_t index) {
    const scenario_frame_t *expected = &check->expect.frames.items[index];
    const scenario_frame_seen_t *seen = &check->frames[index];
    char window[SCENARIO_WINDOW_TEXT_SIZE];
    char wanted[FRAME_TEXT_SIZE];
    char near[40] = "";

    if (seen->broken) {
        return;
    }
    scenario_check_window_text(expected->at_ms, window);
    (void)expected_text(expected, check->ids[index], wanted);
    if ((seen->count < expected->count.from) || (seen->count > expected->count.to)) {
        if ((seen->count == 0) && (seen->nearest_ms != 0)) {
            (void)snprintf(near, sizeof near, " (one at %u ms)", (unsigned)seen->nearest_ms);
        }
        if ((expected->count.to == UINT32_MAX) && (expected->count.from == 1)) {
            scenario_check_fail(check, expected->line, "%s is expected at least once %s, seen: %u%s", wanted, window,
                                (unsigned)seen->count, near);
        } else if (expected->count.to == UINT32_MAX) {
            scenario_check_fail(check, expected->line, "%s is expected at least %u times %s, seen: %u%s", wanted,
                                (unsigned)expected->count.from, window, (unsigned)seen->count, near);
        } else {
            scenario_check_fail(check, expected->line, "%s is expected %u..%u times %s, seen: %u%s", wanted,
                                (unsigned)expected->count.from, (unsigned)expected->count.to, window,
                                (unsigned)seen->count, near);
        }
    } else if ((expected->every_ms != 0) &&
               (expected->at_ms.to - seen->last_ms > expected->every_ms + expected->jitter_ms)) {
        scenario_check_fail(check, expected->line, "%s is expected every %u ms %s, the last one was at %u ms", wanted,
                            (unsigned)expected->every_ms, window, (unsigned)seen->last_ms);
    } else {
        return;
    }
}

void scenario_check_frames_finish(scenario_check_t *check) {
    for (size_t i = 0; i < check->expect.frames.count; i++) {
        finish_frame(check, i);
    }
    for (size_t i = 0; i < check->expect.never.count; i++) {
        const scenario_frame_t *never = &check->expect.never.items[i];
        char anchor[SCENARIO_ANCHOR_TEXT_SIZE];
        if (scenario_check_waits(never->at_ms)) {
            scenario_check_fail(check, never->line, "a frame is forbidden after %s, which was not seen",
                                scenario_anchor_text(never->at_ms.after, anchor));
        }
    }
}

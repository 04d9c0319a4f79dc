#include "scenario/scenario_anchor.h"

#include <stdio.h>
#include <string.h>

#include "text/words.h"

/** Note that an event was. @return whether there was room for it */
static bool note_kind(scenario_events_t *events, scenario_anchor_kind_t kind, uint64_t at_ms) {
    uint8_t *count = &events->count[kind];
    if (*count == SCENARIO_ANCHOR_NUMBER_MAX) {
        return false;
    }
    events->at_ms[kind][*count] = at_ms;
    (*count)++;
    return true;
}

bool scenario_events_note(scenario_events_t *events, const session_event_t *event) {
    const agv_event_t *recorded = &event->recorded;
    if (event->is_led) {
        return false;
    }
    if (recorded->kind == AGV_EVENT_RESET) {
        return (recorded->a != 0) && note_kind(events, SCENARIO_RESET, event->t_ms);
    }
    if (recorded->kind != AGV_EVENT_STATE) {
        return false;
    }
    switch ((agv_state_t)recorded->b) {
    case AGV_STATE_STANDBY:
        return note_kind(events, SCENARIO_STANDBY, event->t_ms);
    case AGV_STATE_ACTIVE:
        return note_kind(events, SCENARIO_ACTIVE, event->t_ms);
    case AGV_STATE_TRIPPED:
        return (recorded->a != AGV_STATE_SAFE) && note_kind(events, SCENARIO_TRIP, event->t_ms);
    case AGV_STATE_SAFE:
        return note_kind(events, SCENARIO_SAFE, event->t_ms);
    default:
        return false;
    }
}

bool scenario_events_find(const scenario_events_t *events, scenario_anchor_t anchor, uint64_t *at_ms) {
    if (anchor.kind == SCENARIO_FROM_START) {
        *at_ms = 0;
        return true;
    }
    if (anchor.number >= events->count[anchor.kind]) {
        return false;
    }
    *at_ms = events->at_ms[anchor.kind][anchor.number];
    return true;
}

bool scenario_anchor_read(const char *text, scenario_anchor_t *anchor) {
    const size_t length = strcspn(text, " ");
    const char *number = &text[length];
    for (size_t i = 0;; i++) {
        const char *word = NULL;
        const size_t word_length = words_at(SCENARIO_ANCHOR_WORDS, i, &word);
        if (word_length == 0) {
            return false;
        }
        if ((word_length == length) && (memcmp(word, text, length) == 0)) {
            anchor->kind = (uint8_t)(i + 1);
            break;
        }
    }
    if (*number == '\0') {
        anchor->number = 0;
        return true;
    }
    anchor->number = (uint8_t)(number[1] - '1');
    return (anchor->number < SCENARIO_ANCHOR_NUMBER_MAX) && (number[2] == '\0');
}

const char *scenario_anchor_text(scenario_anchor_t anchor, char text[SCENARIO_ANCHOR_TEXT_SIZE]) {
    const char *word = "start";
    size_t length = strlen(word);
    if (anchor.kind != SCENARIO_FROM_START) {
        length = words_at(SCENARIO_ANCHOR_WORDS, anchor.kind - 1u, &word);
    }
    if (anchor.number == 0) {
        (void)snprintf(text, SCENARIO_ANCHOR_TEXT_SIZE, "%.*s", (int)length, word);
    } else {
        (void)snprintf(text, SCENARIO_ANCHOR_TEXT_SIZE, "%.*s %u", (int)length, word, anchor.number + 1);
    }
    return text;
}

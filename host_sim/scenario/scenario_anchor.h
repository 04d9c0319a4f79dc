/**
 * @file scenario_anchor.h
 * What the times of a scenario count from: the start of the run, or an event of the supervisor.
 */
#ifndef HOST_SIM_SCENARIO_ANCHOR_H
#define HOST_SIM_SCENARIO_ANCHOR_H

#include <stdbool.h>
#include <stdint.h>

#include "session/session.h"

#define SCENARIO_ANCHOR_NUMBER_MAX 9u

/** Kinds of anchors. */
typedef enum {
    SCENARIO_FROM_START, /**< of the run */
    SCENARIO_STANDBY,    /**< state STANDBY */
    SCENARIO_ACTIVE,     /**< state ACTIVE */
    SCENARIO_TRIP,       /**< state TRIPPED, but not back from SAFE */
    SCENARIO_SAFE,       /**< state SAFE */
    SCENARIO_RESET,      /**< a reset that was accepted */
    SCENARIO_ANCHORS
} scenario_anchor_kind_t;

/** An anchor: `number` 0 is the first event of its kind, 1 the second. */
typedef struct {
    uint8_t kind;
    uint8_t number;
} scenario_anchor_t;

/** The events of a run so far. All zero: none. */
typedef struct {
    uint8_t count[SCENARIO_ANCHORS];
    uint64_t at_ms[SCENARIO_ANCHORS][SCENARIO_ANCHOR_NUMBER_MAX];
} scenario_events_t;

/** Note an event of the supervisor. @return whether some time may count from it */
bool scenario_events_note(scenario_events_t *events, const session_event_t *event);

/** When an anchor was. @return false: not yet */
bool scenario_events_find(const scenario_events_t *events, scenario_anchor_t anchor, uint64_t *at_ms);

/** Read "trip", "trip 2". @return false: it is no such event */
bool scenario_anchor_read(const char *text, scenario_anchor_t *anchor);

/** Room for what scenario_anchor_text() writes. */
#define SCENARIO_ANCHOR_TEXT_SIZE 16u

/** "trip", "trip 2". @return text */
const char *scenario_anchor_text(scenario_anchor_t anchor, char text[SCENARIO_ANCHOR_TEXT_SIZE]);

/** The words of the events, without their numbers: "standby|active|trip|safe|reset". */
#define SCENARIO_ANCHOR_WORDS "standby|active|trip|safe|reset"

#endif

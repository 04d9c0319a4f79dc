/**
 * @file replay_hints.h
 * What to try when a log was not supervised, or not as it was meant.
 */
#ifndef HOST_SIM_REPLAY_HINTS_H
#define HOST_SIM_REPLAY_HINTS_H

#include "agv/config.h"
#include "replay/replay_heard.h"
#include "text/text.h"
#include "why/why.h"

/** Hints, in the order in which they are printed. */
typedef enum {
    REPLAY_HINT_ID_SET,
    REPLAY_HINT_OTHER_VEHICLE,
    REPLAY_HINT_NODE,
    REPLAY_HINT_IDS,
    REPLAY_HINT_BEGIN,
    REPLAY_HINT_SIDES,
    REPLAY_HINT_INTERFACES,
    REPLAY_HINT_PAUSE,
    REPLAY_HINT_SUPERVISOR,
    REPLAY_HINTS
} replay_hint_t;

/** What the hints follow from. */
typedef struct {
    const agv_config_t *config;
    const replay_heard_t *heard;
    const char *ai_interface; /**< NULL: none */
    const why_t *why;         /**< after why_end() */
} replay_clues_t;

/** Add a hint. @return false: it does not apply */
bool replay_hint(text_t *text, replay_hint_t hint, const replay_clues_t *clues);

#endif

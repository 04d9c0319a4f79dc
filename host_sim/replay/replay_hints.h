/**
 * @file replay_hints.h
 * What to try when a log was not supervised.
 */
#ifndef HOST_SIM_REPLAY_HINTS_H
#define HOST_SIM_REPLAY_HINTS_H

#include "agv/config.h"
#include "common/text.h"
#include "replay/replay_heard.h"

/** Hints, from the surest one on. */
typedef enum { REPLAY_HINT_ID_SET, REPLAY_HINT_OTHER_VEHICLE, REPLAY_HINT_NODE, REPLAY_HINTS } replay_hint_t;

/** Add a hint. @return false: it does not apply */
bool replay_hint(text_t *text, replay_hint_t hint, const agv_config_t *config, const replay_heard_t *heard);

#endif

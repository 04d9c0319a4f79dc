/**
 * @file live_status.h
 * The status line of a supervisor that runs: one line on a terminal, rewritten in place a few times a second.
 */
#ifndef HOST_SIM_LIVE_STATUS_H
#define HOST_SIM_LIVE_STATUS_H

#include <stdint.h>

#include "session/session.h"

/** A status line. All zero: none was shown yet. */
typedef struct {
    uint64_t next_ms; /**< when it is shown again */
    int shown;        /**< characters of the last one; 0: none */
} live_status_t;

/** Show it, if it is time to and the terminal takes it. */
void live_status_show(live_status_t *status, const session_t *session, uint64_t now_ms);

/** No more is to come: a line break, if one was shown. */
void live_status_end(live_status_t *status);

#endif

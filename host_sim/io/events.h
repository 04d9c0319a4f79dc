/**
 * @file events.h
 * Events as JSON Lines: one object a line, `{"t_ms": 12345, "event": "state", ...}`.
 */
#ifndef HOST_SIM_EVENTS_H
#define HOST_SIM_EVENTS_H

#include <stdint.h>

#include "agv/counters.h"
#include "agv/faults.h"
#include "agv/state.h"
#include "io/output.h"
#include "session/session.h"

/** The values of the last line. */
typedef struct {
    uint64_t t_ms;
    agv_counters_t counters;
    uint64_t supervised_ms; /**< time outside INIT */
    uint64_t skipped_lines;
    uint64_t backward_stamps;
    agv_state_t final_state;
    agv_fault_t first_reason; /**< AGV_FAULT_NONE: not tripped */
} events_summary_t;

/** Fill in the values of a session; skipped_lines and backward_stamps are 0. */
void events_summarise(const session_t *session, events_summary_t *summary);

/** Write an event. A session_observer_fn: @p ctx is the output_t; a write that fails is remembered there. */
void events_write(void *ctx, const session_event_t *event);

/** Write the last line. */
void events_write_summary(output_t *output, const events_summary_t *summary);

#endif

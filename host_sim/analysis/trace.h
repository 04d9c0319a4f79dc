/**
 * @file trace.h
 * A run as Chrome trace events, which Perfetto (ui.perfetto.dev) and chrome://tracing show: states, safety output,
 * faults and LED code as bars, each message as a row of its frames. It is written as it comes; nothing is kept.
 *
 * All times are microseconds since the start of the run; the calls come in the order of time.
 */
#ifndef HOST_SIM_TRACE_H
#define HOST_SIM_TRACE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "hal/can.h"
#include "io/output.h"
#include "session/session.h"

/** A trace. Members are for the functions. */
typedef struct {
    output_t *output;
    agv_ids_t ids;
    uint16_t status_frame_id;
    bool has_events;
    const char *state; /* NULL: none yet */
    uint64_t state_since_us;
    bool output_closed;
    uint64_t closed_since_us;
    uint8_t active[AGV_FAULT_COUNT];
} trace_t;

/** Begin. @param output is open */
void trace_begin(trace_t *trace, output_t *output, const agv_config_t *config);

/** A frame. @param sent by the supervisor */
void trace_frame(trace_t *trace, hal_can_side_t side, const hal_can_frame_t *frame, bool sent, uint64_t t_us);

/** An event of the supervisor. */
void trace_event(trace_t *trace, const session_event_t *event);

/** The run is over. */
void trace_end(trace_t *trace, uint64_t t_us);

#endif

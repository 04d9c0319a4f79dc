/**
 * @file series.h
 * How a run went over time, for the report: what was measured and commanded, how old each message was, states, modes,
 * gears, faults and outputs. The memory is bounded, however long the run: the whole of it is kept in steps that become
 * coarser, and the frames of some seconds around each of the first trips are kept as they were.
 *
 * All times are microseconds since the start of the run; the calls come in the order of time.
 */
#ifndef HOST_SIM_SERIES_H
#define HOST_SIM_SERIES_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "agv/config.h"
#include "hal/can.h"
#include "session/session.h"

#define SERIES_DETAILS_MAX 10u      /**< trips whose surroundings are kept */
#define SERIES_BEFORE_US 8000000u   /**< how much before a trip */
#define SERIES_AFTER_US 6000000u    /**< and after it */
#define SERIES_OVERVIEW_STEPS 4096u /**< steps of the whole run, at most */
#define SERIES_CHANGES_MAX 1024u    /**< changes of one lane, at most; later ones are counted */

typedef struct series series_t;

/** A frame that is kept. */
typedef struct {
    uint64_t t_us;
    uint32_t id;
    uint8_t side;   /**< hal_can_side_t */
    uint8_t flags;  /**< HAL_CAN_* */
    uint8_t length; /**< as in hal_can_frame_t */
    bool sent;      /**< by the supervisor */
    uint8_t data[8];
} series_frame_t;

/** Begin. @param config is copied @return NULL: no memory */
series_t *series_new(const agv_config_t *config);

/** A frame was received. */
void series_frame(series_t *series, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us);

/** A frame of the supervisor was sent. */
void series_sent(series_t *series, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us);

/** An event of the supervisor: a session_observer_fn; @p ctx is the series_t. */
void series_event(void *ctx, const session_event_t *event);

/** The run is over. */
void series_end(series_t *series, uint64_t t_us);

/** When the run ended. */
uint64_t series_end_us(const series_t *series);

/** When the safety output opened for a trip, 0: it was open already. @return UINT64_MAX: it stayed closed */
uint64_t series_output_opened_us(const series_t *series, uint64_t trip_us);

/** The frames around a trip, or around what came soon after one, in the order of time. @return NULL: not kept */
const series_frame_t *series_frames(const series_t *series, uint64_t t_us, size_t *count);

/**
 * All of it as an object:
 *
 * | key | value |
 * |---|---|
 * | `end` | end of the run |
 * | `unit_us` | the unit of all times in it: 100 us |
 * | `messages` | `name`, `id`, `sender`, `cycle`, `deadline` (both ms), `heartbeat`, `command`, `heard` of each message |
 * | `lanes` | for each lane `state`, `mode`, `gear`, `gear_command`, `gear_sent`, `output`, `led`: `t` and `v`, the times of its changes (each the difference to the one before) and the values |
 * | `faults` | [time, name, class, whether it was raised] |
 * | `notes` | [time, text]: resets, and what a start lacked |
 * | `left_out` | changes for which there was no room |
 * | `overview` | the whole run: `from`, `to`, `step`, `signals`, `gaps` |
 * | `details` | the same around each trip, with its time as `trip` |
 *
 * `signals` has a line for each signal that was heard: `t`, `lo`, `hi`, as in `lanes`; `hi` is missing where it equals `lo`
 * throughout; null: the signal was lost. `gaps` has for each message the line `t`, `gap`: the time since the one before
 * (of a heartbeat: since the one before with another counter); a negative gap is that of a frame with the old counter.
 *
 * @return NULL: no memory
 */
json_t *series_json(const series_t *series);

/** Release it. Nothing for NULL. */
void series_free(series_t *series);

#endif

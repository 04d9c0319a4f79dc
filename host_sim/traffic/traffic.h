/**
 * @file traffic.h
 * Statistics of what is on a bus, for each identifier and side: how often, with which gaps, how close to its deadline,
 * how the alive counters count, which values were seen.
 *
 * All times are microseconds since the first frame of the run and never go backwards. Memory is bounded: 11 KiB for each
 * identifier that was heard, at most 2048 + 512 identifiers on a side; of further 29-bit ones only the number is known.
 */
#ifndef HOST_SIM_TRAFFIC_H
#define HOST_SIM_TRAFFIC_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "agv/config.h"
#include "common/message_facts.h"
#include "hal/can.h"
#include "traffic/counter_use.h"
#include "traffic/gaps.h"
#include "traffic/signals.h"

/** As the message of an identifier: the protocol does not know it. */
#define TRAFFIC_UNKNOWN UINT32_MAX

/** When the silence of a message counts (SUP-2, SUP-3). */
typedef enum { TRAFFIC_ALWAYS, TRAFFIC_ENGAGED } traffic_when_t;

/** The range of one signal. */
typedef struct {
    int64_t lowest; /**< as signal_value_t.scaled; of valid values */
    int64_t highest;
    uint64_t valid;     /**< frames with a valid value */
    uint64_t invalid;   /**< frames with an invalid one */
    uint64_t set;       /**< frames in which it was not 0 */
    uint64_t set_at_us; /**< the first of them */
    uint32_t words[8];  /**< of SIGNAL_CHOICE: the raw values that were seen, one bit each (0 to 255) */
} traffic_range_t;

/** What a deadline measures: gaps between the frames that restart it. */
typedef struct {
    traffic_when_t when;
    uint16_t setting; /**< AGV_SETTING_* of the deadline */
    uint32_t deadline_ms;
    gaps_t gaps;         /**< a silence that lasts until traffic_end() is in it if it is late */
    uint64_t late;       /**< gaps that were longer than the deadline */
    uint64_t late_at_us; /**< when the first of them exceeded it */
    uint64_t since_us;   /**< when the deadline was restarted last */
    bool is_running;     /**< it was restarted at least once, and nothing stopped it */
} traffic_watch_t;

/** What is known of one identifier on one side. */
typedef struct {
    hal_can_side_t side;
    uint32_t id;
    bool is_extended;
    uint32_t message; /**< AGV_MSG_*, SIGNALS_STATUS_FRAME, or TRAFFIC_UNKNOWN */
    uint64_t count;   /**< data frames */
    uint64_t first_us;
    uint64_t last_us;
    uint64_t
        malformed; /**< of a known message: frames of another length than 8 or in FD format; of any: remote frames */
    uint8_t length_min; /**< payload bytes */
    uint8_t length_max;
    uint8_t bits_ever[AGV_DLC];   /**< bits that were 1 in any frame */
    uint8_t bits_always[AGV_DLC]; /**< bits that were 1 in every frame */
    gaps_t gaps;                  /**< between its frames */
    /** @name Only of a known message, else zero @{ */
    traffic_watch_t *watch;  /**< NULL: unknown */
    counter_use_t *counter;  /**< NULL: the message has no alive counter */
    message_beat_t beat;     /**< this counter, as the supervisor follows it */
    traffic_range_t *ranges; /**< of each signal; NULL: unknown */
    /** @} */
} traffic_id_t;

/** Statistics of a run. */
typedef struct traffic traffic_t;

/** Begin. @return NULL: out of memory */
traffic_t *traffic_new(const agv_config_t *config);

/** Take a frame. Error frames are counted only. */
void traffic_frame(traffic_t *traffic, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us);

/** The supervisor was started: a gap that began before is none, as nobody listened. */
void traffic_start(traffic_t *traffic, uint64_t t_us);

/** The run is over. Call it once, after the last frame. */
void traffic_end(traffic_t *traffic, uint64_t t_us);

/** The known messages, as a JSON array; keys: docs/survey.md. The caller owns it. @return NULL: out of memory */
json_t *traffic_messages_json(const traffic_t *traffic);

/** One identifier as an object of that array; of an unknown one name, deadline and values are absent. */
json_t *traffic_id_json(const traffic_id_t *entry);

/** Free it; NULL is allowed. */
void traffic_free(traffic_t *traffic);

/** Whether a data frame with this 11-bit identifier was heard, on any side. */
bool traffic_heard(const traffic_t *traffic, uint32_t id);

/** First and last time of an 11-bit identifier, on any side. @return false: never heard */
bool traffic_times(const traffic_t *traffic, uint32_t id, uint64_t *first_us, uint64_t *last_us);

/** What is known of a message, on the side that the supervisor listens for it. @return NULL: never heard */
const traffic_id_t *traffic_message(const traffic_t *traffic, uint32_t message);

/** The identifiers in their order, 11 bits first, then 29 bits. @param index from 0 @return NULL: no more */
const traffic_id_t *traffic_at(const traffic_t *traffic, size_t index);

/** Frames that have no statistics of their own. */
typedef struct {
    uint64_t data;        /**< data frames in all */
    uint64_t error;       /**< error frames */
    uint64_t uncounted;   /**< data frames of 29-bit identifiers for which there was no room */
    uint64_t engagements; /**< times that autopilot mode began */
    uint64_t engaged_us;  /**< time in autopilot mode */
    uint64_t end_us;      /**< time of traffic_end() */
} traffic_totals_t;

/** The totals. */
traffic_totals_t traffic_totals(const traffic_t *traffic);

#endif

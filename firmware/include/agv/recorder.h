/**
 * @file recorder.h
 * The flight recorder (INT-3): a ring of the last 256 events, each with a snapshot of the last frames, and the last 8
 * trips, which nothing but a later trip replaces. It is the one source of events: logs, `--events` of host_sim and a
 * target's shell print what was recorded here. One fault is recorded at most 4 times a second.
 *
 * The struct belongs in RAM that outlives a reset. Each event has its own checksum, so a torn write loses that one only.
 */
#ifndef AGV_RECORDER_H
#define AGV_RECORDER_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/faults.h"
#include "agv/protocol.h"

/** Events that are kept. A power of two. */
#define AGV_RECORDER_EVENTS 256u

/** Trips that are kept. */
#define AGV_RECORDER_TRIPS 8u

/** How often one fault is recorded in a second. */
#define AGV_RECORDER_FAULTS_PER_S 4u

/** What happened. */
typedef enum {
    AGV_EVENT_STATE = 1,  /**< a = state before (0: the run starts here), b = state, c = fault or AGV_FAULT_NONE */
    AGV_EVENT_FAULT = 2,  /**< a = fault, b = class, c = 1: raised, 0: ended */
    AGV_EVENT_OUTPUT = 3, /**< a = 1: safety output closed, 0: opened */
    AGV_EVENT_RESET = 4,  /**< a = 1: accepted, 0: refused; missing = AGV_MISSING_* */
    AGV_EVENT_STARTUP = 5 /**< missing = AGV_MISSING_*: what keeps INIT from being left */
} agv_event_kind_t;

/** What may be missing for a reset or for leaving INIT: words of the events `reset` and `startup` (names.h). */
#define AGV_MISSING_STATE 0x01u         /**< not in SAFE */
#define AGV_MISSING_VCU_HEARTBEAT 0x02u /**< VCU not alive */
#define AGV_MISSING_EPS_HEARTBEAT 0x04u /**< EPS not alive */
#define AGV_MISSING_TRIP_CAUSE 0x08u    /**< a trip cause is active */
#define AGV_MISSING_STANDSTILL 0x10u
#define AGV_MISSING_MANUAL 0x20u    /**< manual is not reported */
#define AGV_MISSING_BUTTON 0x40u    /**< the press began before the trip, or there is none */
#define AGV_MISSING_MESSAGES 0x80u  /**< a trip-class status message is not fresh */
#define AGV_MISSING_THROTTLE 0x100u /**< 050h is above idle */
#define AGV_MISSING_RELEASED 0x200u /**< the button was held for longer than reset_hold_max_ms */
#define AGV_MISSING_ALL 0x3FFu

/** What the supervisor says of an event. */
typedef struct {
    uint8_t kind; /**< agv_event_kind_t */
    uint8_t a;
    uint8_t b;
    uint8_t c;
    uint16_t missing;     /**< AGV_MISSING_* bits */
    uint8_t state;        /**< agv_state_t at that moment */
    uint8_t first_reason; /**< agv_fault_t, AGV_FAULT_NONE when not tripped */
} agv_entry_t;

/** One event as it is kept. */
typedef struct {
    uint32_t sequence; /**< counts events over all runs; wraps */
    uint32_t time_ms;  /**< the supervisor's clock */
    uint8_t kind;      /**< from here on as in agv_entry_t */
    uint8_t a;
    uint8_t b;
    uint8_t c;
    uint16_t missing;
    uint8_t state;
    uint8_t first_reason;
    uint16_t left_out;                      /**< a fault: how many of its events were left out before this one */
    uint16_t seen;                          /**< bit n: message n was received in this run */
    uint8_t frames[AGV_MSG_COUNT][AGV_DLC]; /**< last payload of each message */
    uint8_t run;                            /**< counts starts of the supervisor; wraps */
    uint8_t reserved;                       /**< 0 */
    uint16_t checksum;                      /**< upper half of the inverted CRC-32 over the fields before it */
} agv_event_t;

/** How often one fault was recorded lately. */
typedef struct {
    uint32_t recorded_ms[AGV_RECORDER_FAULTS_PER_S]; /**< its last events */
    uint16_t left_out;                               /**< events left out since the last one recorded */
    uint8_t count;                                   /**< how many of recorded_ms are filled */
    uint8_t oldest;
} agv_fault_rate_t;

/** The recorder. Contents are for the functions below only. */
typedef struct {
    uint32_t next_sequence;
    uint32_t stored_sequence; /**< events before this one are in flash */
    uint16_t seen;
    uint8_t run;
    uint8_t frames[AGV_MSG_COUNT][AGV_DLC];
    agv_fault_rate_t rates[AGV_FAULT_COUNT];
    agv_event_t trips[AGV_RECORDER_TRIPS]; /**< the events of the last trips, by the order of their sequence numbers */
    agv_event_t events[AGV_RECORDER_EVENTS];
} agv_recorder_t;

/**
 * Start a run: keeps the valid events of earlier runs and goes on counting after the newest of them; whatever is not
 * valid (a power-on, a torn write) is dropped.
 */
void agv_recorder_start(agv_recorder_t *recorder);

/** Keep the payload of a message for the snapshots. Ignored for AGV_MSG_NONE. */
void agv_recorder_frame(agv_recorder_t *recorder, uint32_t message, const uint8_t data[AGV_DLC]);

/**
 * Record an event with a snapshot of the last frames. When the ring is full the oldest event is replaced. A fault that was
 * recorded four times within the last second is left out and counted.
 */
void agv_recorder_add(agv_recorder_t *recorder, const agv_entry_t *entry, uint32_t time_ms);

/** The sequence number that the next event will get: compare it to see whether something was recorded. */
uint32_t agv_recorder_next_sequence(const agv_recorder_t *recorder);

/**
 * Read an event by its sequence number.
 * @return false when it was replaced already, was never there, or its checksum is wrong.
 */
bool agv_recorder_get(const agv_recorder_t *recorder, uint32_t sequence, agv_event_t *event);

/**
 * Read one of the last trips: an event of the kind AGV_EVENT_STATE whose new state is TRIPPED.
 * @param index 0 = the latest
 * @return false when there is no such trip, or its checksum is wrong.
 */
bool agv_recorder_get_trip(const agv_recorder_t *recorder, uint32_t index, agv_event_t *event);

/** The oldest valid event that is not in flash yet; NULL when there is none. */
const agv_event_t *agv_recorder_next_to_store(agv_recorder_t *recorder);

/** That event is in flash now. */
void agv_recorder_stored(agv_recorder_t *recorder);

#endif

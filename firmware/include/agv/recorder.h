/**
 * @file recorder.h
 * The flight recorder (INT-3): a ring buffer of the last 256 events, each with a snapshot of the last frames, and the last
 * 8 trips, which only later trips replace. The shell of a target prints what is recorded here; `--events` of host_sim
 * also prints the changes of faults that the recorder leaves out. A fault is recorded at most 4 times per second.
 *
 * Place the struct in RAM that keeps its content over a reset. Each event has its own checksum: an interrupted write
 * loses only that event.
 */
#ifndef AGV_RECORDER_H
#define AGV_RECORDER_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/faults.h"
#include "agv/protocol.h"

/** Number of events kept (INT-3): a power of two, at least 16. A build for a part with little RAM defines a smaller one. */
#ifndef AGV_RECORDER_EVENTS
#define AGV_RECORDER_EVENTS 256u
#endif

/** Number of trips kept (INT-3). */
#define AGV_RECORDER_TRIPS 8u

/** Maximum number of events per second of the same fault (INT-3). */
#define AGV_RECORDER_FAULTS_PER_S 4u

/** Kind of an event, and the meaning of its fields. */
typedef enum {
    AGV_EVENT_STATE = 1,   /**< a = state before (0: the run starts), b = state, c = fault or AGV_FAULT_NONE */
    AGV_EVENT_FAULT = 2,   /**< a = fault, b = class, c = 1: raised, 0: ended; missing: parts (SELF_TEST_FAILED) */
    AGV_EVENT_OUTPUT = 3,  /**< a = 1: safety output closed, 0: opened */
    AGV_EVENT_RESET = 4,   /**< a = 1: accepted, 0: refused; missing = AGV_MISSING_* */
    AGV_EVENT_STARTUP = 5, /**< missing = AGV_MISSING_*: the conditions for leaving INIT that do not hold */
    AGV_EVENT_CRASH = 6    /**< how the port ended the previous run: a = hal_reset_cause_t, b = hal_end_t;
                              frames[0] = program counter and link register, 4 bytes each, lowest byte first */
} agv_event_kind_t;

/** Missing conditions of a reset, or of leaving INIT, in the events `reset` and `startup`. Their names: names.h. */
#define AGV_MISSING_STATE 0x01u         /**< the state is not SAFE */
#define AGV_MISSING_VCU_HEARTBEAT 0x02u /**< the VCU is not alive */
#define AGV_MISSING_EPS_HEARTBEAT 0x04u /**< the EPS is not alive */
#define AGV_MISSING_TRIP_CAUSE 0x08u /**< a fault of class trip is active; at a reset, one not from the AI computer */
#define AGV_MISSING_STANDSTILL 0x10u /**< the vehicle is not at standstill */
#define AGV_MISSING_MANUAL 0x20u     /**< 363h does not report manual */
#define AGV_MISSING_BUTTON 0x40u    /**< the press had no rising edge after the trip, or the button's signal was lost */
#define AGV_MISSING_MESSAGES 0x80u  /**< a status message whose silence trips is not fresh */
#define AGV_MISSING_THROTTLE 0x100u /**< 050h is above idle; at a reset also invalid or silent */
#define AGV_MISSING_RELEASED 0x200u /**< the button was held for longer than reset_hold_max_ms */
#define AGV_MISSING_OUTPUT 0x400u   /**< the contact of the safety output does not read open (HW-1) */
#define AGV_MISSING_ALL 0x7FFu      /**< all of these bits */

/** An event as the supervisor passes it to the recorder. */
typedef struct {
    uint8_t kind; /**< agv_event_kind_t */
    uint8_t a;
    uint8_t b;
    uint8_t c;
    uint16_t missing;     /**< AGV_MISSING_* bits, or HAL_SELF_TEST_* */
    uint8_t state;        /**< agv_state_t at that time */
    uint8_t first_reason; /**< agv_fault_t; AGV_FAULT_NONE when not tripped */
} agv_entry_t;

/** An event as the recorder keeps it. */
typedef struct {
    uint32_t sequence; /**< number of the event, over all runs; wraps */
    uint32_t time_ms;  /**< time of the supervisor, ms */
    uint8_t kind;      /**< this field to first_reason: as in agv_entry_t */
    uint8_t a;
    uint8_t b;
    uint8_t c;
    uint16_t missing;
    uint8_t state;
    uint8_t first_reason;
    uint16_t left_out;                      /**< AGV_EVENT_FAULT: events of this fault not recorded before this one */
    uint16_t seen;                          /**< bit n: message n was received in this run */
    uint8_t frames[AGV_MSG_COUNT][AGV_DLC]; /**< last payload of each message */
    uint8_t run;                            /**< number of the start of the supervisor; wraps */
    uint8_t reserved;                       /**< 0 */
    uint16_t checksum;                      /**< upper half of the inverted CRC-32 over the fields before it */
} agv_event_t;

/** Rate limit of the events of one fault. */
typedef struct {
    uint32_t recorded_ms[AGV_RECORDER_FAULTS_PER_S]; /**< times of its last recorded events */
    uint16_t left_out;                               /**< events not recorded since the last recorded one */
    uint8_t count;                                   /**< number of entries of recorded_ms in use */
    uint8_t oldest;                                  /**< index of the oldest entry of recorded_ms */
} agv_fault_rate_t;

/** The recorder. Use the functions below to access it. */
typedef struct {
    uint32_t next_sequence;
    uint32_t stored_sequence; /**< events before this number were given to the log in flash, or replaced */
    uint16_t seen;
    uint8_t run;
    uint8_t next_trip; /**< index of the trip that is replaced next */
    uint8_t frames[AGV_MSG_COUNT][AGV_DLC];
    agv_fault_rate_t rates[AGV_FAULT_COUNT];
    agv_event_t trips[AGV_RECORDER_TRIPS]; /**< events of the last trips; their order is that of `sequence` */
    agv_event_t events[AGV_RECORDER_EVENTS];
} agv_recorder_t;

/**
 * Start a run. Keeps the valid events of earlier runs and continues their sequence numbers. Drops events that are not
 * valid (after a power-on or an interrupted write).
 */
void agv_recorder_start(agv_recorder_t *recorder);

/** Note the payload of a message for later snapshots. Ignored for AGV_MSG_NONE. */
void agv_recorder_frame(agv_recorder_t *recorder, uint32_t message, const uint8_t data[AGV_DLC]);

/**
 * Record an event with a snapshot of the last frames. It replaces the oldest one when the buffer is full. An event of a
 * fault that was recorded four times within the last second is only counted. @p entry must have one of the kinds above.
 */
void agv_recorder_add(agv_recorder_t *recorder, const agv_entry_t *entry, uint32_t time_ms);

/** Record an AGV_EVENT_CRASH. Its frames[0] is @p addresses; its other frames and `seen` are 0. */
void agv_recorder_add_crash(agv_recorder_t *recorder, const agv_entry_t *entry, const uint8_t addresses[AGV_DLC],
                            uint32_t time_ms);

/** Whether an event, read from flash for example, is one that a recorder made: its checksum is right. */
bool agv_event_is_valid(const agv_event_t *event);

/** The sequence number of the next event. It changes when an event is recorded. */
uint32_t agv_recorder_next_sequence(const agv_recorder_t *recorder);

/**
 * Read an event by its sequence number.
 * @return false if the event is not in the buffer (replaced, or never recorded), or its checksum is wrong; then @p event is unchanged
 */
bool agv_recorder_get(const agv_recorder_t *recorder, uint32_t sequence, agv_event_t *event);

/**
 * Read one of the last trips: a change to TRIPPED that names a fault. A start that continues the trip of the previous
 * run does not count. Trips with a wrong checksum are not counted.
 * @param index 0 = the latest
 * @return false if there is no such trip; then @p event is unchanged
 */
bool agv_recorder_get_trip(const agv_recorder_t *recorder, uint32_t index, agv_event_t *event);

/**
 * The oldest valid event that was not given to the log in flash yet; NULL if there is none. A call looks at AGV_RECORDER_EVENTS
 * numbers at most. Where a lost ring left a longer gap, it may return NULL, and the next call goes on from there.
 */
const agv_event_t *agv_recorder_next_to_store(agv_recorder_t *recorder);

/**
 * Note that the event of agv_recorder_next_to_store was given to the log in flash, also when the log refused it. Call it only after
 * that function returned an event.
 */
void agv_recorder_stored(agv_recorder_t *recorder);

#endif

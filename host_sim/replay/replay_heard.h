/**
 * @file replay_heard.h
 * What a log has: identifiers, interfaces, and how its time stamps go.
 */
#ifndef HOST_SIM_REPLAY_HEARD_H
#define HOST_SIM_REPLAY_HEARD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "agv/faults.h"
#include "agv/protocol.h"
#include "agv/state.h"
#include "logs/candump_line.h"

#define REPLAY_INTERFACES_MAX 8u

/** What a supervisor on the recorded bus sent. Times are since the start. */
typedef struct {
    uint32_t status_id;   /**< of its status frame (TOP-3); 0: none. Set by the caller */
    uint32_t lights_id;   /**< of turn_signal_command, which commands autopilot off. Set by the caller */
    agv_state_t state;    /**< of the last status frame; 0: none was heard */
    uint64_t state_us;    /**< when it came */
    bool is_off;          /**< the last turn_signal_command has autopilot off */
    uint64_t off_us;      /**< the first one that does, of several in a row */
    bool began_tripped;   /**< the first status frame reported a trip, from before the log */
    agv_fault_t reason;   /**< of the first trip */
    uint64_t trip_us;     /**< when the status frame reported it; 0: never */
    uint64_t commands_us; /**< when the safe commands began, before that */
} replay_recorded_t;

/** All zero: nothing yet. */
typedef struct {
    replay_recorded_t recorded;
    char names[REPLAY_INTERFACES_MAX][CANDUMP_INTERFACE_MAX + 1];
    size_t name_count;
    bool more_names; /**< than have room */
    size_t last_name;
    uint64_t last_us;            /**< of the last frame, since the start */
    uint8_t ids[AGV_ID_MAX + 1]; /**< bit n: a classic data frame with this 11-bit identifier was heard on names[n] */
    bool extended;               /**< a data frame with a 29-bit identifier was heard */
    bool fd;                     /**< a CAN FD frame was heard */
    uint64_t pause_us;           /**< the longest time without any frame */
    uint64_t pause_at_us;        /**< when it began, since the start */
    uint64_t back_us;            /**< how far the time stamps go back at most; 0: they never do */
    uint64_t back_at_us;         /**< the time since the start that stands still then */
    uint64_t back_line;          /**< the line of the log where they do */
} replay_heard_t;

/** Note a frame of the log. @param t_us its time since the start */
void replay_heard_add(replay_heard_t *heard, const candump_record_t *record, uint64_t t_us);

/** Note a frame of the vehicle side: whether a supervisor was there, and tripped. */
void replay_heard_recorded(replay_recorded_t *recorded, const hal_can_frame_t *frame, uint64_t t_us);

/** The stamp of a frame goes back by @p back_us. @param line of the log @param t_us time since the start until then */
void replay_heard_back(replay_heard_t *heard, uint64_t back_us, uint64_t line, uint64_t t_us);

#endif

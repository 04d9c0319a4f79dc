/**
 * @file replay_heard.h
 * What a log has: identifiers, interfaces, and how its time stamps go.
 */
#ifndef HOST_SIM_REPLAY_HEARD_H
#define HOST_SIM_REPLAY_HEARD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "agv/protocol.h"
#include "logs/candump_line.h"

#define REPLAY_INTERFACES_MAX 8u

/** All zero: nothing yet. */
typedef struct {
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

/** The stamp of a frame goes back by @p back_us. @param line of the log @param t_us time since the start until then */
void replay_heard_back(replay_heard_t *heard, uint64_t back_us, uint64_t line, uint64_t t_us);

#endif

/**
 * @file replay_heard.h
 * Which identifiers and interfaces a log has.
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
    char names[REPLAY_INTERFACES_MAX][CANDUMP_INTERFACE_MAX + 1u];
    size_t name_count;
    bool more_names; /**< than have room */
    size_t last_name;
    uint8_t ids[AGV_ID_MAX + 1u]; /**< 1: a data frame with this 11-bit identifier was heard */
    bool extended;                /**< one with a 29-bit identifier was heard */
} replay_heard_t;

/** Note a line of the log. */
void replay_heard_add(replay_heard_t *heard, const candump_record_t *record);

#endif

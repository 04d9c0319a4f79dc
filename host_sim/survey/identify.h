/**
 * @file identify.h
 * Which unknown identifiers carry the messages that were not heard: for vehicles that use other identifiers.
 *
 * An identifier is assigned only where its length, its reserved bits, its values, its cycle and its alive counter fit one
 * message, and no other identifier fits that message. All others are candidates, for a person to decide.
 */
#ifndef HOST_SIM_IDENTIFY_H
#define HOST_SIM_IDENTIFY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "traffic/traffic.h"

#define IDENTIFY_CANDIDATES_MAX 8u

/** Frames of an identifier that are needed to judge it. */
#define IDENTIFY_FRAMES_MIN 50u

/** What a message that was not heard may have for an identifier. */
typedef struct {
    bool is_missing;  /**< the message was not heard */
    bool is_assigned; /**< candidates[0] is its identifier */
    size_t count;     /**< of candidates */
    uint32_t candidates[IDENTIFY_CANDIDATES_MAX];
} identify_message_t;

/** All messages. */
typedef struct {
    identify_message_t of[AGV_MSG_COUNT];
} identify_t;

/** Look through the identifiers of a run. */
void identify(const traffic_t *traffic, identify_t *result);

/** Number of assigned identifiers. */
size_t identify_assigned(const identify_t *result);

#endif

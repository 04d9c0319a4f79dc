/**
 * @file identify.h
 * Which identifiers carry the messages that were not received: for vehicles that use other identifiers.
 *
 * A wrong identifier of a command is worse than none. So one is proposed only where something decides for it
 * (criteria.h), nothing refuses it, no other identifier could carry that message, and it could carry no other one. All
 * others are candidates, with what speaks for and against them, for a person to decide.
 */
#ifndef HOST_SIM_IDENTIFY_H
#define HOST_SIM_IDENTIFY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "survey/identify/criteria.h"

#define IDENTIFY_CANDIDATES_MAX 8u

/** An identifier that may carry a message. */
typedef struct {
    uint32_t id;
    const evidence_id_t *heard; /**< valid as long as the evidence */
    size_t count;               /**< of criteria */
    criterion_t criteria[CRITERIA_MAX];
} candidate_t;

/** What a message that was not heard may have for an identifier. */
typedef struct {
    bool is_missing;                                 /**< the message was not heard */
    bool is_contradicted;                            /**< something was heard at its identifier that cannot be it */
    bool is_assigned;                                /**< candidates[0] is its identifier */
    uint32_t contradicted_id;                        /**< that identifier */
    size_t count;                                    /**< of candidates */
    size_t left_out;                                 /**< further ones, against which more speaks */
    candidate_t candidates[IDENTIFY_CANDIDATES_MAX]; /**< the best one first */
} identify_message_t;

/** All messages. Some 100 KiB: not for the stack. */
typedef struct {
    identify_message_t of[AGV_MSG_COUNT];
} identify_t;

/** Look through the identifiers of a run. */
void identify(const traffic_t *traffic, const evidence_t *evidence, const agv_config_t *config, identify_t *result);

/** Number of assigned identifiers. */
size_t identify_assigned(const identify_t *result);

/** The words of a candidate's criteria that speak for it, or against it: "a; b". @return text */
const char *identify_words(const candidate_t *candidate, bool is_for, char *text, size_t size);

#endif

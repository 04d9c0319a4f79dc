/**
 * @file compare.h
 * How the values of two identifiers go together: a command and the status that follows it.
 *
 * They are compared 10 times a second, or 5000 times in a long log, in autopilot mode alone where that is known: in manual mode nothing follows.
 */
#ifndef HOST_SIM_COMPARE_H
#define HOST_SIM_COMPARE_H

#include "survey/identify/evidence.h"

/** What is compared, and how. */
typedef struct {
    const track_t *first;  /**< the command */
    const track_t *second; /**< the status */
    const track_t *mode;   /**< FIELD_MODE of the vehicle; NULL: at all times */
    int32_t tolerance;     /**< up to which two values are equal */
    bool is_unsigned;      /**< the sign does not count: forward and backward */
} compare_t;

/** What came out. */
typedef struct {
    uint64_t samples;
    double equal;    /**< part of the time in which they were equal, 0 to 1 */
    double together; /**< square of their correlation, 0 to 1; 0: one was constant, or they go in opposite directions */
    int64_t ranges[2]; /**< highest less lowest value in that time */
} agreement_t;

/** Compare. The second one may be late by up to 0.5 s; the best agreement counts. */
agreement_t compare_values(const compare_t *compare);

/** How often each of the two was the first to change, after 0.5 s without a change. */
typedef struct {
    uint32_t together; /**< changes of both in the same direction, within 2 s */
    uint32_t
        first_leads; /**< of them: the second one still had its old value in a frame after the first one's new value */
    uint32_t second_leads; /**< the other way round */
} order_t;

/** Look at the changes. */
order_t compare_order(const compare_t *compare);

/** How an identifier behaved while another one was silent. */
typedef struct {
    uint32_t shared;  /**< silences that both began and ended together */
    uint32_t opposed; /**< silences in which it came as ever */
} silences_t;

/** Compare the silences of a reference. @param witness must not be silent then, or the whole bus was */
silences_t compare_silences(const evidence_id_t *heard, const evidence_id_t *reference, const evidence_id_t *witness);

#endif

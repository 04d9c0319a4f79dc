/**
 * @file sentence.h
 * What the report says first, in words: what failed, what the supervisor did, and why the vehicle stands.
 */
#ifndef HOST_SIM_SENTENCE_H
#define HOST_SIM_SENTENCE_H

#include <stdint.h>

#include "report/report_page.h"
#include "why/why.h"

#define SENTENCE_SIZE 1024u

/** The words. "" where there is nothing to say. */
typedef struct {
    char headline[SENTENCE_SIZE]; /**< one sentence */
    char cause[SENTENCE_SIZE];    /**< how it was noticed */
    char action[SENTENCE_SIZE];   /**< what the supervisor did */
    char outcome[SENTENCE_SIZE];  /**< why the vehicle stands, or does not */
} sentence_t;

/** What a fault means: completes "The vehicle stands because ...". "" for AGV_FAULT_NONE and values above. */
const char *sentence_phrase(agv_fault_t fault);

/**
 * When a trip came, as exactly as it is known: events come in whole milliseconds, and a frame that trips at once is the
 * cause in that millisecond.
 */
uint64_t sentence_trip_us(const why_trip_t *trip);

/** About a trip. @param opened_us when the safety output opened; WHY_NEVER: it stayed closed; 0: it was open */
void sentence_trip(sentence_t *sentence, const report_page_t *page, const why_trip_t *trip, uint64_t opened_us);

/** About a run without a trip. @param end_us its duration */
void sentence_no_trip(sentence_t *sentence, const why_t *why, uint64_t end_us);

/** What a missing condition means: "manual" is "the VCU does not report manual". @param index bit of AGV_MISSING_* */
const char *sentence_missing(unsigned index);

#endif

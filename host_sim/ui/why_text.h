/**
 * @file why_text.h
 * What was found about a run, for people: lines with a label, within 100 columns, on standard output.
 */
#ifndef HOST_SIM_WHY_TEXT_H
#define HOST_SIM_WHY_TEXT_H

#include <stdbool.h>
#include <stdint.h>

#include "why/why.h"

enum { WHY_TEXT_LABEL = 12 };

/** What is printed. */
typedef struct {
    const why_t *why;
    uint64_t first_us; /**< time of day of the start, us since 1970; 0: there is none */
    const char *never; /**< what stands in the place of the trips when there is none: "never" */
    bool is_recorder;  /**< from a flight recorder, which keeps no sent frame */
} why_text_t;

/** Print a label and a text, broken at blanks, so that no line is longer than 100 columns. @param width of the label */
void why_text_line(const char *label, int width, const char *text);

/** Whether a stamp is a time of day: not before the year 2000. */
bool why_text_has_clock(uint64_t first_us);

/** Print how long it was supervised, and in which states. */
void why_text_supervised(const why_t *why);

/** Print the trips, each with its cause and what followed. */
void why_text_trips(const why_text_t *shown);

/** Print the faults: first time, how often, how long. */
void why_text_faults(const why_t *why);

#endif

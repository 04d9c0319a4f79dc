/**
 * @file proposal.h
 * The configuration that would fit what was surveyed, each setting with its reason.
 *
 * A deadline is relaxed only for a sender that is slower as a rule: to three of its cycles (the median gap), and to 1.5
 * times its usual longest gap where that is no more than three cycles. The usual longest gap is the longest one without
 * the ten longest, or without the longest one in a thousand if these are more, so that no outage relaxes a deadline. It is never above the highest value of its setting (INT-2), and
 * never tighter than the default. No class of a fault is ever changed.
 */
#ifndef HOST_SIM_PROPOSAL_H
#define HOST_SIM_PROPOSAL_H

#include <jansson.h>
#include <stddef.h>

#include "agv/config.h"
#include "survey/identify/identify.h"
#include "traffic/traffic.h"

#define PROPOSAL_REASON_SIZE 480u
#define PROPOSAL_NOTES_MAX 96u

/** Gaps that are needed to judge a sender. */
#define PROPOSAL_GAPS_MIN 100u

/** Steps of an alive counter that are needed to ask for `increments`. */
#define PROPOSAL_STEPS_MIN 1000u

/** A proposal. Some 100 KiB: not for the stack. */
typedef struct {
    agv_config_t config;
    char reasons[AGV_SETTING_COUNT][PROPOSAL_REASON_SIZE]; /**< "": keeps its default */
    size_t judged; /**< messages that came often enough to judge their deadline */
    size_t note_count;
    char notes[PROPOSAL_NOTES_MAX]
              [PROPOSAL_REASON_SIZE]; /**< what must not be relaxed, and what a person has to decide */
} proposal_t;

/**
 * Make it.
 * @param config what the traffic was surveyed with
 * @param id_set_reason NULL: the identifiers are as the user said; else why that set was chosen
 */
void proposal_make(proposal_t *proposal, const traffic_t *traffic, const agv_config_t *config, const identify_t *found,
                   const char *id_set_reason);

/** Add a note. */
void proposal_note(proposal_t *proposal, const char *text);

/** Print it as a configuration file. @param source what it is made from; @return the text, to be freed; NULL: no memory */
char *proposal_yaml(const proposal_t *proposal, const char *source);

/** As JSON: {"settings": [{"name", "value", "default", "weakens", "reason"}], "notes": [text]}. */
json_t *proposal_json(const proposal_t *proposal);

#endif

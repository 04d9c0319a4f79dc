/**
 * @file replay_text.h
 * What a replay found, for people: within 100 columns, and what was not supervised first.
 */
#ifndef HOST_SIM_REPLAY_TEXT_H
#define HOST_SIM_REPLAY_TEXT_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "analysis/analysis.h"
#include "io/events.h"
#include "replay/replay_heard.h"
#include "text/text.h"
#include "why/why.h"

/** What is printed. */
typedef struct {
    const char *name;     /**< of the log */
    uint64_t first_us;    /**< stamp of the first frame */
    uint64_t duration_us; /**< until the end of the run */
    const agv_config_t *config;
    const replay_heard_t *heard;
    const char *ai_interface; /**< NULL: none */
    const why_t *why;
    const events_summary_t *summary;
} replay_text_t;

/** Add what is wrong with a log in which the time goes back by 10 ms or more. @return false: it does not */
bool replay_text_goes_back(text_t *text, const replay_heard_t *heard);

/** Hand the page what its reader must know besides: what was not supervised, and the hints. */
void replay_text_remarks(const replay_text_t *replay, analysis_t *analysis);

/** Print it on standard output. */
void replay_text_print(const replay_text_t *replay);

#endif

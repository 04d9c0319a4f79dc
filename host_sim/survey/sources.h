/**
 * @file sources.h
 * Where a survey's frames come from: a log, or interfaces in real time.
 */
#ifndef HOST_SIM_SOURCES_H
#define HOST_SIM_SOURCES_H

#include "survey/observation.h"
#include "survey/survey.h"

#define SOURCE_GONE "%s: the interface no longer exists"

/** What a source says about itself. */
typedef struct {
    char name[256];         /**< for messages: "my.log", "can0" */
    char format[32];        /**< of a log: "candump -l" */
    uint64_t skipped_lines; /**< of a log */
    bool has_ai_side;       /**< a frame came from it */
    const char *gone;       /**< the interface that ceased to exist, which ended the survey; NULL: none */
} source_t;

/** Read a log into an observation that has begun. @return false: was reported */
bool source_log(const survey_request_t *request, observation_t *observation, source_t *source);

/** Listen on interfaces until the time is over or a signal comes. @return false: was reported */
bool source_live(const survey_request_t *request, observation_t *observation, source_t *source);

#endif

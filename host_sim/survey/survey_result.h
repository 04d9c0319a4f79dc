/**
 * @file survey_result.h
 * What a survey came to, and its two forms: text for people and JSON.
 */
#ifndef HOST_SIM_SURVEY_RESULT_H
#define HOST_SIM_SURVEY_RESULT_H

#include "io/output.h"
#include "survey/identify/identify.h"
#include "survey/observation.h"
#include "survey/proposal.h"
#include "survey/sources.h"

/** All of it. */
typedef struct {
    const survey_request_t *request;
    observation_t observation;
    source_t source;
    const traffic_t *traffic; /**< under the ID set that was heard */
    agv_config_t config;      /**< that of `traffic` */
    identify_t found;
    proposal_t proposal;
    output_t config_file; /**< opened before the survey begins */
    bool is_unread;       /**< identifiers are proposed, and the messages that they carry could not be surveyed again */
} survey_result_t;

/** Print it for people on standard output, the configuration last. @param yaml the proposal as a file */
void survey_print(const survey_result_t *result, const char *yaml);

/** Print it as JSON on standard output. @return false: was reported */
bool survey_print_json(const survey_result_t *result);

#endif

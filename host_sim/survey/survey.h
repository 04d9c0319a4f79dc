/**
 * @file survey.h
 * What is on a bus: from a log, or heard on interfaces for some time. Nothing is sent.
 */
#ifndef HOST_SIM_SURVEY_H
#define HOST_SIM_SURVEY_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "cli/interface_options.h"
#include "common/report.h"

/** What to survey. */
typedef struct {
    const char *log;          /**< "-" = standard input; NULL: the interfaces */
    const char *ai_interface; /**< of the log: the AI side; NULL on the shared bus */
    interface_options_t bus;  /**< without a log */
    const char *config_out;   /**< the proposed configuration; NULL: none */
    uint64_t bit_rate;        /**< bit/s */
    bool is_json;
    bool skip_bad_lines;
    bool id_set_is_given; /**< the other ID set is counted, not proposed */
    agv_config_t config;
} survey_request_t;

/** Survey, and print the result. @return STATUS_OK, or STATUS_UNUSABLE, which was reported */
status_t survey_run(const survey_request_t *request);

#endif

#include "survey/survey.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/interrupt.h"
#include "io/output.h"
#include "logs/log_sides.h"
#include "survey/survey_result.h"

enum { REASON_SIZE = 160 };

/** Gather frames under a configuration. @return false: was reported */
static bool gather(survey_result_t *result, const agv_config_t *config) {
    observation_free(&result->observation);
    (void)memset(&result->source, 0, sizeof result->source);
    if (!observation_begin(&result->observation, config)) {
        return false;
    }
    return (result->request->log != NULL) ? source_log(result->request, &result->observation, &result->source)
                                          : source_live(result->request, &result->observation, &result->source);
}

/** Choose the ID set, and look which messages other identifiers carry. */
static void choose(survey_result_t *result) {
    const unsigned set =
        result->request->id_set_is_given ? OBSERVATION_GIVEN : observation_heard_set(&result->observation);
    result->traffic = result->observation.sets[set];
    result->config = result->observation.configs[set];
    identify(result->traffic, result->observation.evidence, &result->config, &result->found);
}

/** Whether the log can be read once more. */
static bool is_readable_again(const survey_request_t *request) {
    struct stat status;
    return (request->log != NULL) && (strcmp(request->log, "-") != 0) && (stat(request->log, &status) == 0) &&
           S_ISREG(status.st_mode);
}

/** Take the identifiers that were assigned into a configuration. @return false: two messages would share one */
static bool renumber(const survey_result_t *result, agv_config_t *config) {
    for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
        const identify_message_t *found = &result->found.of[message];
        if (found->is_assigned) {
            (void)agv_config_set(config, (uint32_t)AGV_SETTING_ID + message, (uint16_t)found->candidates[0].id);
        }
    }
    return agv_config_check(config).problem == AGV_CONFIG_OK;
}

/** Survey once more with the identifiers that were found, so that the messages that they carry are known. */
static bool survey_renumbered(survey_result_t *result) {
    agv_config_t config = result->config;
    if ((identify_assigned(&result->found) == 0) || !renumber(result, &config)) {
        return true;
    }
    if (!is_readable_again(result->request)) {
        result->is_unread = true;
        return true;
    }
    if (!gather(result, &config)) {
        return false;
    }
    result->traffic = result->observation.sets[OBSERVATION_GIVEN];
    result->config = config;
    return true;
}

static void propose(survey_result_t *result) {
    const bool is_other = result->config.id_set != result->request->config.id_set;
    const bool is_table = result->config.id_set == AGV_ID_SET_TABLE;
    char reason[REASON_SIZE];
    text_t back;
    (void)snprintf(reason, sizeof reason, "%s were received, %s were not, or less often",
                   is_table ? "201h and 203h" : "43Fh and 363h", is_table ? "43Fh and 363h" : "201h and 203h");
    proposal_make(&result->proposal, result->traffic, &result->config, &result->found, is_other ? reason : NULL);
    if (observation_goes_back(&result->observation, &back)) {
        proposal_note(&result->proposal, back.bytes);
    }
}

/** Before anything is heard: a survey of an hour is not lost because its file cannot be written. */
static bool open_config(survey_result_t *result) {
    const char *path = result->request->config_out;
    return (path == NULL) || output_open(&result->config_file, path);
}

static bool write_config(survey_result_t *result, const char *yaml) {
    if (!result->config_file.is_open) {
        return true;
    }
    (void)output_write(&result->config_file, yaml, strlen(yaml));
    const bool good = output_commit(&result->config_file);
    interrupt_release();
    return good;
}

static bool print(survey_result_t *result) {
    char *yaml = proposal_yaml(&result->proposal, result->source.name);
    if (yaml == NULL) {
        return report("out of memory");
    }
    bool good = write_config(result, yaml);
    if (result->request->is_json) {
        good = survey_print_json(result) && good;
    } else if (!output_is_stdout(result->request->config_out)) {
        survey_print(result, yaml); /* also when its file could not be written: a bus is not heard twice */
    }
    free(yaml);
    return good;
}

static bool check_ai_side(const survey_result_t *result) {
    char names[OBSERVATION_NAMES_SIZE];
    observation_interfaces(&result->observation, names);
    return log_sides_check_heard(result->request->ai_interface, result->source.has_ai_side, names);
}

static bool run_passes(survey_result_t *result) {
    const survey_request_t *request = result->request;
    if (!open_config(result) || !gather(result, &request->config)) {
        return false;
    }
    if ((request->log != NULL) && !check_ai_side(result)) {
        return false;
    }
    choose(result);
    if (!survey_renumbered(result)) {
        return false;
    }
    propose(result);
    const bool is_printed = print(result);
    return ((result->source.gone == NULL) || report(SOURCE_GONE, result->source.gone)) && is_printed;
}

status_t survey_run(const survey_request_t *request) {
    survey_result_t *result = calloc(1, sizeof *result);
    if (result == NULL) {
        (void)report("out of memory");
        return STATUS_UNUSABLE;
    }
    result->request = request;
    const bool good = run_passes(result);
    output_discard(&result->config_file);
    observation_free(&result->observation);
    free(result);
    interrupt_release();
    return good ? STATUS_OK : STATUS_UNUSABLE;
}

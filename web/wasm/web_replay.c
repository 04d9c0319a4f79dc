/* The replay of a log that was dropped on the page. */
#include <stdio.h>
#include <string.h>

#include "config/config_file.h"
#include "io/yaml_file.h"
#include "memory_output.h"
#include "replay/replay.h"
#include "replay/replay_text.h"
#include "web_run.h"
#include "web_sim.h"

/** The interfaces of the log: names, each with its line end. */
static char interfaces[REPLAY_INTERFACES_MAX * (CANDUMP_INTERFACE_MAX + 2u) + 1u];

/** Instead of the text on a terminal. */
void replay_text_print(const replay_text_t *replay) {
    char *at = interfaces;
    for (size_t i = 0u; i < replay->heard->name_count; i++) {
        at = stpcpy(at, replay->heard->names[i]);
        at = stpcpy(at, "\n");
    }
}

const char *web_interfaces(void) {
    return interfaces;
}

/** Which topology a log is of, its AI side says, whatever the settings say. */
static bool read_settings(const char *text, agv_config_t *config, bool is_gateway) {
    yaml_document_t document;
    config_lines_t lines = {.path = "settings"};
    bool good = true;
    agv_config_defaults(config);
    if (text[0] != '\0') {
        good = yaml_text_load(lines.path, text, &document);
        if (!good) {
            return false;
        }
        const yaml_node_t *root = yaml_document_get_root_node(&document);
        good = (root == NULL) || config_read_mapping(&document, root, config, &lines);
        yaml_document_delete(&document);
    }
    config->topology = is_gateway ? AGV_TOPOLOGY_GATEWAY : AGV_TOPOLOGY_SHARED;
    return good && config_check(config, &lines);
}

const char *web_replay(const char *name, const char *settings, const char *ai_interface) {
    replay_request_t request = {
        .log = name, .analysis = {.paths = {[ANALYSIS_REPORT] = WEB_REPORT}}, .reset_cause = HAL_RESET_POWER_ON};
    interfaces[0] = '\0';
    request.ai_interface = (ai_interface[0] != '\0') ? ai_interface : NULL;
    if (!read_settings(settings, &request.config, request.ai_interface != NULL) ||
        (replay_run(&request) == STATUS_UNUSABLE)) {
        return NULL;
    }
    (void)fflush(stdout);
    return memory_output_text(WEB_REPORT);
}

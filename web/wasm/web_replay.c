/* The replay of a log that was dropped on the page. */
#include <stdio.h>
#include <string.h>

#include "config/config_file.h"
#include "io/yaml_file.h"
#include "memory_output.h"
#include "replay/replay.h"
#include "web_run.h"
#include "web_sim.h"

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
    if (is_gateway) {
        config->topology = AGV_TOPOLOGY_GATEWAY;
    }
    return good && config_check(config, &lines);
}

const char *web_replay(const char *name, const char *settings, const char *ai_interface) {
    replay_request_t request = {
        .log = name, .analysis = {[ANALYSIS_REPORT] = WEB_REPORT}, .reset_cause = HAL_RESET_POWER_ON};
    request.ai_interface = (ai_interface[0] != '\0') ? ai_interface : NULL;
    if (!read_settings(settings, &request.config, request.ai_interface != NULL) ||
        (replay_run(&request) == STATUS_UNUSABLE)) {
        return NULL;
    }
    (void)fflush(stdout);
    return memory_output_text(WEB_REPORT);
}

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "config/config_text.h"
#include "survey/proposal.h"
#include "text/text.h"

enum { COLUMNS = 100 };

/** A sentence as lines of comments of at most 100 columns. */
static void print_comment(FILE *file, const char *first, const char *text) {
    size_t used = (size_t)fprintf(file, "#%s", first);
    for (const char *at = text; *at != '\0';) {
        const size_t length = strcspn(at, " ");
        if ((used + 1 + length > COLUMNS) && (used > 1)) {
            used = (size_t)fprintf(file, "\n#%*s", (int)strlen(first), "") - 1;
        }
        used += (size_t)fprintf(file, " %.*s", (int)length, at);
        at += length;
        at += (*at == ' ') ? 1 : 0;
    }
    (void)fputc('\n', file);
}

static void print_setting(FILE *file, const proposal_t *proposal, uint16_t setting) {
    const agv_setting_info_t *info = agv_setting_info(setting);
    char value[CONFIG_VALUE_SIZE];
    char preset[CONFIG_VALUE_SIZE];
    config_value_text(info, agv_config_get(&proposal->config, setting), value);
    config_value_text(info, info->preset, preset);
    (void)fputc('\n', file);
    print_comment(file, "", proposal->reasons[setting]);
    (void)fprintf(file, "%s: %s  # default %s%s\n", info->name, value, preset,
                  agv_config_weakens(&proposal->config, setting) ? ", WEAKER" : "");
}

static size_t print_settings(FILE *file, const proposal_t *proposal) {
    size_t count = 0;
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        if (proposal->reasons[i][0] != '\0') {
            print_setting(file, proposal, i);
            count++;
        }
    }
    return count;
}

static void print_all(FILE *file, const proposal_t *proposal, const char *source) {
    text_t name; /* in YAML a comment, too, has to be UTF-8, and some characters end it */
    print_comment(file, " Proposed by host_sim survey from", text_one_line(&name, source));
    print_comment(file, "", "Settings that are not here keep their defaults; host_sim config prints them all.");
    if (print_settings(file, proposal) == 0) {
        (void)fputc('\n', file);
        print_comment(file, "",
                      (proposal->judged == 0) ? "No message of the protocol came often enough to evaluate the defaults."
                      : (proposal->note_count > 0)
                          ? "No setting needs another value, but the findings below must be explained first."
                          : "The defaults fit.");
    }
    if (proposal->note_count > 0) {
        (void)fputc('\n', file);
        print_comment(file, "", "Findings that change no setting. Find the cause of each:");
    }
    for (size_t i = 0; i < proposal->note_count; i++) {
        print_comment(file, " -", proposal->notes[i]);
    }
    (void)fputc('\n', file);
    print_comment(file, "",
                  "The class of a fault that has \"-\" in the column \"may be\" of docs/faults.md cannot be changed "
                  "(INT-2).");
}

char *proposal_yaml(const proposal_t *proposal, const char *source) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    if (file == NULL) {
        return NULL;
    }
    print_all(file, proposal, source);
    const bool failed = ferror(file) != 0;
    if ((fclose(file) != 0) || failed) {
        free(text);
        return NULL;
    }
    return text;
}

static json_t *setting_json(const proposal_t *proposal, uint16_t setting) {
    const agv_setting_info_t *info = agv_setting_info(setting);
    const uint16_t value = agv_config_get(&proposal->config, setting);
    char text[CONFIG_VALUE_SIZE];
    char preset[CONFIG_VALUE_SIZE];
    config_value_text(info, value, text);
    config_value_text(info, info->preset, preset);
    json_t *object = json_object();
    (void)json_object_set_new(object, "name", json_string(info->name));
    (void)json_object_set_new(object, "value", (info->words == NULL) ? json_integer(value) : json_string(text));
    (void)json_object_set_new(object, "default",
                              (info->words == NULL) ? json_integer(info->preset) : json_string(preset));
    (void)json_object_set_new(object, "weakens", json_boolean(agv_config_weakens(&proposal->config, setting)));
    (void)json_object_set_new(object, "reason", json_string(proposal->reasons[setting]));
    return object;
}

json_t *proposal_json(const proposal_t *proposal) {
    json_t *settings = json_array();
    json_t *notes = json_array();
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        if (proposal->reasons[i][0] != '\0') {
            (void)json_array_append_new(settings, setting_json(proposal, i));
        }
    }
    for (size_t i = 0; i < proposal->note_count; i++) {
        (void)json_array_append_new(notes, json_string(proposal->notes[i]));
    }
    json_t *object = json_object();
    (void)json_object_set_new(object, "settings", settings);
    (void)json_object_set_new(object, "notes", notes);
    return object;
}

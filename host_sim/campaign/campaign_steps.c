#include "campaign/campaign_steps.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "agv/protocol.h"
#include "config/config_file.h"

void campaign_settings(text_t *text, const campaign_row_t *row) {
    if (row->fault == AGV_FAULT_CONFIG_INVALID) {
        text_add(text, "  own_heartbeat: frozen\n");
    }
    if ((row->flags & CAMPAIGN_AS_TRIP) != 0) {
        char key[CONFIG_CLASS_KEY_SIZE];
        config_class_key(row->fault, key);
        text_add(text, "  %s: trip\n", key);
    }
}

uint32_t campaign_alternatives(const campaign_row_t *row) {
    uint32_t count = 1;
    for (const char *at = row->steps; *at != '\0'; at++) {
        count += (*at == '/') ? 1 : 0;
    }
    return count;
}

/** What a placeholder stands for. */
static void format_value(char letter, const campaign_values_t *values, char *text, size_t size) {
    if (letter == 'n') {
        (void)snprintf(text, size, "%" PRIu32, values->number);
    } else if (letter == 's') {
        (void)snprintf(text, size, "%s", values->gateway ? "ai" : "vehicle");
    } else { /* $o: 43Fh as the other set has it */
        (void)snprintf(text, size, "%03Xh",
                       (unsigned)agv_message_id(AGV_MSG_TURN_SIGNAL_COMMAND,
                                                values->table_ids ? AGV_ID_SET_HEADING : AGV_ID_SET_TABLE));
    }
}

/** One step, with its placeholders filled in. @return where it ends */
static const char *fill_in(const char *at, const campaign_values_t *values, char words[CAMPAIGN_WORDS_SIZE]) {
    size_t used = 0;

    for (; (strchr("|/", *at) == NULL) && (used + 1 < CAMPAIGN_WORDS_SIZE); at++) {
        if (*at != '$') {
            words[used] = *at;
            used++;
        } else {
            at++;
            format_value(*at, values, &words[used], CAMPAIGN_WORDS_SIZE - used);
            used += strlen(&words[used]);
        }
    }
    words[used] = '\0';
    return at;
}

size_t campaign_steps(const campaign_row_t *row, uint32_t alternative, uint32_t from_ms,
                      const campaign_values_t *values, campaign_step_t *steps) {
    const char *at = row->steps;
    size_t count = 0;

    for (; alternative > 0; alternative--) {
        at = strchr(at, '/') + 1;
    }
    while ((*at != '\0') && (*at != '/') && (count < CAMPAIGN_STEPS_MAX)) {
        steps[count].at_ms = from_ms;
        if (*at == '+') {
            char *end = NULL;
            steps[count].at_ms += (uint32_t)strtoul(at + 1, &end, 10);
            at = end + 1;
        }
        at = fill_in(at, values, steps[count].words);
        at += (*at == '|') ? 1 : 0;
        count++;
    }
    return count;
}

#include "atlas/atlas_scenario.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "agv/names.h"
#include "campaign/campaign_steps.h"

enum {
    DRIVE_MS = 1000,
    ENGAGE_MS = 1500,
    FLAP_MS = 2000,
    FLAP_END_MS = 2400,
    TRIP_MS = 3000,
    LATE_AI_MS = 800,
    AFTERWARDS_MS = 7000, /* VEHICLE_NOT_STOPPING takes 5 s */
    DRIVE_STEPS_MAX = 4,
    HEX = 16
};

static const uint32_t FIRST_MS[ATLAS_STATES] = {
    [ATLAS_INIT] = 200, [ATLAS_STANDBY] = 3000, [ATLAS_ACTIVE] = 3000, [ATLAS_TRIPPED] = 3400, [ATLAS_SAFE] = 8000};

uint32_t atlas_first_ms(atlas_state_t state) {
    return FIRST_MS[state];
}

/** The steps of the drive and of both faults, in the order of time. */
typedef struct {
    campaign_step_t steps[DRIVE_STEPS_MAX + 2 * CAMPAIGN_STEPS_MAX];
    size_t count;
} steps_t;

/** "vcu: set, field: alarms, value: 10h": where the value begins, in a field whose bits are alarms; NULL: no such step. */
static char *alarm_bits(char *words) {
    static const char *const fields[] = {"vcu: set, field: alarms, value: ", "eps: set, field: faults, value: "};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        if (strncmp(words, fields[i], strlen(fields[i])) == 0) {
            return words + strlen(fields[i]);
        }
    }
    return NULL;
}

/** Alarms of an earlier step stay set. */
static void keep_alarms(steps_t *all, campaign_step_t *step) {
    char *bits = alarm_bits(step->words);
    for (size_t i = 0; (bits != NULL) && (i < all->count); i++) {
        const char *earlier = alarm_bits(all->steps[i].words);
        if ((earlier != NULL) && (strncmp(step->words, all->steps[i].words, (size_t)(bits - step->words)) == 0)) {
            (void)snprintf(bits, CAMPAIGN_WORDS_SIZE - (size_t)(bits - step->words), "%02lXh",
                           strtoul(bits, NULL, HEX) | strtoul(earlier, NULL, HEX));
        }
    }
}

static void add_sorted(steps_t *all, const campaign_step_t *step) {
    size_t at = all->count;
    while ((at > 0) && (all->steps[at - 1].at_ms > step->at_ms)) {
        all->steps[at] = all->steps[at - 1];
        at--;
    }
    all->steps[at] = *step;
    all->count++;
}

static void add_row(steps_t *all, const campaign_row_t *row, uint32_t from_ms, bool gateway) {
    const campaign_values_t values = {.number = (row->lowest + row->highest) / 2, .gateway = gateway};
    campaign_step_t steps[CAMPAIGN_STEPS_MAX];
    const size_t count = ((row->flags & CAMPAIGN_START) != 0) ? 0 : campaign_steps(row, 0, from_ms, &values, steps);

    for (size_t i = 0; i < count; i++) {
        keep_alarms(all, &steps[i]);
        add_sorted(all, &steps[i]);
    }
}

/** Lines at the top level of both rows; parts of the board are one list. */
static void add_top(text_t *text, const atlas_case_t *pair) {
    const char *const tops[] = {(pair->first != NULL) ? pair->first->top : "",
                                (pair->second != NULL) ? pair->second->top : ""};
    static const char board[] = "board: [";
    const bool boards =
        (strncmp(tops[0], board, sizeof board - 1) == 0) && (strncmp(tops[1], board, sizeof board - 1) == 0);

    if (boards) {
        text_add(text, "%.*s, %s", (int)strcspn(tops[0], "]"), tops[0], tops[1] + sizeof board - 1);
        return;
    }
    text_add(text, "%s%s", tops[0], (strcmp(tops[0], tops[1]) == 0) ? "" : tops[1]);
}

static bool is_of(const atlas_case_t *pair, agv_fault_t fault) {
    return ((pair->first != NULL) && (pair->first->fault == fault)) ||
           ((pair->second != NULL) && (pair->second->fault == fault));
}

/** Outside ACTIVE a lost AI computer warns by default. */
static bool trips_in_manual(const atlas_case_t *pair) {
    return (pair->state != ATLAS_ACTIVE) &&
           (is_of(pair, AGV_FAULT_AI_HEARTBEAT_LOST) || is_of(pair, AGV_FAULT_AI_HEARTBEAT_STUCK));
}

static void add_config(text_t *text, const atlas_case_t *pair) {
    text_add(text, "config:\n  park: %s\n", (pair->state == ATLAS_TRIPPED) ? "at_standstill" : "at_once");
    if (trips_in_manual(pair)) {
        text_add(text, "  ai_lost_in_manual: trip\n");
    }
    if (pair->first != NULL) {
        campaign_settings(text, pair->first);
    }
    if (pair->second != NULL) {
        campaign_settings(text, pair->second);
    }
}

/** On the shared bus: no collisions with the AI computer in INIT. */
static bool starts_late(const atlas_case_t *pair, const campaign_row_t *row) {
    return !pair->gateway && (row != NULL) && ((row->flags & CAMPAIGN_LATE_AI) != 0);
}

static void add_step(steps_t *all, uint32_t at_ms, const char *words) {
    campaign_step_t step = {.at_ms = at_ms};
    (void)snprintf(step.words, sizeof step.words, "%s", words);
    add_sorted(all, &step);
}

/** The vehicle drives, or has tripped, before the first fault comes; in INIT afterwards. */
static void add_drive(steps_t *all, atlas_state_t state) {
    add_step(all, DRIVE_MS, "ai: drive, gear: D, throttle_pct: 20, steer_deg: 5");
    if ((state == ATLAS_STANDBY) || (state == ATLAS_INIT)) {
        add_step(all, ENGAGE_MS, "operator: drive, gear: D, throttle_pct: 20");
    } else {
        add_step(all, ENGAGE_MS, "operator: engage");
    }
    if ((state == ATLAS_TRIPPED) || (state == ATLAS_SAFE)) {
        add_step(all, TRIP_MS, "ai: mute, message: steering_command");
    }
}

/** MODE_FLAPPING is the fourth engagement: in STANDBY there was none before. */
static void add_engagement(steps_t *all, const atlas_case_t *pair) {
    if ((pair->state == ATLAS_STANDBY) && is_of(pair, AGV_FAULT_MODE_FLAPPING)) {
        add_step(all, FLAP_MS, "operator: engage");
        add_step(all, FLAP_END_MS, "operator: disengage");
    }
}

static void add_steps(text_t *text, const atlas_case_t *pair) {
    const uint32_t first_ms = FIRST_MS[pair->state];
    steps_t all = {.count = 0};

    add_drive(&all, pair->state);
    add_engagement(&all, pair);
    if (pair->first != NULL) {
        add_row(&all, pair->first, first_ms, pair->gateway);
    }
    if (pair->second != NULL) {
        add_row(&all, pair->second, first_ms + ATLAS_DISTANCE_MS[pair->distance], pair->gateway);
    }
    text_add(text, "steps:\n");
    for (size_t i = 0; i < all.count; i++) {
        text_add(text, "  - {at_ms: %" PRIu32 ", %s}\n", all.steps[i].at_ms, all.steps[i].words);
    }
}

static const char *name_of(const campaign_row_t *row) {
    return (row != NULL) ? agv_fault_name(row->fault) : "nothing";
}

void atlas_scenario_write(text_t *text, const atlas_case_t *pair) {
    text_add(text, "name: %s, %s, then %s after %" PRIu32 " ms\n", atlas_state_name(pair->state), name_of(pair->first),
             name_of(pair->second), ATLAS_DISTANCE_MS[pair->distance]);
    text_add(text, "shows: [%s]\n", name_of((pair->first != NULL) ? pair->first : pair->second));
    text_add(text, "topology: %s\n", pair->gateway ? "gateway" : "shared");
    add_top(text, pair);
    add_config(text, pair);
    text_add(text, "vehicle:\n  ai_starts_ms: %d\n",
             (starts_late(pair, pair->first) || starts_late(pair, pair->second)) ? LATE_AI_MS : 0);
    text_add(text, "duration_ms: %" PRIu32 "\n",
             FIRST_MS[pair->state] + ATLAS_DISTANCE_MS[ATLAS_DISTANCES - 1] + (uint32_t)AFTERWARDS_MS);
    add_steps(text, pair);
}

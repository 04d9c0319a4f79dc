/* The file: what stands above its expectations. */
#include <inttypes.h>
#include <string.h>

#include "agv/names.h"
#include "config/config_file.h"
#include "config/config_text.h"
#include "skeleton/skeleton_plan.h"
#include "text/units.h"
#include "why/why_words.h"

enum { NAME_SHOWN_MAX = 40, DRIVE_BEFORE_MS = 100, PERMILLE_PER_PCT = 10, DDEG_PER_DEG = 10 };

/** The name of the log without its folder, as it may stand in a comment and in quotes. */
static void add_log_name(text_t *text, const char *path) {
    const char *slash = strrchr(path, '/');
    const char *name = (slash != NULL) ? &slash[1] : path;
    for (size_t i = 0; (name[i] != '\0') && (i < NAME_SHOWN_MAX); i++) {
        const char letter = name[i];
        const bool is_plain = (letter >= ' ') && (letter <= '~') && (letter != '"') && (letter != '\\');
        text_add(text, "%c", is_plain ? letter : '?');
    }
}

static void add_head(text_t *text, const skeleton_plan_t *plan) {
    const skeleton_facts_t *facts = plan->facts;
    const char *reason = agv_fault_name(facts->trip.reason);

    text_add(text, "# Made by host_sim scenario --from ");
    add_log_name(text, facts->request->log);
    text_add(text,
             ". The simulated vehicle replaces the vehicle of the log, and the\n"
             "# expectations are what the supervisor did. Before you keep the file, calculate every time yourself.\n"
             "name: \"");
    add_log_name(text, facts->request->log);
    text_add(text, ": %s\"\nshows: [%s]\ndescription: |\n  The log: tripped at ", reason, reason);
    why_words_time(text, facts->trip.t_us);
    text_add(text, ", %s.\n  %s.\n", reason, facts->why.bytes);
    if (facts->more > 0) {
        text_add(text, "  It has %zu more trip%s not shown here.\n", facts->more,
                 (facts->more == 1) ? ", which is" : "s, which are");
    }
    if (plan->is_shorter) {
        text_add(text, "  The log is longer: the time before the fault was cut.\n");
    }
}

/** The settings that are not the default, and where the messages are. */
static void add_settings(text_t *text, const agv_config_t *config) {
    bool any = false;
    text_add(text, "topology: %s\nid_set: %s\n", (config->topology == AGV_TOPOLOGY_GATEWAY) ? "gateway" : "shared",
             (config->id_set == AGV_ID_SET_TABLE) ? "table" : "heading");
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        const agv_setting_info_t *info = agv_setting_info(i);
        char value[CONFIG_VALUE_SIZE];
        if ((agv_config_get(config, i) != info->preset) && (strcmp(info->name, "topology") != 0) &&
            (strcmp(info->name, "id_set") != 0)) {
            config_value_text(info, agv_config_get(config, i), value);
            text_add(text, "%s  %s: %s\n", any ? "" : "config:\n", info->name, value);
            any = true;
        }
    }
    for (uint32_t i = 0; i < AGV_FAULT_COUNT; i++) {
        const agv_fault_t fault = (agv_fault_t)i;
        const bool is_trip = agv_config_is_trip(config, fault);
        char key[CONFIG_CLASS_KEY_SIZE];
        if (is_trip != (agv_fault_default_class(fault) == AGV_CLASS_TRIP)) {
            config_class_key(fault, key);
            text_add(text, "%s  %s: %s\n", any ? "" : "config:\n", key, is_trip ? "trip" : "warn");
            any = true;
        }
    }
}

static char gear_letter(uint8_t gear) {
    return (gear == AGV_GEAR_R) ? 'R' : 'D';
}

/** How it was driven before the fault. */
static void add_driver(text_t *text, const skeleton_plan_t *plan) {
    const skeleton_facts_t *facts = plan->facts;
    const unsigned throttle_pct = (unsigned)facts->throttle_permille / PERMILLE_PER_PCT;
    const uint32_t start_ms = (plan->engage_ms != 0) ? plan->engage_ms : plan->cause_ms;
    const uint32_t drive_ms = start_ms - (uint32_t)DRIVE_BEFORE_MS;

    if (facts->is_driven && (plan->engage_ms != 0)) {
        text_add(text, "  - {at_ms: %" PRIu32 ", ai: drive, gear: %c, throttle_pct: %u, steer_deg: %" PRId32 "}\n",
                 drive_ms, gear_letter(facts->gear), throttle_pct, facts->angle_ddeg / DDEG_PER_DEG);
    } else if (facts->is_driven) {
        text_add(text, "  - {at_ms: %" PRIu32 ", operator: drive, gear: %c, throttle_pct: %u}\n", drive_ms,
                 gear_letter(facts->gear), throttle_pct);
    } else {
        /* it stood */
    }
    if (plan->engage_ms != 0) {
        text_add(text, "  - {name: engages, at_ms: %" PRIu32 ", operator: engage}\n", plan->engage_ms);
    }
}

void skeleton_text(text_t *text, const skeleton_plan_t *plan, const skeleton_seen_t *seen) {
    text_clear(text);
    add_head(text, plan);
    add_settings(text, &plan->facts->request->config);
    text_add(text, "duration_ms: %" PRIu32 "\nsteps:\n", plan->duration_ms);
    if (plan->engage_ms > plan->cause_ms) {
        text_add(text, "%s", plan->steps.bytes);
        add_driver(text, plan);
    } else {
        add_driver(text, plan);
        text_add(text, "%s", plan->steps.bytes);
    }
    text_add(text, "expect:\n");
    if (seen == NULL) {
        text_add(text, "  states: any\n");
    } else {
        skeleton_expect(text, plan, seen);
    }
}

/* A program of a hunt as the text of a scenario. */
#include <inttypes.h>

#include "agv/config.h"
#include "config/config_file.h"
#include "config/config_text.h"
#include "hunt/hunt_program.h"

enum { ROLLS_MM_S2 = 1 };

static void write_setting(const hunt_setting_t *setting, text_t *text) {
    const agv_setting_info_t *info = agv_setting_info(setting->setting);
    char value[CONFIG_VALUE_SIZE];

    config_value_text(info, setting->value, value);
    text_add(text, "%s: %s", info->name, value);
}

static void write_class(const hunt_program_t *program, uint8_t fault, text_t *text) {
    char key[CONFIG_CLASS_KEY_SIZE];
    agv_config_t config;

    hunt_program_config(program, &config);
    config_class_key((agv_fault_t)fault, key);
    text_add(text, "%s: %s", key, agv_config_is_trip(&config, fault) ? "trip" : "warn");
}

static void write_config(const hunt_program_t *program, text_t *text) {
    if (program->setting_count + program->class_count > 0) {
        text_add(text, "config:\n");
    }
    for (uint32_t i = 0; i < program->setting_count; i++) {
        text_add(text, "  ");
        write_setting(&program->settings[i], text);
        text_add(text, "\n");
    }
    for (uint32_t i = 0; i < program->class_count; i++) {
        text_add(text, "  ");
        write_class(program, program->classes[i], text);
        text_add(text, "\n");
    }
}

static void write_vehicle(const hunt_program_t *program, text_t *text) {
    text_add(text, "vehicle:\n  park_guard: %s\n  obeys_short_frames: %s\n  steering_rate_ddeg_s: %u\n",
             program->park_guard ? "true" : "false", program->obeys_short ? "true" : "false",
             program->steering_rate_ddeg_s);
    if (program->rolls) {
        text_add(text, "  coasting_mm_s2: %d\n  braking_mm_s2: %d\n  locked_mm_s2: %d\n", ROLLS_MM_S2, ROLLS_MM_S2,
                 ROLLS_MM_S2);
    }
}

void hunt_program_write(const hunt_program_t *program, const char *name, text_t *text) {
    text_add(text, "name: %s\nshows: [FSM-1]\ntopology: %s\nid_set: heading\ntick_phase_us: %u\n", name,
             program->gateway ? "gateway" : "shared", program->tick_phase_us);
    text_add(text, "board: [output_feedback, emergency_stop, reset_button, second_clock]\n");
    write_config(program, text);
    write_vehicle(program, text);
    text_add(text, "duration_ms: %" PRIu32 "\n", program->duration_ms);
    hunt_steps_write(program, text);
}

void hunt_program_describe(const hunt_program_t *program, text_t *text) {
    text_add(text, "%s", program->gateway ? "gateway" : "shared");
    for (uint32_t i = 0; i < program->action_count; i++) {
        text_add(text, " %s", HUNT_ATTACKS[program->actions[i].attack].name);
    }
    for (uint32_t i = 0; i < program->setting_count; i++) {
        text_add(text, ", ");
        write_setting(&program->settings[i], text);
    }
    for (uint32_t i = 0; i < program->class_count; i++) {
        text_add(text, ", ");
        write_class(program, program->classes[i], text);
    }
}

#include "agv/names.h"

#include <stddef.h>
#include <string.h>

#include "hal/reset.h"

#define AGV_FAULT_TRANSIENT AGV_FAULT
#define AGV_COMMAND AGV_STATUS

static const char *const fault_names[AGV_FAULT_COUNT] = {
#define AGV_FAULT(name, class, led, flags) [AGV_FAULT_##name] = #name,
#include "agv/fault_table.def"
#undef AGV_FAULT
};

static const char *const message_names[AGV_MSG_COUNT] = {
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter) [AGV_MSG_##NAME] = #name,
#include "agv/message_table.def"
#undef AGV_STATUS
};

static const char *const missing_names[] = {"state",      "vcu_heartbeat", "eps_heartbeat",  "trip_cause",
                                            "standstill", "manual",        "button",         "messages",
                                            "throttle",   "released",      "output_feedback"};

static const char *const part_names[] = {"flash", "ram", "processor", "watchdog", "devices", "core", "supply"};

static const char *const reset_names[] = {"power-on", "watchdog", "brown-out", "lock-up", "software", "unknown"};

static const char *const end_names[HAL_ENDS] = {
    [HAL_END_TASK_WATCHDOG] = "task watchdog",
    [HAL_END_PROCESSOR] = "processor fault",
    [HAL_END_INTERRUPT] = "spurious interrupt",
    [HAL_END_STACK] = "stack overflow",
    [HAL_END_ASSERTION] = "failed assertion",
    [HAL_END_KERNEL] = "kernel panic",
    [HAL_END_NMI] = "NMI",
    [HAL_END_CLOCK] = "clock failure",
    [HAL_END_FLASH_ECC] = "flash ECC error",
    [HAL_END_RAM_PARITY] = "RAM parity error",
    [HAL_END_WINDOW_WATCHDOG] = "window watchdog",
};

static const agv_setting_info_t settings[AGV_SETTING_COUNT] = {
#define ANY false
#define GATEWAY true
#define AGV_SETTING(name, preset, lowest, highest, unit, weakens, scope, meaning)                                      \
    [AGV_SETTING_##name] = {#name, (preset), (lowest), (highest), unit, NULL, meaning, #weakens, scope},
#define AGV_CHOICE(name, words, last, weakens, scope, meaning)                                                         \
    [AGV_SETTING_##name] = {#name, 0, 0, (last), "", words, meaning, #weakens, scope},
#include "agv/config_settings.def"
#undef AGV_SETTING
#undef AGV_CHOICE
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter)                                        \
    [AGV_SETTING_id_##                                                                                                 \
        name] = {"id_" #name, (heading), 1, AGV_ID_MAX, "", NULL, "identifier of " #name " (P1)", "NEVER", ANY},
#include "agv/message_table.def"
#undef AGV_STATUS
};

const char *agv_fault_name(agv_fault_t fault) {
    return ((uint32_t)fault < (uint32_t)AGV_FAULT_COUNT) ? fault_names[fault] : NULL;
}

agv_fault_t agv_fault_from_name(const char *name) {
    uint32_t i = 0u;
    while ((i < (uint32_t)AGV_FAULT_COUNT) && (strcmp(fault_names[i], name) != 0)) {
        i++;
    }
    return (agv_fault_t)i;
}

const char *agv_class_name(agv_fault_class_t fault_class) {
    return (fault_class == AGV_CLASS_TRIP) ? "trip" : "warn";
}

const char *agv_state_name(agv_state_t state) {
    switch (state) {
    case AGV_STATE_INIT:
        return "INIT";
    case AGV_STATE_STANDBY:
        return "STANDBY";
    case AGV_STATE_ACTIVE:
        return "ACTIVE";
    case AGV_STATE_TRIPPED:
        return "TRIPPED";
    case AGV_STATE_SAFE:
        return "SAFE";
    default:
        return NULL;
    }
}

const char *agv_message_name(agv_message_t message) {
    return ((uint32_t)message < (uint32_t)AGV_MSG_COUNT) ? message_names[message] : NULL;
}

const char *agv_missing_name(uint8_t index) {
    return (index < (sizeof(missing_names) / sizeof(missing_names[0]))) ? missing_names[index] : NULL;
}

const char *agv_self_test_part_name(uint8_t index) {
    return (index < (sizeof(part_names) / sizeof(part_names[0]))) ? part_names[index] : NULL;
}

const char *agv_reset_cause_name(uint8_t cause) {
    return (cause < (sizeof(reset_names) / sizeof(reset_names[0]))) ? reset_names[cause] : NULL;
}

const char *agv_end_name(uint8_t end) {
    return (end < (uint8_t)HAL_ENDS) ? end_names[end] : NULL;
}

const agv_setting_info_t *agv_setting_info(uint16_t setting) {
    return (setting < (uint16_t)AGV_SETTING_COUNT) ? &settings[setting] : NULL;
}

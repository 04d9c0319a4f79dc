/**
 * @file config.h
 * The configuration: one struct with defaults and a check (INT-2). config_settings.def defines the settings with their
 * ranges and meanings; message_table.def defines the identifiers of the messages (id_...).
 */
#ifndef AGV_CONFIG_H
#define AGV_CONFIG_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/faults.h"
#include "agv/protocol.h"

/** Values of the settings that are a choice of words. */
enum { AGV_TOPOLOGY_SHARED = 0, AGV_TOPOLOGY_GATEWAY = 1 };
enum { AGV_SHADOW_OFF = 0, AGV_SHADOW_ON = 1 };
enum { AGV_PARK_AT_ONCE = 0, AGV_PARK_AT_STANDSTILL = 1 };
enum { AGV_AI_LOST_WARN = 0, AGV_AI_LOST_TRIP = 1 };
enum { AGV_OWN_HEARTBEAT_RUNNING = 0, AGV_OWN_HEARTBEAT_FROZEN = 1 };
enum { AGV_IN_MANUAL_HEARTBEAT = 0, AGV_IN_MANUAL_ALL = 1 };
enum { AGV_COUNTER_ANY = 0, AGV_COUNTER_INCREMENTS = 1 };
enum { AGV_AFTER_POWER_ON_INIT = 0, AGV_AFTER_POWER_ON_TRIPPED = 1 };
enum { AGV_RESET_INPUT_CAN = 0, AGV_RESET_INPUT_PIN = 1, AGV_RESET_INPUT_BOTH = 2 };
enum { AGV_STATUS_VERSION_OFF = 0, AGV_STATUS_VERSION_ON = 1 };
enum { AGV_GEAR_CHANGE_AT_STANDSTILL = 0, AGV_GEAR_CHANGE_ANY = 1 };

/** Value of standstill_vcu_counts with which the speed of 363h is not checked. */
#define AGV_STANDSTILL_VCU_ANY 65535u

/** All settings in the order of config_settings.def, then the identifiers, then the classes of the faults. */
typedef struct {
#define AGV_SETTING(name, preset, lowest, highest, unit, weakens, scope, meaning) uint16_t name;
#define AGV_CHOICE(name, words, last, weakens, scope, meaning) uint16_t name;
#include "agv/config_settings.def"
#undef AGV_SETTING
#undef AGV_CHOICE
#define AGV_COMMAND(NAME, name, heading, table, cycle, deadline, fault, counter) uint16_t id_##name;
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter) uint16_t id_##name;
#include "agv/message_table.def"
#undef AGV_COMMAND
#undef AGV_STATUS
    agv_fault_set_t trips; /**< the faults of class trip; all others warn */
} agv_config_t;

/** Index of each setting (`trips` has none), and the number of settings. */
enum {
#define AGV_SETTING(name, preset, lowest, highest, unit, weakens, scope, meaning) AGV_SETTING_##name,
#define AGV_CHOICE(name, words, last, weakens, scope, meaning) AGV_SETTING_##name,
#include "agv/config_settings.def"
#undef AGV_SETTING
#undef AGV_CHOICE
#define AGV_COMMAND(NAME, name, heading, table, cycle, deadline, fault, counter) AGV_SETTING_id_##name,
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter) AGV_SETTING_id_##name,
#include "agv/message_table.def"
#undef AGV_COMMAND
#undef AGV_STATUS
    AGV_SETTING_COUNT,
    AGV_SETTING_ID = AGV_SETTING_id_turn_signal_command /**< of message n: AGV_SETTING_ID + n */
};

/** Why agv_config_check refuses a configuration. */
typedef enum {
    AGV_CONFIG_OK,
    AGV_CONFIG_OUT_OF_RANGE, /**< `setting` is below its lowest or above its highest value */
    /** `setting` is also the identifier of another message, or status_frame_id is that of a message in either ID set */
    AGV_CONFIG_ID_TWICE,
    AGV_CONFIG_NEEDS_GATEWAY,   /**< `setting` has no effect on a shared bus and is not at its default */
    AGV_CONFIG_PRESS_TOO_SHORT, /**< reset_hold_max_ms is not above reset_hold_ms: no press could reset */
    AGV_CONFIG_CLASS_FIXED,     /**< the class of `fault` can never be changed, or not on a shared bus */
    AGV_CONFIG_NO_SUCH_FAULT    /**< `trips` has bits beyond the last fault */
} agv_config_problem_t;

/** Result of agv_config_check. */
typedef struct {
    agv_config_problem_t problem;
    uint16_t setting;  /**< AGV_SETTING_* index; AGV_SETTING_COUNT: the problem concerns no setting */
    agv_fault_t fault; /**< highest-ranking fault whose class must be its default and is not; AGV_FAULT_NONE: none */
} agv_config_verdict_t;

/** Fill in the default configuration. */
void agv_config_defaults(agv_config_t *config);

/** Read a setting by its index. @return 0 if there is no such setting. */
uint16_t agv_config_get(const agv_config_t *config, uint32_t setting);

/** Write a setting by its index, without a check of its range. @return false if there is no such setting. */
bool agv_config_set(agv_config_t *config, uint32_t setting, uint16_t value);

/** Whether the configured class of a fault is trip. False for AGV_FAULT_NONE. */
bool agv_config_is_trip(const agv_config_t *config, uint32_t fault);

/**
 * The identifiers of a configuration (P1). Each is the value of its setting id_...; when `id_set` is `table`, a setting
 * that has its default value stands for the identifier of the set `table`. With an invalid `id_set` (a configuration that is refused)
 * such a setting gives a value above AGV_ID_MAX.
 */
void agv_config_ids(const agv_config_t *config, agv_ids_t *ids);

/** Check a configuration as a whole. @return the first problem found, or AGV_CONFIG_OK. */
agv_config_verdict_t agv_config_check(const agv_config_t *config);

/**
 * Checksum of a configuration: CRC-32 (IEEE 802.3) over all settings in their order (16-bit little-endian), then the
 * words of `trips` (32-bit little-endian). It is the same on every platform.
 */
uint32_t agv_config_checksum(const agv_config_t *config);

/** Whether a setting weakens the supervision compared with its default (INT-2). False if there is no such setting. */
bool agv_config_weakens(const agv_config_t *config, uint32_t setting);

/** Description of a setting, for programs that list or read configurations. The supervisor does not use it. */
typedef struct {
    const char *name;
    uint16_t preset; /**< default */
    uint16_t lowest;
    uint16_t highest;
    const char *unit;    /**< "" for choices and identifiers */
    const char *words;   /**< "a|b" for choices, NULL for numbers */
    const char *meaning; /**< one line, with the requirement ID */
    const char *weakens; /**< "ABOVE", "BELOW", "ZERO", "CHOSEN" or "NEVER": see config_settings.def */
    bool gateway_only;   /**< has no effect on a shared bus */
} agv_setting_info_t;

/** Describe a setting. @return NULL if there is no such setting. */
const agv_setting_info_t *agv_setting_info(uint16_t setting);

#endif

#include "agv/config.h"

#include <stddef.h>
#include <string.h>

#include "agv/checksum.h"
#include "agv/protocol.h"

/* Every choice has two words: its values are 0 and 1. */
#define AGV_CHOICE(name, preset, words, meaning) AGV_SETTING(name, preset, 0u, 1u, "", meaning)

static const struct {
    uint16_t preset;
    uint16_t lowest;
    uint16_t highest;
} rows[AGV_SETTING_COUNT] = {
#define AGV_SETTING(name, preset, lowest, highest, unit, meaning) {(preset), (lowest), (highest)},
#include "agv/config_settings.def"
#undef AGV_SETTING
};

/* Index of each setting. */
enum {
#define AGV_SETTING(name, preset, lowest, highest, unit, meaning) SETTING_##name,
#include "agv/config_settings.def"
#undef AGV_SETTING
};

/* The settings stand without gaps at the start of the struct: a setting's place is its index. */
_Static_assert(offsetof(agv_config_t, watchdog_period_ms) == ((size_t)AGV_SETTING_COUNT - 1u) * sizeof(uint16_t),
               "settings are contiguous");

uint16_t agv_config_get(const agv_config_t *config, uint16_t setting) {
    uint16_t value = 0u;
    if (setting < (uint16_t)AGV_SETTING_COUNT) {
        (void)memcpy(&value, (const unsigned char *)config + (setting * sizeof value), sizeof value);
    }
    return value;
}

bool agv_config_set(agv_config_t *config, uint16_t setting, uint16_t value) {
    const bool known = setting < (uint16_t)AGV_SETTING_COUNT;
    if (known) {
        (void)memcpy((unsigned char *)config + (setting * sizeof value), &value, sizeof value);
    }
    return known;
}

void agv_config_defaults(agv_config_t *config) {
    (void)memset(config, 0, sizeof *config);
    for (uint16_t i = 0u; i < (uint16_t)AGV_SETTING_COUNT; i++) {
        (void)agv_config_set(config, i, rows[i].preset);
    }
    config->trips = agv_faults_default_trips;
}

static bool id_is_taken(uint32_t id) {
    return (agv_message_from_id(id, AGV_ID_SET_HEADING) != AGV_MSG_NONE) ||
           (agv_message_from_id(id, AGV_ID_SET_TABLE) != AGV_MSG_NONE);
}

static agv_config_verdict_t verdict(agv_config_problem_t problem, uint16_t setting, agv_fault_t fault) {
    const agv_config_verdict_t result = {.problem = problem, .setting = setting, .fault = fault};
    return result;
}

static agv_config_verdict_t check_together(const agv_config_t *config) {
    const agv_fault_set_t all = agv_fault_bit(AGV_FAULT_COUNT - 1) | (agv_fault_bit(AGV_FAULT_COUNT - 1) - 1u);
    const agv_fault_set_t weakened = agv_faults_default_trips & agv_faults_fixed & ~config->trips;
    if ((config->status_frame_id != 0u) && id_is_taken(config->status_frame_id)) {
        return verdict(AGV_CONFIG_ID_TWICE, SETTING_status_frame_id, AGV_FAULT_NONE);
    }
    if ((config->own_heartbeat == AGV_OWN_HEARTBEAT_FROZEN) && (config->topology != AGV_TOPOLOGY_GATEWAY)) {
        return verdict(AGV_CONFIG_NEEDS_GATEWAY, SETTING_own_heartbeat, AGV_FAULT_NONE);
    }
    if (weakened != 0u) {
        return verdict(AGV_CONFIG_FAULT_TOO_WEAK, 0u, agv_fault_highest(weakened));
    }
    if ((config->trips & ~all) != 0u) {
        return verdict(AGV_CONFIG_NO_SUCH_FAULT, 0u, AGV_FAULT_NONE);
    }
    return verdict(AGV_CONFIG_OK, 0u, AGV_FAULT_NONE);
}

agv_config_verdict_t agv_config_check(const agv_config_t *config) {
    for (uint16_t i = 0u; i < (uint16_t)AGV_SETTING_COUNT; i++) {
        const uint16_t value = agv_config_get(config, i);
        if ((value < rows[i].lowest) || (value > rows[i].highest)) {
            return verdict(AGV_CONFIG_OUT_OF_RANGE, i, AGV_FAULT_NONE);
        }
    }
    return check_together(config);
}

static uint32_t crc_of(uint32_t crc, uint64_t value, uint32_t size) {
    uint8_t bytes[sizeof value];
    for (uint32_t i = 0u; i < size; i++) {
        bytes[i] = (uint8_t)(value >> (8u * i));
    }
    return agv_crc32(crc, bytes, size);
}

uint32_t agv_config_checksum(const agv_config_t *config) {
    uint32_t crc = AGV_CRC32_START;
    for (uint16_t i = 0u; i < (uint16_t)AGV_SETTING_COUNT; i++) {
        crc = crc_of(crc, agv_config_get(config, i), 2u);
    }
    return ~crc_of(crc, config->trips, 8u);
}

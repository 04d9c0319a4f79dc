#include "agv/config.h"

#include <stddef.h>
#include <string.h>

#include "agv/checksum.h"

/* Which values weaken the supervision, and in which topology a setting has an effect. */
enum { NEVER, ABOVE, BELOW, ZERO, CHOSEN = ABOVE, ANY = 0, GATEWAY = 1 };

static const struct {
    uint16_t preset;
    uint16_t lowest;
    uint16_t highest;
    uint8_t weakens;
    uint8_t scope;
} rows[AGV_SETTING_COUNT] = {
#define AGV_SETTING(name, by_default, low, high, unit, weak, where, meaning)                                           \
    [AGV_SETTING_##                                                                                                    \
        name] = {.preset = (by_default), .lowest = (low), .highest = (high), .weakens = (weak), .scope = (where)},
#define AGV_CHOICE(name, words, last, weak, where, meaning)                                                            \
    [AGV_SETTING_##name] = {.highest = (last), .weakens = (weak), .scope = (where)},
#include "agv/config_settings.def"
#undef AGV_SETTING
#undef AGV_CHOICE
#define AGV_COMMAND AGV_STATUS
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter)                                        \
    [AGV_SETTING_id_##name] = {.preset = (heading), .lowest = 1, .highest = AGV_ID_MAX},
#include "agv/message_table.def"
#undef AGV_COMMAND
#undef AGV_STATUS
};

/* The settings are at the start of the struct without gaps: the position of a setting is its index. */
_Static_assert(offsetof(agv_config_t, trips) - ((size_t)AGV_SETTING_COUNT * sizeof(uint16_t)) < sizeof(uint32_t),
               "settings are contiguous");

uint16_t agv_config_get(const agv_config_t *config, uint32_t setting) {
    uint16_t value = 0u;
    if (setting < (uint32_t)AGV_SETTING_COUNT) {
        (void)memcpy(&value, &((const unsigned char *)config)[setting * sizeof value], sizeof value);
    }
    return value;
}

bool agv_config_set(agv_config_t *config, uint32_t setting, uint16_t value) {
    const bool known = setting < (uint32_t)AGV_SETTING_COUNT;
    if (known) {
        (void)memcpy(&((unsigned char *)config)[setting * sizeof value], &value, sizeof value);
    }
    return known;
}

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the checksum runs over the bytes as they lie in memory");

bool agv_config_is_trip(const agv_config_t *config, uint32_t fault) {
    return agv_fault_is_in(&config->trips, fault);
}

void agv_config_defaults(agv_config_t *config) {
    (void)memset(config, 0, sizeof *config);
    for (uint32_t i = 0u; i < (uint32_t)AGV_SETTING_COUNT; i++) {
        (void)agv_config_set(config, i, rows[i].preset);
    }
    for (uint32_t fault = 0u; fault < (uint32_t)AGV_FAULT_COUNT; fault++) {
        agv_fault_set_put(&config->trips, fault, agv_fault_default_class(fault) == AGV_CLASS_TRIP);
    }
}

static bool is_in_range(uint32_t setting, uint32_t value) {
    return (value >= rows[setting].lowest) && (value <= rows[setting].highest);
}

/* The first setting that is out of range; AGV_SETTING_COUNT if there is none. */
static uint32_t out_of_range(const agv_config_t *config) {
    uint32_t setting = 0u;
    while ((setting < (uint32_t)AGV_SETTING_COUNT) && is_in_range(setting, agv_config_get(config, setting))) {
        setting++;
    }
    return setting;
}

/* The highest-ranking fault whose class must be its default and is not; AGV_FAULT_NONE if there is none. */
static uint32_t first_class_that_is_fixed(const agv_config_t *config) {
    const bool is_gateway = config->topology == (uint16_t)AGV_TOPOLOGY_GATEWAY;
    const uint32_t without_effect = is_gateway ? 0u : (uint32_t)AGV_FAULT_FLAG_GATEWAY;
    uint32_t fault = 0u;
    while ((fault < (uint32_t)AGV_FAULT_COUNT) &&
           (((agv_fault_flags(fault) & (AGV_FAULT_FLAG_FIXED | without_effect)) == 0u) ||
            (agv_config_is_trip(config, fault) == (agv_fault_default_class(fault) == AGV_CLASS_TRIP)))) {
        fault++;
    }
    return fault;
}

void agv_config_ids(const agv_config_t *config, agv_ids_t *ids) {
    for (uint32_t i = 0u; i < (uint32_t)AGV_MSG_COUNT; i++) {
        const uint16_t id = agv_config_get(config, (uint32_t)AGV_SETTING_ID + i);
        const bool is_preset = id == agv_message_id(i, AGV_ID_SET_HEADING);
        ids->of[i] = is_preset ? agv_message_id(i, config->id_set) : id;
    }
}

/* The setting of an identifier that is used twice; AGV_SETTING_COUNT if there is none. */
static uint32_t id_twice(const agv_config_t *config) {
    agv_ids_t ids;
    agv_config_ids(config, &ids);
    for (uint32_t i = 1u; i < (uint32_t)AGV_MSG_COUNT; i++) {
        if (agv_ids_find(&ids, ids.of[i]) < i) {
            return (uint32_t)AGV_SETTING_ID + i;
        }
    }
    const uint32_t status_id = config->status_frame_id;
    const bool taken = (agv_ids_find(&ids, status_id) != (uint32_t)AGV_MSG_NONE) ||
                       (agv_message_from_id(status_id, AGV_ID_SET_HEADING) != (uint32_t)AGV_MSG_NONE) ||
                       (agv_message_from_id(status_id, AGV_ID_SET_TABLE) != (uint32_t)AGV_MSG_NONE);
    return taken ? (uint32_t)AGV_SETTING_status_frame_id : (uint32_t)AGV_SETTING_COUNT;
}

/* Whether `trips` has a bit beyond the last fault: the last word may have unused bits. */
static bool has_unknown_fault(const agv_config_t *config) {
    const uint32_t spare = ((32u * AGV_FAULT_WORDS) - (uint32_t)AGV_FAULT_COUNT) % 32u;
    const uint32_t known = UINT32_MAX >> spare;
    return (config->trips.words[AGV_FAULT_WORDS - 1u] & ~known) != 0u;
}

/* On a shared bus: the first setting that is not at its default and has no effect; AGV_SETTING_COUNT if there is none. */
static uint32_t first_setting_without_effect(const agv_config_t *config) {
    uint32_t setting = (config->topology == (uint16_t)AGV_TOPOLOGY_GATEWAY) ? (uint32_t)AGV_SETTING_COUNT : 0u;
    while ((setting < (uint32_t)AGV_SETTING_COUNT) &&
           ((rows[setting].scope == (uint8_t)ANY) || (agv_config_get(config, setting) == rows[setting].preset))) {
        setting++;
    }
    return setting;
}

/* Check the settings one by one. */
static agv_config_problem_t check_settings(const agv_config_t *config, uint16_t *setting) {
    *setting = (uint16_t)out_of_range(config);
    if (*setting < (uint16_t)AGV_SETTING_COUNT) {
        return AGV_CONFIG_OUT_OF_RANGE;
    }
    *setting = (uint16_t)id_twice(config);
    if (*setting < (uint16_t)AGV_SETTING_COUNT) {
        return AGV_CONFIG_ID_TWICE;
    }
    *setting = (uint16_t)first_setting_without_effect(config);
    if (*setting < (uint16_t)AGV_SETTING_COUNT) {
        return AGV_CONFIG_NEEDS_GATEWAY;
    }
    if (config->reset_hold_max_ms <= config->reset_hold_ms) {
        *setting = AGV_SETTING_reset_hold_max_ms;
        return AGV_CONFIG_PRESS_TOO_SHORT;
    }
    return AGV_CONFIG_OK;
}

agv_config_verdict_t agv_config_check(const agv_config_t *config) {
    agv_config_verdict_t verdict = {AGV_CONFIG_OK, AGV_SETTING_COUNT, (agv_fault_t)first_class_that_is_fixed(config)};
    verdict.problem = check_settings(config, &verdict.setting);
    if (verdict.problem != AGV_CONFIG_OK) {
        return verdict;
    }
    if (verdict.fault != AGV_FAULT_NONE) {
        verdict.problem = AGV_CONFIG_CLASS_FIXED;
    } else if (has_unknown_fault(config)) {
        verdict.problem = AGV_CONFIG_NO_SUCH_FAULT;
    } else {
        /* sound */
    }
    return verdict;
}

bool agv_config_weakens(const agv_config_t *config, uint32_t setting) {
    const uint32_t value = agv_config_get(config, setting);
    if (setting >= (uint32_t)AGV_SETTING_COUNT) {
        return false;
    }
    switch (rows[setting].weakens) {
    case ABOVE: /* and CHOSEN */
        return value > rows[setting].preset;
    case BELOW:
        return value < rows[setting].preset;
    case ZERO:
        return value == 0u;
    default:
        return false;
    }
}

uint32_t agv_config_checksum(const agv_config_t *config) {
    const uint32_t crc = agv_crc32(AGV_CRC32_START, config, (size_t)AGV_SETTING_COUNT * sizeof(uint16_t));
    return ~agv_crc32(crc, &config->trips, sizeof config->trips);
}

#include "kconfig.h"

#include <zephyr/sys/util.h>
#include <zephyr/toolchain.h>

/* Kconfig.settings is made from the core's tables; here the build checks that it still agrees with them. */
enum { SCOPE_ANY, SCOPE_GATEWAY };
enum {
#define AGV_SETTING(name, preset, lowest, highest, unit, weakens, scope, meaning)                                      \
    PRESET_##name = (preset), LOWEST_##name = (lowest), HIGHEST_##name = (highest), SCOPE_OF_##name = SCOPE_##scope,
#define AGV_CHOICE(name, words, last, weakens, scope, meaning)                                                         \
    PRESET_##name = 0, LOWEST_##name = 0, HIGHEST_##name = (last), SCOPE_OF_##name = SCOPE_##scope,
#include "agv/config_settings.def"
#undef AGV_SETTING
#undef AGV_CHOICE
#define AGV_COMMAND AGV_STATUS
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter)                                        \
    PRESET_id_##name = (heading), LOWEST_id_##name = 1, HIGHEST_id_##name = AGV_ID_MAX, SCOPE_OF_id_##name = SCOPE_ANY,
#include "agv/message_table.def"
#undef AGV_COMMAND
#undef AGV_STATUS
};

#define AGV_KCONFIG(name, value)                                                                                       \
    BUILD_ASSERT(((value) >= LOWEST_##name) && ((value) <= HIGHEST_##name), #name " is out of range");                 \
    BUILD_ASSERT(IS_ENABLED(CONFIG_AGV_TOPOLOGY_GATEWAY) || ((int)SCOPE_OF_##name == (int)SCOPE_ANY) ||                \
                     ((value) == PRESET_##name),                                                                       \
                 #name " needs the gateway");
#define AGV_KCONFIG_CLASS(name, is_trip)
#include "kconfig_settings.def"
#undef AGV_KCONFIG
#undef AGV_KCONFIG_CLASS

/* One row for each setting, in any order. */
enum {
    KCONFIG_SETTINGS = 0
#define AGV_KCONFIG(name, value) +1
#define AGV_KCONFIG_CLASS(name, is_trip)
#include "kconfig_settings.def"
#undef AGV_KCONFIG
#undef AGV_KCONFIG_CLASS
};
BUILD_ASSERT((int)KCONFIG_SETTINGS == (int)AGV_SETTING_COUNT, "a setting has no symbol: run scripts/tools/kconfig.py");

/* What is wrong only together. */
BUILD_ASSERT(!KCONFIG_ID_IS_TAKEN(CONFIG_AGV_STATUS_FRAME_ID), "CONFIG_AGV_STATUS_FRAME_ID is one of the protocol's");
BUILD_ASSERT(CONFIG_AGV_RESET_HOLD_MAX_MS > CONFIG_AGV_RESET_HOLD_MS,
             "CONFIG_AGV_RESET_HOLD_MAX_MS is not above CONFIG_AGV_RESET_HOLD_MS");
BUILD_ASSERT(!IS_ENABLED(CONFIG_AGV_CAN_LISTEN_ONLY) || IS_ENABLED(CONFIG_AGV_SHADOW_ON),
             "a supervisor that is to act cannot listen only: CONFIG_AGV_SHADOW_ON");

static void set_class(agv_config_t *config, uint32_t fault, bool is_trip) {
    agv_fault_set_put(&config->trips, fault, is_trip);
}

void kconfig_read(agv_config_t *config) {
    agv_config_defaults(config);
#define AGV_KCONFIG(name, value) config->name = (value);
#define AGV_KCONFIG_CLASS(name, is_trip) set_class(config, AGV_FAULT_##name, (is_trip));
#include "kconfig_settings.def"
#undef AGV_KCONFIG
#undef AGV_KCONFIG_CLASS
}

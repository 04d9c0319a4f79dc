#include "kconfig.h"

#include <zephyr/sys/util.h>
#include <zephyr/toolchain.h>

/* The ranges of Kconfig are made from the core's table; here the build looks whether they still are what it says. */
enum {
#define AGV_SETTING(name, preset, lowest, highest, unit, meaning) LOWEST_##name = (lowest), HIGHEST_##name = (highest),
#define AGV_CHOICE(name, preset, words, meaning) LOWEST_##name = 0, HIGHEST_##name = 1,
#include "agv/config_settings.def"
#undef AGV_SETTING
#undef AGV_CHOICE
};

#define AGV_KCONFIG(name, value)                                                                                       \
    BUILD_ASSERT(((value) >= LOWEST_##name) && ((value) <= HIGHEST_##name), #name " is out of range");
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
BUILD_ASSERT((int)KCONFIG_SETTINGS == (int)AGV_SETTING_COUNT, "a setting has no symbol: run scripts/kconfig");

/* What is wrong only together. */
BUILD_ASSERT(!KCONFIG_ID_IS_TAKEN(CONFIG_AGV_STATUS_FRAME_ID), "CONFIG_AGV_STATUS_FRAME_ID is one of the protocol's");
BUILD_ASSERT(!IS_ENABLED(CONFIG_AGV_OWN_HEARTBEAT_FROZEN) || IS_ENABLED(CONFIG_AGV_TOPOLOGY_GATEWAY),
             "CONFIG_AGV_OWN_HEARTBEAT_FROZEN needs the gateway");
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

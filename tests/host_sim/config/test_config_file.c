/* The configuration as a YAML file: what it may say, and what is refused with its line. */
#include "config/config_file.h"
#include "text/words.h"

#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "config/config_options.h"
#include "scratch.h"
#include "settings_expected.h"
#include "unity.h"

static agv_config_t config;
static config_lines_t lines;
static agv_config_t defaults;

void setUp(void) {
    scratch_open();
    agv_config_defaults(&config);
    agv_config_defaults(&defaults);
}

static bool load(const char *text) {
    static char path[256];
    agv_config_defaults(&config);
    (void)snprintf(path, sizeof path, "%s", scratch_write("c.yaml", text, strlen(text)));
    return config_file_load(path, &config, &lines) && config_check(&config, &lines);
}

static void load_good(const char *text) {
    TEST_ASSERT_TRUE_MESSAGE(load(text), scratch_said());
    TEST_ASSERT_EQUAL_STRING("", scratch_said());
}

/* It is refused with one line, which names the file and holds this. */
static void load_bad(const char *text, const char *expected) {
    TEST_ASSERT_FALSE_MESSAGE(load(text), text);
    const char *place = scratch_said_line("c.yaml:");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(place, expected), place);
}

static void assert_default(void) {
    TEST_ASSERT_EQUAL_HEX32(agv_config_checksum(&defaults), agv_config_checksum(&config));
}

void test_a_file_that_says_nothing(void) {
    load_good("");
    assert_default();
    load_good("# only a comment\n");
    assert_default();
    load_good("---\n...\n"); /* a document with nothing in it */
    assert_default();
    load_good("--- # the beginning\n# of nothing\n");
    assert_default();
    load_bad("--- ''\n", "c.yaml:1: not a list of settings");
}

/* What a setting needs beside it. */
static const char *company(const setting_expected_t *row) {
    if (row->setting == AGV_SETTING_reset_hold_ms) {
        return "reset_hold_max_ms: 30000\n";
    }
    if (row->setting == AGV_SETTING_reset_hold_max_ms) {
        return "reset_hold_ms: 500\n";
    }
    return (row->scope == GATEWAY_ONLY) ? "topology: gateway\n" : "";
}

static const char *name_of(const setting_expected_t *row) {
    return agv_setting_info(row->setting)->name;
}

/* Shows: INT-2 */
void test_every_setting_is_read_by_its_name_up_to_its_limits(void) {
    for (uint16_t i = SETTINGS_EXPECTED_CHOICES; i < SETTINGS_EXPECTED; i++) {
        const setting_expected_t *row = &SETTING_EXPECTED[i];
        const uint16_t values[] = {row->lowest, row->highest};
        for (size_t v = 0; v < 2; v++) {
            char text[128];
            (void)snprintf(text, sizeof text, "%s%s: %u\n", company(row), name_of(row), values[v]);
            load_good(text);
            TEST_ASSERT_EQUAL_UINT16_MESSAGE(values[v], agv_config_get(&config, i), text);
            (void)agv_config_set(&config, i, row->preset);
            config.reset_hold_ms = defaults.reset_hold_ms;
            config.reset_hold_max_ms = defaults.reset_hold_max_ms;
            config.topology = defaults.topology;
            assert_default();
        }
    }
}

static void load_beyond(const setting_expected_t *row, unsigned value) {
    const bool is_id = (row->setting >= AGV_SETTING_ID) || (row->setting == AGV_SETTING_status_frame_id);
    char text[128];
    char expected[128];
    (void)snprintf(text, sizeof text, "\n%s: %u\n", name_of(row), value);
    (void)snprintf(expected, sizeof expected,
                   is_id ? "c.yaml:2: %s: %u is not within %03Xh to %03Xh" : "c.yaml:2: %s: %u is not within %u to %u",
                   name_of(row), value, row->lowest, row->highest);
    load_bad(text, expected);
}

/* Shows: INT-2 */
void test_every_setting_is_refused_beyond_its_limits(void) {
    for (uint16_t i = SETTINGS_EXPECTED_CHOICES; i < SETTINGS_EXPECTED; i++) {
        const setting_expected_t *row = &SETTING_EXPECTED[i];
        load_beyond(row, row->highest + 1u);
        if (row->lowest > 0) {
            load_beyond(row, row->lowest - 1u);
        }
    }
}

void test_every_word_of_every_choice(void) {
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        const agv_setting_info_t *info = agv_setting_info(i);
        if (info->words == NULL) {
            continue;
        }
        for (uint16_t value = 0; value < 2; value++) {
            char text[128];
            const char *word = NULL;
            const size_t length = words_at(info->words, value, &word);
            (void)snprintf(text, sizeof text, "%s: %.*s\n%s", info->name, (int)length, word,
                           i == 0 ? "" : "topology: gateway\n");
            load_good(text);
            TEST_ASSERT_EQUAL_UINT16_MESSAGE(value, agv_config_get(&config, i), text);
        }
    }
    load_bad("topology: both\n", "c.yaml:1: topology: 'both' is not one of shared|gateway\n");
    load_bad("park: AT_ONCE\n", "c.yaml:1: park: 'AT_ONCE' is not one of");
}

void test_a_switch_may_be_a_boolean(void) {
    load_good("shadow: true\n");
    TEST_ASSERT_EQUAL_UINT16(AGV_SHADOW_ON, config.shadow);
    load_good("shadow: false\n");
    TEST_ASSERT_EQUAL_UINT16(AGV_SHADOW_OFF, config.shadow);
    load_bad("topology: true\n", "is not one of");
}

/* Shows: INT-2 */
void test_every_class_may_be_strengthened_and_weakened_as_far_as_allowed(void) {
    for (uint32_t i = 0; i < AGV_FAULT_COUNT; i++) {
        const agv_fault_t fault = (agv_fault_t)i;
        char key[CONFIG_CLASS_KEY_SIZE];
        char text[128];
        char expected[128];
        const bool only_warns = fault == AGV_FAULT_STARTUP_TIMEOUT;
        const bool fixed = (agv_fault_flags(fault) & AGV_FAULT_FLAG_FIXED) != 0;
        config_class_key(fault, key);
        (void)snprintf(text, sizeof text, "topology: gateway\n\n%s: %s\n", key, only_warns ? "warn" : "trip");
        load_good(text);
        TEST_ASSERT_EQUAL(!only_warns, agv_fault_is_in(&config.trips, fault));
        (void)snprintf(text, sizeof text, "\n\n%s: %s\n", key, only_warns ? "trip" : "warn");
        (void)snprintf(expected, sizeof expected, "c.yaml:3: %s: this fault must stay a %s\n", key,
                       only_warns ? "warning" : "trip");
        if (fixed) {
            load_bad(text, expected);
        } else {
            load_good(text);
            TEST_ASSERT_FALSE(agv_fault_is_in(&config.trips, fault));
        }
    }
    load_bad("class_ai_bus_off: trip\n",
             "c.yaml:1: class_ai_bus_off: has no effect on a shared bus; this value needs the gateway topology\n");
    load_bad("class_bus_off: off\n", "c.yaml:1: class_bus_off: 'off' is not one of trip|warn\n");
    load_bad("class_none: trip\n", "c.yaml:1: class_none: unknown setting\n");
}

void test_numbers(void) {
    load_good("status_frame_id: 0x7A0\n");
    TEST_ASSERT_EQUAL_HEX16(0x7A0, config.status_frame_id);
    load_good("status_frame_id: 0\n");
    load_good("init_hold_ms: 0x1F4\n");
    TEST_ASSERT_EQUAL_UINT16(500, config.init_hold_ms);
    load_bad("init_hold_ms: \"500\"\n", "c.yaml:1: init_hold_ms: write the number without quotes\n");
    load_bad("init_hold_ms: 0500\n", "'0500' is not a whole number; 100 to 10000 ms\n");
    load_bad("init_hold_ms: 18446744073709551616\n", "' is not within 100ms to 10s\n");
    load_bad("throttle_ceiling_pct: five\n", "'five' is not a whole number; 0 to 100 %\n");
    load_bad("throttle_ceiling_pct: 5s\n", "'5s' is not a whole number; 0 to 100 %\n");
    load_bad("init_hold_ms: 18446744073709551615\n", "is not within");
    load_bad("init_hold_ms: 66036\n", "is not within"); /* 500 in 16 bits */
}

void test_times_with_units(void) {
    load_good("init_hold_ms: 1.5s\n");
    TEST_ASSERT_EQUAL_UINT16(1500, config.init_hold_ms);
    load_good("init_hold_ms: 0.5 s # a blank may stand before the unit\n");
    TEST_ASSERT_EQUAL_UINT16(500, config.init_hold_ms);
    static const char *const bad[] = {"five", "500.0", "5e2",         "-500", "+500",
                                      "0x",   "0xG0",  "0x123456789", "-1s",  "1e9999s"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        char text[64];
        char expected[160];
        (void)snprintf(text, sizeof text, "init_hold_ms: %s\n", bad[i]);
        (void)snprintf(
            expected, sizeof expected,
            "c.yaml:1: init_hold_ms: '%s' is not a time: 250ms, 10s, 1.5min, 2h, or whole milliseconds alone\n",
            bad[i]);
        load_bad(text, expected);
    }
    load_bad("init_hold_ms: 10.001s\n", "c.yaml:1: init_hold_ms: '10.001s' is not within 100ms to 10s\n");
    load_bad("init_hold_ms: 500100us\n", "c.yaml:1: init_hold_ms: '500100us' is not a whole number of milliseconds\n");
}

void test_identifiers_in_any_notation(void) {
    static const char *const same[] = {"0x169", "169h", "361"};
    for (size_t i = 0; i < sizeof same / sizeof same[0]; i++) {
        char text[64];
        (void)snprintf(text, sizeof text, "id_gear_command: %s\n", same[i]);
        load_good(text);
        TEST_ASSERT_EQUAL_HEX16(0x169, config.id_gear_command);
    }
    load_bad("id_gear_command: 0169\n", "'0169' is not an identifier: 168h, 0x168, or decimal 360\n");
    load_bad("id_gear_command: 800h\n", "800h is not within 001h to 7FFh\n");
}

void test_what_is_no_list_of_settings(void) {
    load_bad("- topology\n", "c.yaml:1: not a list of settings");
    load_bad("shared\n", "c.yaml:1: not a list of settings");
    load_bad("topology:\n  shared\n  gateway\n", "is not one of");
    load_bad("topology: [shared]\n", "c.yaml:1: topology: needs one value, not a list or a mapping\n");
    load_bad("a: 1\n", "c.yaml:1: a: unknown setting\n");
    load_bad("topology: {a: b}\n", "needs one value");
    load_bad("topology:\n", "c.yaml:1: topology: has no value\n");
    load_bad("shadow: ''\n", "c.yaml:1: shadow: has no value\n");
    load_bad("[a, b]: 1\n", "c.yaml:1: the name of a setting must be a word\n");
    load_bad("topology: \"sha\\0red\"\n", "c.yaml:1: topology: contains a NUL character\n");
    load_bad("\"topo\\0logy\": shared\n", "the name of a setting must be a word");
    load_bad("Topology: shared\n", "c.yaml:1: Topology: unknown setting: did you mean 'topology'?\n");
}

void test_a_setting_stands_once(void) {
    load_bad("topology: shared\npark: at_once\ntopology: shared\n", "c.yaml:3: topology: already set on line 1\n");
    load_bad("class_bus_off: trip\nclass_bus_off: trip\n", "c.yaml:2: class_bus_off: already set on line 1\n");
}

void test_what_is_no_yaml(void) {
    load_bad("topology: shared\n  park: at_once\n", "c.yaml:2: not YAML: ");
    load_bad("a: [\n", "not YAML: ");
    load_bad("\tpark: at_once\n", "c.yaml:1: not YAML: ");
    load_bad("park: at_once\n\nxy: \xFF\xFE\n", "c.yaml:3: not YAML: ");
    load_bad("park: *nobody\n", "c.yaml:1: not YAML: ");
    load_bad("---\npark: at_once\n---\npark: at_once\n", "c.yaml:3: a second YAML document begins here\n");
    load_bad("park: at_once\n...\npark: at_once\n", "c.yaml:3: not YAML: ");
    char nested[128];
    memset(nested, '[', sizeof nested);
    nested[sizeof nested - 1] = '\0';
    load_bad(nested, "c.yaml:1: nested too deeply\n");
}

/* Shows: INT-2 */
void test_settings_that_do_not_fit_together(void) {
    load_bad("park: at_once\nown_heartbeat: frozen\n",
             "c.yaml:2: own_heartbeat: has no effect on a shared bus; this value needs the gateway topology\n");
    load_good("own_heartbeat: frozen\ntopology: gateway\n");
    load_bad("status_frame_id: 0x203\n",
             "c.yaml:1: status_frame_id: another message has this identifier: id_vehicle_status\n");
    load_bad("\nthrottle_ceiling_pct: 50\n",
             "c.yaml:2: throttle_ceiling_pct: has no effect on a shared bus; this value needs the gateway topology\n");
    load_bad("reset_hold_ms: 5000\n", "c.yaml:1: reset_hold_ms: must be below reset_hold_max_ms\n");
    load_bad("reset_hold_max_ms: 1000\n", "c.yaml:1: reset_hold_max_ms: must be above reset_hold_ms\n");
}

/* Shows: INT-2, P1 */
void test_an_identifier_twice_is_refused_with_the_line_that_makes_it_so(void) {
    load_good("id_gear_command: 0x169\nid_vehicle_status: 868\n");
    TEST_ASSERT_EQUAL_HEX16(0x169, config.id_gear_command);
    TEST_ASSERT_EQUAL_HEX16(0x364, config.id_vehicle_status);
    load_bad("id_gear_command: 0x169\nid_throttle_command: 0x169\n",
             "c.yaml:2: id_throttle_command: another message has this identifier: id_gear_command\n");
    load_bad("park: at_once\nid_gear_command: 0x101\n",
             "c.yaml:2: id_gear_command: another message has this identifier: id_wheel_speed\n");
    load_bad("\nid_gear_command: 0x7F0\n",
             "c.yaml:2: id_gear_command: another message has this identifier: status_frame_id\n");
    load_bad("id_set: table\nid_gear_command: 0x203\n",
             "c.yaml:2: id_gear_command: another message has this identifier: id_vehicle_status\n");
}

void test_a_problem_without_a_line_is_named_without_one(void) {
    memset(&lines, 0, sizeof lines);
    config.own_heartbeat = AGV_OWN_HEARTBEAT_FROZEN;
    TEST_ASSERT_FALSE(config_check(&config, &lines));
    TEST_ASSERT_EQUAL_STRING(
        "host_sim: own_heartbeat: has no effect on a shared bus; this value needs the gateway topology\n",
        scratch_said());
    config.trips.words[AGV_FAULT_COUNT / 32] |= 1u << (AGV_FAULT_COUNT % 32);
    config.own_heartbeat = AGV_OWN_HEARTBEAT_RUNNING;
    TEST_ASSERT_FALSE(config_check(&config, &lines));
    TEST_ASSERT_EQUAL_STRING("host_sim: the configuration is invalid\n", scratch_said());
    config.trips = defaults.trips;
    config.init_hold_ms = 0;
    TEST_ASSERT_FALSE(config_check(&config, &lines));
    TEST_ASSERT_EQUAL_STRING("host_sim: init_hold_ms: the value is out of range\n", scratch_said());
}

void test_files_that_cannot_be_read(void) {
    TEST_ASSERT_FALSE(config_file_load(scratch_path("none"), &config, &lines));
    (void)scratch_said_line("none: No such file or directory\n");
    TEST_ASSERT_FALSE(config_file_load("/", &config, &lines));
    (void)scratch_said_line("/: Is a directory\n");
    TEST_ASSERT_FALSE(config_file_load("/dev/zero", &config, &lines));
    (void)scratch_said_line("/dev/zero: the file is larger than 1 MiB\n");
}

/* Options win over the file, and the whole is checked with them. */
void test_options_change_what_the_file_says(void) {
    option_t rows[CONFIG_OPTIONS];
    config_options_t options;
    config_options_init(&options, rows);
    TEST_ASSERT_TRUE(config_options_make(&options, &config));
    assert_default();
    static const char text[] = "topology: gateway\nid_set: heading\nown_heartbeat: frozen\n";
    options.path = scratch_write("c.yaml", text, sizeof text - 1);
    options.id_set = AGV_ID_SET_TABLE;
    options.shadow = true;
    TEST_ASSERT_TRUE(config_options_make(&options, &config));
    TEST_ASSERT_EQUAL_UINT16(AGV_TOPOLOGY_GATEWAY, config.topology);
    TEST_ASSERT_EQUAL_UINT16(AGV_ID_SET_TABLE, config.id_set);
    TEST_ASSERT_EQUAL_UINT16(AGV_SHADOW_ON, config.shadow);
    options.topology = AGV_TOPOLOGY_SHARED;
    TEST_ASSERT_FALSE(config_options_make(&options, &config));
    (void)scratch_said_line(
        "c.yaml:3: own_heartbeat: has no effect on a shared bus; this value needs the gateway topology\n");
}

/* The configuration: defaults, refused values and their reasons, checksum. */
#include "agv/config.h"

#include <string.h>

#include "agv/names.h"
#include "causes.h"
#include "settings_expected.h"
#include "unity.h"

static agv_config_t config;

void setUp(void) {
    agv_config_defaults(&config);
}

static void expect_problem(agv_config_problem_t problem, uint16_t setting) {
    const agv_config_verdict_t verdict = agv_config_check(&config);
    TEST_ASSERT_EQUAL(problem, verdict.problem);
    TEST_ASSERT_EQUAL_UINT16(setting, verdict.setting);
}

static void expect_good(void) {
    expect_problem(AGV_CONFIG_OK, AGV_SETTING_COUNT);
}

static const char *name_of(uint16_t setting) {
    return agv_setting_info(setting)->name;
}

/* Shows: SUP-2, SUP-3, SUP-4, SUP-5, SUP-6, SUP-9, SUP-10, SUP-11, SUP-12, FSM-3, FSM-4, FSM-7, FSM-10, FSM-12, TOP-2,
   INT-2 */
void test_the_defaults_are_those_of_the_requirements(void) {
    TEST_ASSERT_EQUAL_UINT(SETTINGS_EXPECTED, AGV_SETTING_COUNT);
    expect_good();
    for (uint16_t i = 0; i < SETTINGS_EXPECTED; i++) {
        TEST_ASSERT_EQUAL_UINT16(i, SETTING_EXPECTED[i].setting);
        TEST_ASSERT_EQUAL_UINT16_MESSAGE(SETTING_EXPECTED[i].preset, agv_config_get(&config, i), name_of(i));
    }
}

/* A value that is alone wrong. For the limits of a press the other limit is moved out of the way. */
static void set_alone(uint16_t setting, uint16_t value) {
    setUp();
    config.reset_hold_ms = 500;
    config.reset_hold_max_ms = 30000;
    TEST_ASSERT_TRUE(agv_config_set(&config, setting, value));
}

static void expect_in_range(const setting_expected_t *row, uint16_t value, bool is_good) {
    set_alone(row->setting, value);
    if (row->scope == GATEWAY_ONLY) {
        config.topology = AGV_TOPOLOGY_GATEWAY;
    }
    const agv_config_verdict_t verdict = agv_config_check(&config);
    TEST_ASSERT_EQUAL_MESSAGE(is_good ? AGV_CONFIG_OK : AGV_CONFIG_OUT_OF_RANGE, verdict.problem,
                              name_of(row->setting));
    TEST_ASSERT_EQUAL_MESSAGE(is_good ? AGV_SETTING_COUNT : row->setting, verdict.setting, name_of(row->setting));
}

/* A deadline under three cycles; a period, count or time of zero; a choice beyond its words; and all other limits. */
/* Shows: INT-2 */
void test_every_setting_is_held_to_its_range(void) {
    for (uint16_t i = 0; i < SETTINGS_EXPECTED; i++) {
        const setting_expected_t *const row = &SETTING_EXPECTED[i];
        expect_in_range(row, row->lowest, true);
        expect_in_range(row, row->highest, true);
        if (row->highest < UINT16_MAX) {
            expect_in_range(row, (uint16_t)(row->highest + 1), false);
            expect_in_range(row, UINT16_MAX, false);
        }
        if (row->lowest > 0) {
            expect_in_range(row, (uint16_t)(row->lowest - 1), false);
            expect_in_range(row, 0, false);
        }
    }
}

/* Of the 2048 identifiers the 13 of the two sets are taken. */
/* Shows: INT-2, TOP-3 */
void test_the_status_frame_may_not_have_an_identifier_of_the_protocol(void) {
    static const uint16_t taken[] = {0x43F, 0x201, 0x363, 0x203, 0x168, 0x075, 0x065,
                                     0x0A3, 0x050, 0x067, 0x167, 0x267, 0x101};
    for (uint16_t id = 0; id <= 0x7FF; id++) {
        bool is_taken = false;
        for (size_t i = 0; i < sizeof taken / sizeof taken[0]; i++) {
            is_taken = is_taken || taken[i] == id;
        }
        config.status_frame_id = id;
        config.id_set = AGV_ID_SET_TABLE;
        TEST_ASSERT_EQUAL(is_taken ? AGV_CONFIG_ID_TWICE : AGV_CONFIG_OK, agv_config_check(&config).problem);
        config.id_set = AGV_ID_SET_HEADING;
        TEST_ASSERT_EQUAL(is_taken ? AGV_CONFIG_ID_TWICE : AGV_CONFIG_OK, agv_config_check(&config).problem);
    }
    config.status_frame_id = 0x201;
    expect_problem(AGV_CONFIG_ID_TWICE, AGV_SETTING_status_frame_id);
    config.status_frame_id = 0x800; /* no 11-bit identifier */
    expect_problem(AGV_CONFIG_OUT_OF_RANGE, AGV_SETTING_status_frame_id);
}

/* By hand: an identifier follows the ID set unless it was changed. */
/* Shows: P1 */
void test_the_set_is_the_preset_of_the_identifiers(void) {
    static const uint16_t heading[] = {0x43F, 0x168, 0x075, 0x065, 0x363, 0x0A3, 0x050, 0x067, 0x167, 0x267, 0x101};
    static const uint16_t table[] = {0x201, 0x168, 0x075, 0x065, 0x203, 0x0A3, 0x050, 0x067, 0x167, 0x267, 0x101};
    agv_ids_t ids;
    agv_config_ids(&config, &ids);
    TEST_ASSERT_EQUAL_HEX16_ARRAY(heading, ids.of, AGV_MSG_COUNT);
    config.id_set = AGV_ID_SET_TABLE;
    agv_config_ids(&config, &ids);
    TEST_ASSERT_EQUAL_HEX16_ARRAY(table, ids.of, AGV_MSG_COUNT);
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        agv_config_defaults(&config);
        config.id_set = AGV_ID_SET_TABLE;
        TEST_ASSERT_EQUAL_HEX16(heading[i], agv_config_get(&config, AGV_SETTING_ID + i));
        TEST_ASSERT_TRUE(agv_config_set(&config, AGV_SETTING_ID + i, 0x7FF));
        agv_config_ids(&config, &ids);
        expect_good();
        for (unsigned k = 0; k < AGV_MSG_COUNT; k++) {
            TEST_ASSERT_EQUAL_HEX16((k == i) ? 0x7FF : table[k], ids.of[k]);
        }
    }
}

/* Two messages must not have the same identifier; the error names the second one. */
/* Shows: INT-2, P1 */
void test_an_identifier_twice_is_refused(void) {
    for (uint16_t first = 0; first < AGV_MSG_COUNT; first++) {
        for (uint16_t second = (uint16_t)(first + 1); second < AGV_MSG_COUNT; second++) {
            setUp();
            (void)agv_config_set(&config, AGV_SETTING_ID + first, 0x300);
            (void)agv_config_set(&config, AGV_SETTING_ID + second, 0x300);
            expect_problem(AGV_CONFIG_ID_TWICE, (uint16_t)(AGV_SETTING_ID + second));
        }
    }
}

/* 201h is free in the set `heading` and used in `table`. Two swapped identifiers are no conflict. */
/* Shows: INT-2, P1 */
void test_which_identifiers_are_taken_depends_on_the_set(void) {
    config.id_gear_command = 0x201;
    expect_good();
    config.id_set = AGV_ID_SET_TABLE;
    expect_problem(AGV_CONFIG_ID_TWICE, AGV_SETTING_id_gear_command);
    setUp();
    config.id_gear_command = 0x075;
    expect_problem(AGV_CONFIG_ID_TWICE, AGV_SETTING_id_throttle_command);
    config.id_throttle_command = 0x168;
    expect_good();
}

/* Shows: INT-2, TOP-3 */
void test_the_status_frame_may_not_have_an_identifier_that_was_changed(void) {
    config.id_eps_status = 0x300;
    config.status_frame_id = 0x300;
    expect_problem(AGV_CONFIG_ID_TWICE, AGV_SETTING_status_frame_id);
    config.status_frame_id = 0x167; /* free on this vehicle, but part of the protocol */
    expect_problem(AGV_CONFIG_ID_TWICE, AGV_SETTING_status_frame_id);
    config.status_frame_id = 0x301;
    expect_good();
}

/* Settings without effect on a shared bus are refused there, all others are accepted. */
/* Shows: FSM-8, TOP-2, INT-2 */
void test_settings_without_effect_on_a_shared_bus_are_refused(void) {
    for (uint16_t i = 0; i < SETTINGS_EXPECTED; i++) {
        const setting_expected_t *const row = &SETTING_EXPECTED[i];
        set_alone(i, (row->preset == row->highest) ? row->lowest : row->highest);
        if (row->scope == GATEWAY_ONLY) {
            expect_problem(AGV_CONFIG_NEEDS_GATEWAY, i);
            config.topology = AGV_TOPOLOGY_GATEWAY;
        }
        expect_good();
    }
}

/* The error names the first of several settings. */
/* Shows: INT-2 */
void test_the_first_setting_without_effect_is_named(void) {
    config.fast_mm_s = 1;
    config.throttle_ceiling_pct = 50;
    expect_problem(AGV_CONFIG_NEEDS_GATEWAY, AGV_SETTING_throttle_ceiling_pct);
    config.throttle_ceiling_pct = 101; /* out of range is the more specific problem */
    expect_problem(AGV_CONFIG_OUT_OF_RANGE, AGV_SETTING_throttle_ceiling_pct);
}

/* No press could be long enough without being too long. */
/* Shows: FSM-3, INT-2 */
TEST_CASE(1000, 1000, 0)
TEST_CASE(5001, 5000, 0)
TEST_CASE(10000, 1000, 0)
TEST_CASE(1000, 1001, 1)
TEST_CASE(10000, 10001, 1)
void test_a_press_that_is_too_short_is_refused(unsigned hold_ms, unsigned most_ms, int good) {
    config.reset_hold_ms = (uint16_t)hold_ms;
    config.reset_hold_max_ms = (uint16_t)most_ms;
    if (good) {
        expect_good();
    } else {
        expect_problem(AGV_CONFIG_PRESS_TOO_SHORT, AGV_SETTING_reset_hold_max_ms);
    }
}

/* The status frame is on by default: its identifier is taken. */
/* Shows: INT-2, TOP-3 */
void test_a_message_may_not_have_the_identifier_of_the_status_frame(void) {
    config.id_eps_status = 0x7F0;
    expect_problem(AGV_CONFIG_ID_TWICE, AGV_SETTING_status_frame_id);
    config.status_frame_id = 0;
    expect_good();
}

/* ---- Values that weaken the supervision ---- */

static void expect_weakens(const setting_expected_t *row, int32_t value) {
    if ((value >= row->lowest) && (value <= row->highest)) {
        setUp();
        (void)agv_config_set(&config, row->setting, (uint16_t)value);
        TEST_ASSERT_EQUAL_MESSAGE(setting_expected_weakens(row, (uint16_t)value),
                                  agv_config_weakens(&config, row->setting), name_of(row->setting));
    }
}

/* Both limits and the default, and the values beside them. */
/* Shows: INT-2 */
void test_which_values_weaken_the_supervision(void) {
    for (uint16_t i = 0; i < SETTINGS_EXPECTED; i++) {
        for (int32_t beside = -1; beside <= 1; beside++) {
            expect_weakens(&SETTING_EXPECTED[i], SETTING_EXPECTED[i].lowest + beside);
            expect_weakens(&SETTING_EXPECTED[i], SETTING_EXPECTED[i].preset + beside);
            expect_weakens(&SETTING_EXPECTED[i], SETTING_EXPECTED[i].highest + beside);
        }
    }
}

/* Shows: INT-2 */
void test_no_default_weakens_and_nothing_beyond_the_last_setting(void) {
    for (uint32_t i = 0; i < AGV_SETTING_COUNT; i++) {
        TEST_ASSERT_FALSE(agv_config_weakens(&config, i));
    }
    memset(&config, 0xFF, sizeof config);
    TEST_ASSERT_FALSE(agv_config_weakens(&config, AGV_SETTING_COUNT));
    TEST_ASSERT_FALSE(agv_config_weakens(&config, UINT32_MAX));
}

/* Shows: INT-2 */
void test_which_faults_may_be_made_warnings(void) {
    for (unsigned fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        const bool may = !FAULT_ROW[fault].trip || ((FAULT_ROW[fault].flags & AGV_FAULT_FLAG_FIXED) == 0);
        const char *const name = agv_fault_name((agv_fault_t)fault);
        setUp();
        TEST_ASSERT_TRUE_MESSAGE(may || agv_config_is_trip(&config, fault), name);
        agv_fault_set_put(&config.trips, fault, false);
        TEST_ASSERT_FALSE_MESSAGE(agv_config_is_trip(&config, fault), name);
        const agv_config_verdict_t verdict = agv_config_check(&config);
        TEST_ASSERT_EQUAL_MESSAGE(may ? AGV_CONFIG_OK : AGV_CONFIG_CLASS_FIXED, verdict.problem, name);
        TEST_ASSERT_EQUAL_MESSAGE(may ? AGV_FAULT_NONE : fault, verdict.fault, name);
    }
    TEST_ASSERT_FALSE(agv_config_is_trip(&config, AGV_FAULT_NONE));
}

void test_the_highest_ranking_weak_fault_is_named(void) {
    config.trips = (agv_fault_set_t){0};
    TEST_ASSERT_EQUAL(AGV_FAULT_SELF_TEST_FAILED, agv_config_check(&config).fault);
}

/* A wrong setting is reported before a weak fault; the fault is named as well. */
void test_a_setting_is_reported_before_a_weak_fault(void) {
    config.trips = (agv_fault_set_t){0};
    config.mode_frames = 0;
    expect_problem(AGV_CONFIG_OUT_OF_RANGE, AGV_SETTING_mode_frames);
    TEST_ASSERT_EQUAL(AGV_FAULT_SELF_TEST_FAILED, agv_config_check(&config).fault);
}

/* Shows: INT-2 */
void test_every_fault_but_two_may_be_made_a_trip(void) {
    for (unsigned fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        if ((fault != AGV_FAULT_STARTUP_TIMEOUT) && (fault != AGV_FAULT_AI_BUS_OFF)) {
            agv_fault_set_put(&config.trips, fault, true);
            TEST_ASSERT_TRUE_MESSAGE(agv_config_is_trip(&config, fault), agv_fault_name((agv_fault_t)fault));
            expect_good();
        }
    }
}

/* As a trip it would keep INIT, which keeps the fault: a healthy vehicle could never be released. */
/* Shows: INT-2 */
void test_a_late_start_must_not_be_a_trip(void) {
    agv_fault_set_put(&config.trips, AGV_FAULT_STARTUP_TIMEOUT, true);
    expect_problem(AGV_CONFIG_CLASS_FIXED, AGV_SETTING_COUNT);
    TEST_ASSERT_EQUAL(AGV_FAULT_STARTUP_TIMEOUT, agv_config_check(&config).fault);
}

/* A shared bus has no AI side that could be bus-off. */
/* Shows: INT-2 */
void test_an_ai_side_that_is_bus_off_trips_on_a_gateway_only(void) {
    agv_fault_set_put(&config.trips, AGV_FAULT_AI_BUS_OFF, true);
    expect_problem(AGV_CONFIG_CLASS_FIXED, AGV_SETTING_COUNT);
    TEST_ASSERT_EQUAL(AGV_FAULT_AI_BUS_OFF, agv_config_check(&config).fault);
    config.topology = AGV_TOPOLOGY_GATEWAY;
    expect_good();
}

/* Any other topology is no gateway. It is out of range; the fault is named as well. */
void test_an_unknown_topology_has_no_ai_side(void) {
    agv_fault_set_put(&config.trips, AGV_FAULT_AI_BUS_OFF, true);
    config.topology = 2;
    expect_problem(AGV_CONFIG_OUT_OF_RANGE, AGV_SETTING_topology);
    TEST_ASSERT_EQUAL(AGV_FAULT_AI_BUS_OFF, agv_config_check(&config).fault);
}

/* Shows: INT-2 */
void test_bits_beyond_the_faults_are_refused(void) {
    for (unsigned bit = AGV_FAULT_COUNT; bit < 32 * AGV_FAULT_WORDS; bit++) {
        setUp();
        config.trips.words[bit / 32] |= 1u << (bit % 32);
        expect_problem(AGV_CONFIG_NO_SUCH_FAULT, AGV_SETTING_COUNT);
    }
}

void test_there_is_no_setting_beyond_the_last(void) {
    agv_config_t before = config;
    TEST_ASSERT_FALSE(agv_config_set(&config, AGV_SETTING_COUNT, 1));
    TEST_ASSERT_EQUAL_UINT16(0, agv_config_get(&config, AGV_SETTING_COUNT));
    TEST_ASSERT_EQUAL_MEMORY(&before, &config, sizeof config);
    TEST_ASSERT_EQUAL_UINT16(50, agv_config_get(&config, AGV_SETTING_vcu_heartbeat_timeout_ms));
    memset(&config, 0xFF, sizeof config); /* and bits beyond the last fault */
    TEST_ASSERT_EQUAL_UINT16(0, agv_config_get(&config, AGV_SETTING_COUNT));
}

/* CRC-32 as zlib's, a bit at a time. */
static uint32_t crc_bytes(uint32_t crc, uint32_t value, unsigned bytes) {
    for (unsigned bit = 0; bit < 8 * bytes; bit++) {
        const uint32_t low = (crc ^ (value >> bit)) & 1;
        crc = (crc >> 1) ^ (low * 0xEDB88320u);
    }
    return crc;
}

/* Over the settings, two bytes each, and the classes, four bytes a word, the low byte first. */
/* Shows: TOP-3 */
void test_the_checksum_is_a_crc_32_of_the_settings_and_classes(void) {
    uint32_t crc = UINT32_MAX;
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        crc = crc_bytes(crc, agv_config_get(&config, i), 2);
    }
    for (unsigned i = 0; i < AGV_FAULT_WORDS; i++) {
        crc = crc_bytes(crc, config.trips.words[i], 4);
    }
    TEST_ASSERT_EQUAL_HEX32(~crc, agv_config_checksum(&config));
    TEST_ASSERT_EQUAL_HEX32(0xCBF43926u,
                            ~crc_bytes(crc_bytes(crc_bytes(UINT32_MAX, 0x34333231u, 4), 0x38373635u, 4), 0x39, 1));
}

/* Shows: INT-5 */
void test_every_flipped_bit_changes_the_checksum(void) {
    const uint32_t checksum = agv_config_checksum(&config);
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        for (unsigned bit = 0; bit < 16; bit++) {
            const uint16_t value = agv_config_get(&config, i);
            (void)agv_config_set(&config, i, (uint16_t)(value ^ (1u << bit)));
            TEST_ASSERT_TRUE(agv_config_checksum(&config) != checksum);
            (void)agv_config_set(&config, i, value);
        }
    }
    for (unsigned bit = 0; bit < 32 * AGV_FAULT_WORDS; bit++) {
        config.trips.words[bit / 32] ^= 1u << (bit % 32);
        TEST_ASSERT_TRUE(agv_config_checksum(&config) != checksum);
        config.trips.words[bit / 32] ^= 1u << (bit % 32);
    }
    TEST_ASSERT_EQUAL_HEX32(checksum, agv_config_checksum(&config));
}

/* A supervisor that is started with an invalid configuration trips. Which ones are invalid: tests/unit/base/test_config.c. */
#include <string.h>

#include "expect.h"
#include "fixture.h"
#include "unity.h"

static fixture_t f;
static agv_config_t config;

void setUp(void) {
    fixture_init(&f);
    agv_config_defaults(&config);
}

/* Shared bus, set heading, P at once. Each of these was at its default, or not valid. */
static void expect_default_wiring(const agv_config_t *used, const char *what) {
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(0, used->topology, what);
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(0, used->id_set, what);
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(0, used->park, what);
}

static void expect_refused_at_start(const char *what) {
    f.what = what;
    f.config = config;
    fixture_start(&f);
    expect_tripped(&f, AGV_FAULT_CONFIG_INVALID);
    expect_output(&f, false);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(3, f.sent_count, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(AGV_CONFIG_OK, agv_config_check(agv_supervisor_config(&f.supervisor)).problem, what);
    expect_default_wiring(agv_supervisor_config(&f.supervisor), what);
    setUp();
}

/* Shows: INT-2, CONFIG_INVALID, FSM-9 */
void test_a_supervisor_with_an_invalid_configuration_trips_and_uses_the_defaults(void) {
    config.tx_stalled_ms = 0;
    expect_refused_at_start("out of range");
    config.topology = 7;
    expect_refused_at_start("no topology");
    config.id_set = 9;
    expect_refused_at_start("no ID set");
    config.park = 5;
    expect_refused_at_start("no time for P");
    config.id_throttle_command = 0x168;
    expect_refused_at_start("an identifier twice");
    config.own_heartbeat = AGV_OWN_HEARTBEAT_FROZEN;
    expect_refused_at_start("needs the gateway");
    agv_fault_set_put(&config.trips, AGV_FAULT_BUS_OFF, false);
    expect_refused_at_start("too weak");
    memset(&config.trips, 0xFF, sizeof config.trips);
    expect_refused_at_start("no such fault");
}

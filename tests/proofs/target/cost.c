/* What the entry points cost in ordinary traffic: a second or more in every state, in both topologies. See meter.c. */
#include "expect.h"
#include "fixture.h"
#include "unity.h"
#include "walk.h"

enum { SECOND_MS = 1000 };

static fixture_t f;

void setUp(void) {
    fixture_init(&f);
    f.long_run = true;
}

static void through_all_states(uint16_t topology) {
    f.config.topology = topology;
    fixture_active(&f);
    fixture_run(&f, SECOND_MS);
    walk_trip(&f);
    fixture_run(&f, SECOND_MS);
    fixture_vehicle_confirms(&f);
    fixture_run(&f, 2 * SECOND_MS);
    expect_state(&f, AGV_STATE_SAFE);
    fixture_press(&f, SECOND_MS);
    expect_state(&f, AGV_STATE_STANDBY);
}

void test_a_second_in_every_state_on_a_shared_bus(void) {
    through_all_states(AGV_TOPOLOGY_SHARED);
}

void test_a_second_in_every_state_of_a_gateway(void) {
    through_all_states(AGV_TOPOLOGY_GATEWAY);
}

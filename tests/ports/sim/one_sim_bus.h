/* Common start of the bus tests: one bus of 500 kbit/s (2 us a bit), new before each test. Included by the test itself. */
#ifndef ONE_SIM_BUS_H
#define ONE_SIM_BUS_H

#include <string.h>

#include "sim_bus_fixture.h"
#include "unity.h"

static fixture_t fixture;
static sim_bus_t *const bus = &fixture.bus;

void setUp(void) {
    memset(&fixture, 0xA5, sizeof fixture);
    fixture_init(&fixture, 500000);
}

static inline void assert_state(hal_can_state_t expected, sim_bus_node_t node) {
    TEST_ASSERT_EQUAL_INT(expected, status_of(&fixture, node).state);
}

static inline void assert_state_at(uint64_t us, hal_can_state_t expected, sim_bus_node_t node) {
    sim_bus_run_until(bus, us);
    assert_state(expected, node);
}

/* Frames and error frames since the start. */
static inline void assert_events_at(uint64_t us, unsigned count) {
    sim_bus_run_until(bus, us);
    TEST_ASSERT_EQUAL_UINT(count, fixture.event_count);
}

static inline void send_and_run_until(sim_bus_node_t node, uint32_t id, uint8_t length, uint8_t first,
                                      uint64_t until_us) {
    send(&fixture, node, id, length, first);
    sim_bus_run_until(bus, until_us);
}

/* Only these two nodes have power; A twice: A alone. */
static inline void only_a_and(sim_bus_node_t other) {
    for (sim_bus_node_t node = B; node < FIXTURE_NODES; node++) {
        sim_bus_set_power(bus, node, node == other);
    }
}

#endif

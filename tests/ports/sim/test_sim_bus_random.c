/* The simulated bus under random load with random errors: rules that always hold. */
#include <string.h>

#include "sim_bus_fixture.h"
#include "unity.h"

#define ROUNDS 20000u
#define WAITING_MAX (FIXTURE_NODES * 8u)

/* A frame that was accepted and has not arrived yet. */
typedef struct {
    uint32_t id;
    uint64_t taken_us;
    uint32_t number;
    sim_bus_node_t node;
} waiting_t;

typedef struct {
    fixture_t fixture;
    waiting_t waiting[WAITING_MAX];
    unsigned count;
    unsigned arrived;
    unsigned merged;
    unsigned errors;
    uint64_t free_us;
} load_t;

static load_t load;
static sim_bus_t *const bus = &load.fixture.bus;
static uint32_t seed;

static uint32_t random_below(uint32_t limit) {
    seed = seed * 1664525 + 1013904223;
    return (seed >> 8) % limit;
}

/* No frame that was ready when this frame began has a higher priority. */
static void assert_won(const sim_bus_event_t *event) {
    for (unsigned i = 0; i < load.count; i++) {
        if (load.waiting[i].taken_us <= event->start_us) {
            TEST_ASSERT_TRUE(load.waiting[i].id >= event->frame->id);
        }
    }
}

/* The frame was waiting, and it is the oldest one of its node with this identifier. */
static void take_out(const sim_bus_event_t *event, sim_bus_node_t node) {
    uint32_t number;
    memcpy(&number, event->frame->data, sizeof number);
    for (unsigned i = 0; i < load.count; i++) {
        if (load.waiting[i].node == node && load.waiting[i].id == event->frame->id) {
            TEST_ASSERT_EQUAL_UINT32(load.waiting[i].number, number);
            TEST_ASSERT_TRUE(load.waiting[i].taken_us <= event->start_us);
            load.count--;
            memmove(&load.waiting[i], &load.waiting[i + 1], (load.count - i) * sizeof load.waiting[0]);
            return;
        }
    }
    TEST_FAIL_MESSAGE("a frame arrived that was not waiting");
}

static void watch(void *ctx, const sim_bus_event_t *event) {
    (void)ctx;
    TEST_ASSERT_TRUE(event->start_us >= load.free_us);
    TEST_ASSERT_TRUE(event->end_us > event->start_us);
    TEST_ASSERT_EQUAL_UINT64(event->end_us, sim_bus_now_us(bus));
    load.free_us = event->end_us + SIM_BUS_INTERFRAME_BITS * 2;
    assert_won(event);
    if (event->error) {
        load.errors++;
        return;
    }
    load.arrived++;
    load.merged += (event->senders & (event->senders - 1)) != 0 ? 1 : 0;
    for (sim_bus_node_t node = 0; node < FIXTURE_NODES; node++) {
        if ((event->senders >> node & 1) != 0) {
            take_out(event, node);
        }
    }
}

static void send_as(sim_bus_node_t node, uint32_t id, uint32_t number) {
    hal_can_frame_t frame = {.id = id, .length = 4};
    memcpy(frame.data, &number, sizeof number);
    if (sim_bus_send(bus, node, &frame)) {
        TEST_ASSERT_TRUE(load.count < WAITING_MAX);
        load.waiting[load.count++] = (waiting_t){id, sim_bus_now_us(bus), number, node};
    }
}

/* Each node has its own identifiers, so there are no collisions. Sometimes two nodes send the same frame, which
 * merges. */
static void send_random(uint32_t number) {
    if (random_below(10) == 0) {
        send_as(A, 20, 7);
        send_as(B, 20, 7);
    } else {
        const sim_bus_node_t node = (sim_bus_node_t)random_below(FIXTURE_NODES);
        send_as(node, random_below(10) * 8 + node, number);
    }
}

/* All nodes stay error active, so none has a suspend time. */
static void forgive(void) {
    for (sim_bus_node_t node = 0; node < FIXTURE_NODES; node++) {
        sim_bus_set_error_counters(bus, node, 0, 0);
    }
}

static void init(void) {
    memset(&load, 0, sizeof load);
    fixture_init(&load.fixture, 500000);
    TEST_ASSERT_TRUE(sim_bus_add_tap(bus, watch, NULL));
    seed = 1;
}

void setUp(void) {
    init();
}

void test_every_frame_arrives_once_in_order_and_the_lowest_first(void) {
    for (uint32_t round = 0; round < ROUNDS; round++) {
        forgive();
        if (random_below(20) == 0) {
            sim_bus_corrupt_all(bus, random_below(3));
        }
        for (uint32_t i = random_below(3); i > 0; i--) {
            send_random(round * 4 + i);
        }
        const uint64_t until_us = sim_bus_now_us(bus) + random_below(400);
        sim_bus_run_until(bus, until_us);
        TEST_ASSERT_TRUE(sim_bus_due_us(bus) > until_us);
        TEST_ASSERT_EQUAL_UINT64(until_us, sim_bus_now_us(bus));
    }
    sim_bus_corrupt_all(bus, 0);
    sim_bus_run_until(bus, sim_bus_now_us(bus) + 1000000);
    TEST_ASSERT_EQUAL_UINT(0, load.count);
    TEST_ASSERT_TRUE(load.arrived > 5000);
    TEST_ASSERT_TRUE(load.merged > 100);
    TEST_ASSERT_TRUE(load.errors > 500);
}

static void disturb(sim_bus_node_t node) {
    switch (random_below(12)) {
    case 0:
        sim_bus_set_power(bus, node, random_below(2) != 0);
        break;
    case 1:
        sim_bus_set_plugged(bus, node, random_below(2) != 0);
        break;
    case 2:
        sim_bus_set_stalled(bus, node, random_below(2) != 0);
        break;
    case 3:
        sim_bus_purge(bus, node);
        break;
    case 4:
        sim_bus_recover(bus, node);
        break;
    case 5:
        sim_bus_corrupt_sent(bus, node, random_below(20));
        break;
    case 6:
        sim_bus_corrupt_received(bus, node, random_below(20));
        break;
    case 7:
        sim_bus_set_error_counters(bus, node, (uint16_t)random_below(300), (uint16_t)random_below(300));
        break;
    default:
        (void)send(&load.fixture, node, random_below(8), (uint8_t)random_below(9), (uint8_t)random_below(4));
        break;
    }
}

static void assert_sane(void) {
    for (sim_bus_node_t node = 0; node < FIXTURE_NODES; node++) {
        const hal_can_status_t status = status_of(&load.fixture, node);
        TEST_ASSERT_TRUE(sim_bus_waiting(bus, node) <= 8);
        TEST_ASSERT_TRUE(tec_of(&load.fixture, node) <= 300 && rec_of(&load.fixture, node) <= 255);
        TEST_ASSERT_TRUE(status.tx_pending_ms == 0 || sim_bus_waiting(bus, node) > 0);
        if (status.state == HAL_CAN_BUS_OFF) {
            TEST_ASSERT_EQUAL_size_t(0, sim_bus_waiting(bus, node));
        }
        (void)received_by(&load.fixture, node);
    }
}

/* After any disturbances in any order all nodes work again when they are set right. */
void test_any_disturbance_passes(void) {
    fixture_init(&load.fixture, 500000);
    seed = 2;
    for (uint32_t round = 0; round < ROUNDS; round++) {
        disturb((sim_bus_node_t)random_below(FIXTURE_NODES));
        const uint64_t until_us = sim_bus_now_us(bus) + random_below(200);
        sim_bus_run_until(bus, until_us);
        TEST_ASSERT_TRUE(sim_bus_due_us(bus) > until_us);
        assert_sane();
    }
    for (sim_bus_node_t node = 0; node < FIXTURE_NODES; node++) {
        sim_bus_set_power(bus, node, false);
        sim_bus_set_power(bus, node, true);
        sim_bus_set_plugged(bus, node, true);
        sim_bus_set_stalled(bus, node, false);
        sim_bus_corrupt_sent(bus, node, 0);
        sim_bus_corrupt_received(bus, node, 0);
    }
    sim_bus_run_until(bus, sim_bus_now_us(bus) + 1000);
    for (sim_bus_node_t node = 0; node < FIXTURE_NODES; node++) {
        TEST_ASSERT_TRUE(send(&load.fixture, node, 0x100u + node, 8, 0));
    }
    sim_bus_run_until(bus, sim_bus_now_us(bus) + 2000);
    for (sim_bus_node_t node = 0; node < FIXTURE_NODES; node++) {
        TEST_ASSERT_EQUAL_UINT(3, received_by(&load.fixture, node));
    }
}

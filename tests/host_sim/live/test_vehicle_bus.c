/* The time of a simulated vehicle on a bus. Sockets and clock are those of the test. */
#include "live/vehicle_bus.h"

#include "unity.h"

enum { US_PER_MS = 1000, LATE_MS = 70 };

static uint64_t now_us;
static uint64_t delay_in_read_us;

uint64_t linux_clock_now_us(const linux_clock_t *clock) {
    (void)clock;
    return now_us;
}

uint64_t linux_clock_of_stamp_after(const linux_clock_t *clock, uint64_t stamp_us, uint64_t last_us) {
    (void)clock;
    (void)last_us;
    return stamp_us;
}

uint64_t linux_clock_of_stamp(const linux_clock_t *clock, uint64_t stamp_us) {
    (void)clock;
    return stamp_us;
}

void linux_clock_start(linux_clock_t *clock) {
    (void)clock;
}

bool linux_can_open(linux_can_t *can, const char *interface, const linux_can_options_t *options, char *error) {
    (void)interface;
    (void)options;
    (void)error;
    can->fd = 0;
    return true;
}

void linux_can_close(linux_can_t *can) {
    can->fd = -1;
}

linux_can_read_t linux_can_read(linux_can_t *can, linux_can_record_t *record) {
    (void)can;
    (void)record;
    now_us += delay_in_read_us;
    delay_in_read_us = 0;
    return LINUX_CAN_NOTHING;
}

linux_can_write_t linux_can_write(linux_can_t *can, const hal_can_frame_t *frame) {
    (void)can;
    (void)frame;
    return LINUX_CAN_TAKEN;
}

static vehicle_bus_t bus;

void setUp(void) {
    static const linux_clock_t clock;
    vehicle_bus_config_t config = {.interfaces = {"can0"}, .clock = &clock};
    now_us = 5 * US_PER_MS;
    delay_in_read_us = 0;
    vehicle_defaults(&config.vehicle);
    TEST_ASSERT_TRUE(vehicle_bus_open(&bus, &config));
}

void tearDown(void) {
    vehicle_bus_close(&bus);
}

/* Frames that arrive in a delay lie unread: no deadline of a node may count it yet. */
void test_the_time_of_a_tick_is_that_before_its_frames_were_read(void) {
    delay_in_read_us = LATE_MS * US_PER_MS;
    TEST_ASSERT_TRUE(vehicle_bus_tick(&bus));
    TEST_ASSERT_EQUAL_UINT64(5, bus.now_ms);
    TEST_ASSERT_TRUE(vehicle_bus_tick(&bus));
    TEST_ASSERT_EQUAL_UINT64(5 + LATE_MS, bus.now_ms);
}

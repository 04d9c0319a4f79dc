/* A supervisor in a program that is late: frames lie in the sockets. Port and clock are those of the test, and so is the time
 * that a call takes. */
#include "live/node.h"

#include "agv/supervisor.h"
#include "hal_linux/linux_hal.h"
#include "unity.h"
#include "vehicle/vehicle.h"

enum {
    US_PER_MS = 1000,
    QUEUE_MAX = 8192,
    LATE_MS = 70,
    BUSY_LATE_MS = 90,
    BUSY_ID = 0x7FF,
    READ_AT_ONCE = 4096,
    LATER_AT_ONCE = 256
};

/* What the sockets hold: frames and their stamps. */
static struct {
    uint64_t at_us;
    vehicle_node_t from;
    hal_can_side_t side;
    hal_can_frame_t frame;
} queue[QUEUE_MAX];
static size_t queue_begin;
static size_t queue_end;

static uint64_t now_us;
static uint64_t delay_in_read_us;
static uint64_t delay_in_tick_us;
static unsigned busy_per_ms; /* other frames on the bus */
static bool is_endless;
static uint64_t endless_ahead_us;
static unsigned frames_read;
static unsigned feeds;
static bool output_closed;
static hal_t *port;

static vehicle_t vehicle;
static agv_config_t config;
static node_t *node;
static uint64_t latest_event_ms;
static unsigned trips;

static void put(vehicle_node_t from, hal_can_side_t side, const hal_can_frame_t *frame) {
    TEST_ASSERT_TRUE(queue_end < QUEUE_MAX);
    queue[queue_end].at_us = now_us;
    queue[queue_end].from = from;
    queue[queue_end].side = side;
    queue[queue_end].frame = *frame;
    queue_end++;
}

static void on_vehicle_sent(void *ctx, vehicle_node_t from, hal_can_side_t side, const hal_can_frame_t *frame) {
    (void)ctx;
    put(from, side, frame);
}

/* The nodes of the vehicle hear each other. */
static void deliver(size_t first) {
    for (size_t i = first; i < queue_end; i++) {
        for (int to = 0; to < VEHICLE_NODES; to++) {
            if (to != (int)queue[i].from) {
                vehicle_receive(&vehicle, (vehicle_node_t)to, now_us / US_PER_MS, &queue[i].frame);
            }
        }
    }
}

/* Time passes on the bus, a millisecond at a time, whatever the supervisor does. */
static void pass_us(uint64_t us) {
    static const hal_can_frame_t other = {.id = BUSY_ID, .length = 8};
    for (const uint64_t end_us = now_us + us; now_us < end_us;) {
        now_us += US_PER_MS;
        const size_t first = queue_end;
        vehicle_tick(&vehicle, now_us / US_PER_MS);
        deliver(first);
        for (unsigned i = 0; i < busy_per_ms; i++) {
            put(VEHICLE_ROGUE, HAL_CAN_VEHICLE, &other);
        }
    }
}

static void delay(uint64_t *us) {
    const uint64_t length_us = *us;
    *us = 0;
    pass_us(length_us);
}

uint64_t linux_hal_now_us(const hal_t *hal) {
    (void)hal;
    return now_us;
}

int linux_hal_fd(const hal_t *hal, hal_can_side_t side) {
    (void)hal;
    (void)side;
    return -1;
}

/* Empty, and then the program loses the processor before it goes on. */
bool linux_hal_receive(hal_t *hal, hal_can_side_t *side, hal_can_frame_t *frame, uint64_t *at_us) {
    (void)hal;
    frames_read++;
    if (is_endless) {
        *frame = (hal_can_frame_t){.id = BUSY_ID, .length = 8};
        *at_us = now_us + endless_ahead_us;
        return true;
    }
    if (queue_begin == queue_end) {
        queue_begin = queue_end = 0;
        delay(&delay_in_read_us);
        return false;
    }
    *side = queue[queue_begin].side;
    *frame = queue[queue_begin].frame;
    *at_us = queue[queue_begin].at_us;
    frame->time_ms = (uint32_t)(*at_us / US_PER_MS);
    queue_begin++;
    return true;
}

bool linux_hal_tick(hal_t *hal) {
    (void)hal;
    delay(&delay_in_tick_us);
    return false;
}

void linux_hal_finish(hal_t *hal) {
    (void)hal;
}

void linux_hal_close(hal_t *hal) {
    (void)hal;
}

static bool can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame) {
    (void)hal;
    (void)side;
    (void)frame;
    return true;
}

static void ignore_side(hal_t *hal, hal_can_side_t side) {
    (void)hal;
    (void)side;
}

static void can_status(hal_t *hal, hal_can_side_t side, hal_can_status_t *status) {
    (void)hal;
    (void)side;
    *status = (hal_can_status_t){.state = HAL_CAN_ERROR_ACTIVE};
}

static uint32_t clock_now_ms(hal_t *hal) {
    (void)hal;
    return (uint32_t)(now_us / US_PER_MS);
}

static void led_set(hal_t *hal, bool on) {
    (void)hal;
    (void)on;
}

static void safety_output_set(hal_t *hal, bool closed) {
    (void)hal;
    output_closed = closed;
}

static hal_reset_cause_t reset_cause(hal_t *hal) {
    (void)hal;
    return HAL_RESET_POWER_ON;
}

static void watchdog_feed(hal_t *hal) {
    (void)hal;
    feeds++;
}

static size_t read_latch(hal_t *hal, void *record, size_t size) {
    (void)hal;
    (void)record;
    (void)size;
    return 0;
}

static bool write_record(hal_t *hal, const void *record, size_t size) {
    (void)hal;
    (void)record;
    (void)size;
    return true;
}

static void inputs_read(hal_t *hal, hal_inputs_t *inputs) {
    (void)hal;
    *inputs = (hal_inputs_t){.output_feedback = HAL_CONTACT_NONE};
}

static bool second_ms(hal_t *hal, uint32_t *time_ms) {
    (void)hal;
    (void)time_ms;
    return false;
}

static uint32_t self_test(hal_t *hal) {
    (void)hal;
    return 0;
}

static const hal_ops_t ops = {
    .can_send = can_send,
    .can_purge = ignore_side,
    .can_recover = ignore_side,
    .can_status = can_status,
    .clock_now_ms = clock_now_ms,
    .led_set = led_set,
    .safety_output_set = safety_output_set,
    .reset_cause = reset_cause,
    .watchdog_feed = watchdog_feed,
    .store_read_latch = read_latch,
    .store_write_latch = write_record,
    .store_append = write_record,
    .inputs_read = inputs_read,
    .clock_second_ms = second_ms,
    .self_test = self_test,
};

bool linux_hal_open(hal_t *hal, const linux_hal_config_t *given, char *error) {
    (void)given;
    (void)error;
    *hal = (hal_t){.ops = &ops};
    port = hal;
    return true;
}

static void on_event(void *ctx, const session_event_t *event) {
    (void)ctx;
    TEST_ASSERT_TRUE_MESSAGE(event->t_ms >= latest_event_ms, "the time of events went back");
    latest_event_ms = event->t_ms;
    if (!event->is_led && event->recorded.kind == AGV_EVENT_STATE && event->recorded.b == AGV_STATE_TRIPPED) {
        trips++;
    }
}

/* A tick of the loop, a millisecond after the last one. */
static void run_ms(unsigned ms) {
    for (unsigned i = 0; i < ms; i++) {
        pass_us(US_PER_MS);
        (void)node_tick(node);
    }
}

static agv_state_t state(void) {
    return agv_supervisor_state(&node_session(node)->supervisor);
}

/* A healthy vehicle, and a supervisor in STANDBY. */
void setUp(void) {
    vehicle_config_t build;
    now_us = 0;
    delay_in_read_us = delay_in_tick_us = 0;
    queue_begin = queue_end = 0;
    busy_per_ms = trips = feeds = 0;
    is_endless = false;
    endless_ahead_us = 0;
    latest_event_ms = 0;
    agv_config_defaults(&config);
    vehicle_defaults(&build);
    agv_config_ids(&config, &build.ids);
    vehicle_init(&vehicle, &build, on_vehicle_sent, NULL);
    const node_config_t nodes = {.config = &config, .interfaces = {"can0"}, .on_event = on_event};
    node = node_open(&nodes);
    TEST_ASSERT_NOT_NULL(node);
    node_start(node);
    run_ms(2000);
    TEST_ASSERT_EQUAL(AGV_STATE_STANDBY, state());
    TEST_ASSERT_TRUE(output_closed);
}

void tearDown(void) {
    node_close(node);
}

/* Shows: SUP-2 */
void test_frames_that_arrive_between_reading_and_the_tick_are_no_silence(void) {
    delay_in_read_us = LATE_MS * US_PER_MS;
    run_ms(500);
    delay_in_tick_us = LATE_MS * US_PER_MS;
    run_ms(500);
    TEST_ASSERT_EQUAL_UINT(0, trips);
    TEST_ASSERT_EQUAL(AGV_STATE_STANDBY, state());
}

/* Shows: SUP-2, TIM-3 */
void test_on_a_busy_bus_all_frames_from_before_a_late_tick_are_handled(void) {
    busy_per_ms = 8;
    run_ms(500);
    pass_us(BUSY_LATE_MS * US_PER_MS); /* 720 frames and more lie there */
    (void)node_tick(node);
    run_ms(500);
    TEST_ASSERT_EQUAL_UINT(0, trips);
    TEST_ASSERT_EQUAL(AGV_STATE_STANDBY, state());
    TEST_ASSERT_TRUE(output_closed);
}

/* Shows: TIM-3 */
void test_on_a_busy_bus_every_tick_feeds(void) {
    busy_per_ms = 8;
    feeds = 0;
    run_ms(500);
    TEST_ASSERT_EQUAL_UINT(500, feeds);
}

/* Shows: TIM-4 */
void test_a_tick_that_is_too_late_is_still_found(void) {
    delay_in_tick_us = 150 * US_PER_MS;
    run_ms(2);
    TEST_ASSERT_EQUAL_UINT(1, trips);
}

/* Shows: TIM-3 */
void test_a_receive_path_that_never_gets_done_does_not_check_in(void) {
    run_ms(1);
    feeds = 0;
    frames_read = 0;
    is_endless = true;
    (void)node_tick(node);
    const unsigned read_in_tick = frames_read; /* and then the tick came */
    for (unsigned i = 0; i < 120; i++) {
        now_us += US_PER_MS;
        (void)node_tick(node);
    }
    TEST_ASSERT_EQUAL_UINT(0, feeds);
    TEST_ASSERT_FALSE(output_closed);
    TEST_ASSERT_EQUAL_UINT(READ_AT_ONCE, read_in_tick);
}

/* The first frame after the tick's time shows that all before it were handled. */
void test_a_bus_that_does_not_pause_for_the_tick_is_no_backlog(void) {
    run_ms(1);
    feeds = 0;
    frames_read = 0;
    is_endless = true;
    endless_ahead_us = 1;
    now_us += US_PER_MS;
    (void)node_tick(node);
    TEST_ASSERT_EQUAL_UINT(1, feeds);
    TEST_ASSERT_EQUAL_UINT(LATER_AT_ONCE, frames_read);
}

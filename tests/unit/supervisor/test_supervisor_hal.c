/*
 * The supervisor's calls of the HAL: at the start, at a trip, in a tick, at the end of INIT. The mocks are strict:
 * another call, a missing call or another order fails. Before the tested part of a test stubs replace them.
 */
#include <string.h>

#include "agv/checksum.h"
#include "keep/latch.h"
#include "mock_can.h"
#include "mock_clock.h"
#include "mock_inputs.h"
#include "mock_led.h"
#include "mock_reset.h"
#include "mock_safety_output.h"
#include "mock_self_test.h"
#include "mock_store.h"
#include "mock_watchdog.h"
#include "supervisor/core.h"
#include "unity.h"

/* The context of a port; the core never accesses its members. */
struct hal {
    int unused;
};
static hal_t hal;
static agv_recorder_t recorder;
static agv_supervisor_t supervisor;
static agv_core_t *core;
static agv_config_t config;
static const agv_ports_t ports = {&hal, &recorder, NULL};
static uint32_t now_ms;
static uint8_t counter;     /* of all that have one */
static uint8_t mode;        /* 363h byte 7: 40h manual, 80h autopilot */
static uint8_t wheel_speed; /* 101h, both wheels, low byte */
static bool hal_takes;      /* what the stub of hal_can_send returns */
static bool closed;         /* the output, as last set through the stub */
static unsigned written;    /* events that were written to flash */
static hal_inputs_t inputs; /* what the board reports at every tick */
static uint32_t failed;     /* parts that fail their test */
static uint32_t second_ms;  /* the second clock; 0: the board has none */

static bool send_stub(hal_t *port, hal_can_side_t side, const hal_can_frame_t *frame, int calls) {
    (void)port, (void)side, (void)frame, (void)calls;
    return hal_takes;
}

static void status_stub(hal_t *port, hal_can_side_t side, hal_can_status_t *status, int calls) {
    (void)port, (void)side, (void)calls;
    *status = (hal_can_status_t){0};
}

static void output_stub(hal_t *port, bool close, int calls) {
    (void)port, (void)calls;
    closed = close;
}

static bool append_stub(hal_t *port, const void *record, size_t size, int calls) {
    (void)port, (void)record, (void)size, (void)calls;
    written++;
    return true;
}

static void inputs_stub(hal_t *port, hal_inputs_t *read, int calls) {
    (void)port, (void)calls;
    *read = inputs;
}

static bool second_stub(hal_t *port, uint32_t *time_ms, int calls) {
    (void)port, (void)calls;
    *time_ms = second_ms;
    return second_ms != 0;
}

static uint32_t self_test_stub(hal_t *port, int calls) {
    (void)port, (void)calls;
    return failed;
}

/* What is only read may be read in any order. */
static void always_use_stubs(void) {
    inputs = (hal_inputs_t){0};
    failed = 0;
    second_ms = 0;
    hal_inputs_read_Stub(inputs_stub);
    hal_clock_second_ms_Stub(second_stub);
    hal_self_test_Stub(self_test_stub);
}

static void use_stubs(void) {
    hal_can_send_Stub(send_stub);
    hal_can_status_Stub(status_stub);
    hal_safety_output_set_Stub(output_stub);
    hal_can_purge_Ignore();
    hal_led_set_Ignore();
    hal_reset_cause_IgnoreAndReturn(HAL_RESET_POWER_ON);
    hal_store_read_latch_IgnoreAndReturn(0);
    hal_store_write_latch_IgnoreAndReturn(true);
    hal_store_append_Stub(append_stub);
    hal_watchdog_feed_Ignore();
}

/* From here on the test expects every call, in order. */
static void be_strict(void) {
    hal_can_send_Stub(NULL);
    hal_can_status_Stub(NULL);
    hal_safety_output_set_Stub(NULL);
    hal_can_purge_StopIgnore();
    hal_led_set_StopIgnore();
    hal_reset_cause_StopIgnore();
    hal_store_read_latch_StopIgnore();
    hal_store_write_latch_StopIgnore();
    hal_store_append_Stub(NULL);
    hal_watchdog_feed_StopIgnore();
}

void setUp(void) {
    memset(&recorder, 0, sizeof recorder);
    memset(&supervisor, 0xA5, sizeof supervisor);
    core = agv_core_of(&supervisor);
    agv_config_defaults(&config);
    now_ms = 1000;
    mode = 0x40;
    wheel_speed = 0;
    hal_takes = true;
    closed = false;
    written = 0;
    always_use_stubs();
}

/* --- expectations --- */

static void expect_status(hal_can_side_t side, hal_can_state_t state) {
    static hal_can_status_t status;
    status = (hal_can_status_t){.state = state};
    hal_can_status_Expect(&hal, side, NULL);
    hal_can_status_IgnoreArg_status();
    hal_can_status_ReturnThruPtr_status(&status);
}

/* The mocks keep the pointer until the call comes. */
static const hal_can_frame_t *kept(hal_can_frame_t frame) {
    static hal_can_frame_t frames[16];
    static unsigned next;
    frames[next] = frame;
    const hal_can_frame_t *it = &frames[next];
    next = (next + 1) % 16;
    return it;
}

static void expect_frame(uint32_t id, uint8_t at, uint8_t value, uint8_t last) {
    hal_can_frame_t frame = {.id = id, .time_ms = now_ms, .length = 8};
    frame.data[at] = value;
    frame.data[7] = last;
    hal_can_send_ExpectAndReturn(&hal, HAL_CAN_VEHICLE, kept(frame), true);
}

/* 075h 0; 168h P; 43Fh hazard, autopilot off, headlight on, running counter. */
static void expect_safe_commands(uint8_t signal_counter) {
    expect_frame(0x075, 0, 0, 0);
    expect_frame(0x168, 0, 8, 0);
    expect_frame(0x43F, 4, 0x70, signal_counter);
}

/* 7F0h: state, first reason or FFh, output open, counter, checksum of the configuration with the low byte first. */
static void expect_first_status_frame(agv_state_t state, uint8_t reason) {
    hal_can_frame_t frame = {.id = 0x7F0, .time_ms = now_ms, .length = 8, .data = {(uint8_t)state, reason}};
    const uint32_t checksum = agv_config_checksum(&config);
    for (unsigned i = 0; i < 4; i++) {
        frame.data[4 + i] = (uint8_t)(checksum >> (8 * i));
    }
    hal_can_send_ExpectAndReturn(&hal, HAL_CAN_VEHICLE, kept(frame), true);
}

/* 065h, +12.3 degrees: 9123 = 23A3h. */
static void expect_held_angle(void) {
    const hal_can_frame_t frame = {.id = 0x065, .time_ms = now_ms, .length = 8, .data = {0xA3, 0x23}};
    hal_can_send_ExpectAndReturn(&hal, HAL_CAN_VEHICLE, kept(frame), true);
}

static void expect_latch(uint8_t latched, agv_fault_t reason, agv_fault_t unresettable) {
    static agv_latch_t latch;
    latch = (agv_latch_t){
        .latched = latched, .first_reason = (uint8_t)reason, .unresettable = (uint8_t)unresettable, .version = 1};
    latch.checksum = ~agv_crc32(AGV_CRC32_START, &latch, 4);
    hal_store_write_latch_ExpectWithArrayAndReturn(&hal, 1, &latch, sizeof latch, true);
}

/* The output is set first. Queued frames are discarded before anything is sent. */
static void expect_start(hal_reset_cause_t cause, uint8_t latched, agv_fault_t reason, agv_fault_t unresettable) {
    hal_reset_cause_ExpectAndReturn(&hal, cause);
    hal_safety_output_set_Expect(&hal, false);
    expect_status(HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    expect_status(HAL_CAN_AI, HAL_CAN_ERROR_ACTIVE);
    hal_store_read_latch_ExpectAndReturn(&hal, NULL, sizeof(agv_latch_t), 0);
    hal_store_read_latch_IgnoreArg_record();
    expect_latch(latched, reason, unresettable);
    hal_can_purge_Expect(&hal, HAL_CAN_VEHICLE);
    expect_safe_commands(0);
    const bool tripped = reason != AGV_FAULT_NONE;
    expect_first_status_frame(tripped ? AGV_STATE_TRIPPED : AGV_STATE_INIT, tripped ? (uint8_t)reason : 0xFF);
    hal_led_set_Expect(&hal, true);
}

/* At the end of a tick the output is set again, and the watchdog is fed (HW-1, TIM-3). */
static void expect_fed(bool output_closed) {
    hal_safety_output_set_Expect(&hal, output_closed);
    hal_watchdog_feed_Expect(&hal);
}

/* Every pattern begins lit; the LED is only switched when it is dark before. */
static void expect_led_on(void) {
    if (!core->led.on) {
        hal_led_set_Expect(&hal, true);
    }
}

static void start(void) {
    agv_supervisor_start(&supervisor, &ports, &config, now_ms);
}

/* --- traffic --- */

static void frame(hal_can_side_t side, uint32_t id, const uint8_t data[8]) {
    hal_can_frame_t received = {.id = id, .time_ms = now_ms, .length = 8};
    memcpy(received.data, data, 8);
    agv_supervisor_frame(&supervisor, &ports, side, &received);
}

static void ai_frame(uint32_t id, uint8_t first, uint8_t last) {
    const uint8_t data[8] = {first, 0, 0, 0, 0, 0, 0, last};
    frame((config.topology == AGV_TOPOLOGY_GATEWAY) ? HAL_CAN_AI : HAL_CAN_VEHICLE, id, data);
}

static void vcu_frame(uint8_t alarms) {
    const uint8_t data[8] = {0, 0, 0, 0, alarms, 0, mode, counter};
    frame(HAL_CAN_VEHICLE, 0x363, data);
}

static void tick(void) {
    agv_supervisor_receive_alive(&supervisor);
    agv_supervisor_tick(&supervisor, &ports, now_ms);
}

/* A healthy vehicle: P, throttle 0, steering +12.3 degrees in angle control. */
static void cycle_of_10_ms(void) {
    static const uint8_t park[8] = {8};
    static const uint8_t zeros[8] = {0};
    static const uint8_t angle_control[8] = {0, 0, 0, 1};
    const uint8_t wheels[8] = {wheel_speed, 0, wheel_speed, 0};
    const uint8_t steering[8] = {counter, 100, 0xA3, 0x23};
    counter++;
    vcu_frame(0);
    frame(HAL_CAN_VEHICLE, 0x0A3, park);
    frame(HAL_CAN_VEHICLE, 0x050, zeros);
    frame(HAL_CAN_VEHICLE, 0x101, wheels);
    frame(HAL_CAN_VEHICLE, 0x067, steering);
    frame(HAL_CAN_VEHICLE, 0x167, angle_control);
    frame(HAL_CAN_VEHICLE, 0x267, zeros);
    if (counter % 10 == 0) {
        ai_frame(0x43F, 0, counter);
    }
}

static void run(uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        now_ms++;
        if (now_ms % 10 == 0) {
            cycle_of_10_ms();
        }
        tick();
    }
}

static void walk_to_standby(void) {
    use_stubs();
    start();
    for (uint32_t ms = 0; ms < 1000 && agv_supervisor_state(&supervisor) != AGV_STATE_STANDBY; ms++) {
        run(1);
    }
    TEST_ASSERT_EQUAL(AGV_STATE_STANDBY, agv_supervisor_state(&supervisor));
    TEST_ASSERT_TRUE(closed);
    wheel_speed = 100; /* 100 mm/s: no standstill, so that nothing is written to flash */
    run(300);          /* two 43Fh: the AI is alive */
    TEST_ASSERT_EQUAL_UINT(0, written);
}

static void walk_to_active(void) {
    walk_to_standby();
    mode = 0x80;
    run(20);
    TEST_ASSERT_EQUAL(AGV_STATE_ACTIVE, agv_supervisor_state(&supervisor));
}

static uint8_t own_counter(void) {
    return core->transmitter.alive_counter;
}

/* --- the start --- */

/* Shows: FSM-4, FSM-7, FSM-2 */
void test_a_start_after_power_on(void) {
    be_strict();
    expect_start(HAL_RESET_POWER_ON, 0x69, AGV_FAULT_NONE, AGV_FAULT_NONE);
    start();
    TEST_ASSERT_EQUAL(AGV_STATE_INIT, agv_supervisor_state(&supervisor));
}

/* Shows: FSM-4, FSM-7, SUPERVISOR_RESET */
TEST_CASE(1)
TEST_CASE(2)
TEST_CASE(3)
TEST_CASE(4)
TEST_CASE(5)
void test_a_start_after_any_other_reset(int cause) {
    be_strict();
    expect_start((hal_reset_cause_t)cause, 0x96, AGV_FAULT_SUPERVISOR_RESET, AGV_FAULT_NONE);
    start();
    TEST_ASSERT_EQUAL(AGV_STATE_TRIPPED, agv_supervisor_state(&supervisor));
}

/* Shows: FSM-9, SELF_TEST_FAILED */
void test_a_start_with_a_failed_self_test(void) {
    be_strict();
    expect_start(HAL_RESET_POWER_ON, 0x96, AGV_FAULT_SELF_TEST_FAILED, AGV_FAULT_SELF_TEST_FAILED);
    failed = HAL_SELF_TEST_FLASH;
    start();
    TEST_ASSERT_EQUAL(AGV_STATE_TRIPPED, agv_supervisor_state(&supervisor));
}

/* --- ticks --- */

/* Shows: TIM-3 */
void test_a_quiet_tick_reads_the_controller_and_feeds_the_watchdog(void) {
    walk_to_standby();
    be_strict();
    now_ms++;
    expect_status(HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    expect_fed(true);
    tick();
}

/* Shows: TIM-3 */
void test_a_tick_without_the_receive_path_does_not_feed_the_watchdog(void) {
    walk_to_standby();
    be_strict();
    now_ms++;
    expect_status(HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    hal_safety_output_set_Expect(&hal, true);
    agv_supervisor_tick(&supervisor, &ports, now_ms);
}

static void expect_quiet_tick(void) {
    now_ms++;
    expect_status(HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    expect_fed(true);
}

/* Events wait. The flash is written at the end of the tick, and first after 1.5 s: at 2500. */
/* Shows: INT-3 */
void test_the_flash_is_written_at_the_end_of_a_tick_at_standstill(void) {
    walk_to_standby();
    TEST_ASSERT_NOT_NULL(agv_recorder_next_to_store(&recorder));
    wheel_speed = 0;
    run(2499 - now_ms);
    TEST_ASSERT_EQUAL_UINT(0, written);
    be_strict();
    now_ms++;
    expect_status(HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    const hal_can_frame_t status = {.id = 0x7F0};
    hal_can_send_ExpectAndReturn(&hal, HAL_CAN_VEHICLE, &status, true);
    hal_can_send_IgnoreArg_frame();
    expect_fed(true);
    hal_store_append_ExpectAndReturn(&hal, NULL, sizeof(agv_event_t), true);
    hal_store_append_IgnoreArg_record();
    tick();
    TEST_ASSERT_NOT_NULL(agv_recorder_next_to_store(&recorder));
    expect_quiet_tick();
    tick();
}

static void add_events(unsigned count) {
    const agv_entry_t entry = {.kind = AGV_EVENT_STARTUP};
    for (unsigned i = 0; i < count; i++) {
        agv_recorder_add(&recorder, &entry, now_ms);
    }
}

/* 60 writes in any minute: up to 20 unused ones at once, then one each 1.5 s. */
/* Shows: INT-3 */
void test_the_flash_is_written_at_most_once_a_second_on_average_over_a_minute(void) {
    walk_to_standby();
    run(100000);
    wheel_speed = 0;
    run(50); /* not at standstill yet */
    TEST_ASSERT_EQUAL_UINT(0, written);
    add_events(256);
    run(500);
    TEST_ASSERT_TRUE(written == 20 || written == 21);
    const unsigned before = written;
    run(15000);
    TEST_ASSERT_EQUAL_UINT(10, written - before);
    run(60000 - 15000 - 500);
    TEST_ASSERT_TRUE(written <= 60);
}

/* A step that is 5 s late counts as 1.5 s. It trips, so its write to flash must wait. */
/* Shows: INT-3 */
void test_a_late_step_earns_one_write_at_most(void) {
    walk_to_standby();
    const uint16_t earned_ms = core->store_credit_ms;
    now_ms += 5000;
    tick();
    TEST_ASSERT_EQUAL(AGV_STATE_TRIPPED, agv_supervisor_state(&supervisor));
    TEST_ASSERT_EQUAL_UINT8(1, core->store_credits);
    TEST_ASSERT_EQUAL_UINT16(earned_ms, core->store_credit_ms);
    TEST_ASSERT_EQUAL_UINT(0, written);
}

/* Frames that INIT queued must not be sent in STANDBY: they are discarded before the output closes. All conditions hold
 * since the second frame of the EPS at 1020, so INIT ends 500 ms later, with the first frame of that millisecond. */
/* Shows: FSM-4 */
void test_the_end_of_init(void) {
    use_stubs();
    start();
    run(519);
    TEST_ASSERT_EQUAL(AGV_STATE_INIT, agv_supervisor_state(&supervisor));
    TEST_ASSERT_FALSE(closed);
    be_strict();
    now_ms++;
    TEST_ASSERT_EQUAL_UINT32(1520, now_ms);
    counter++;
    hal_can_purge_Expect(&hal, HAL_CAN_VEHICLE);
    hal_safety_output_set_Expect(&hal, true);
    vcu_frame(0);
    TEST_ASSERT_EQUAL(AGV_STATE_STANDBY, agv_supervisor_state(&supervisor));
}

/* --- trips --- */

/* Shows: FSM-2, FSM-7, FSM-10 */
void test_a_trip_discards_what_waits_then_sends_then_stores(void) {
    walk_to_active();
    be_strict();
    hal_can_purge_Expect(&hal, HAL_CAN_VEHICLE);
    expect_held_angle();
    expect_safe_commands(own_counter());
    expect_latch(0x96, AGV_FAULT_S_DRIVER_ALARM, AGV_FAULT_NONE);
    vcu_frame(0x80);
    TEST_ASSERT_EQUAL(AGV_STATE_TRIPPED, agv_supervisor_state(&supervisor));
    TEST_ASSERT_TRUE(agv_supervisor_output_closed(&supervisor)); /* until the confirmation is late */
}

/* In manual the operator steers, so no angle is held. */
/* Shows: FSM-2, FSM-10 */
void test_a_trip_in_manual_holds_no_angle(void) {
    walk_to_standby();
    be_strict();
    hal_can_purge_Expect(&hal, HAL_CAN_VEHICLE);
    expect_safe_commands(own_counter());
    expect_latch(0x96, AGV_FAULT_S_DRIVER_ALARM, AGV_FAULT_NONE);
    vcu_frame(0x80);
}

/* A controller in bus-off gets no frame, and the output opens in the same tick. */
/* Shows: FSM-4, SUP-7, BUS_OFF */
void test_a_trip_by_bus_off_opens_the_output(void) {
    walk_to_standby();
    be_strict();
    now_ms++;
    expect_status(HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    hal_safety_output_set_Expect(&hal, false);
    hal_can_purge_Expect(&hal, HAL_CAN_VEHICLE);
    expect_latch(0x96, AGV_FAULT_BUS_OFF, AGV_FAULT_NONE);
    expect_fed(false);
    expect_led_on();
    tick();
    TEST_ASSERT_EQUAL(AGV_FAULT_BUS_OFF, agv_supervisor_first_reason(&supervisor));
}

/* The output opens before anything is sent, and stays open at the end of the tick. */
/* Shows: HW-2, FSM-4, EMERGENCY_STOP */
void test_an_emergency_stop_opens_the_output_first(void) {
    inputs.emergency_stop = HAL_CONTACT_CLOSED;
    walk_to_standby();
    const uint8_t next = own_counter();
    be_strict();
    now_ms++;
    inputs.emergency_stop = HAL_CONTACT_OPEN;
    expect_status(HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    hal_safety_output_set_Expect(&hal, false);
    hal_can_purge_Expect(&hal, HAL_CAN_VEHICLE);
    expect_safe_commands(next);
    expect_latch(0x96, AGV_FAULT_EMERGENCY_STOP, AGV_FAULT_NONE);
    expect_fed(false);
    expect_led_on();
    tick();
    TEST_ASSERT_EQUAL(AGV_FAULT_EMERGENCY_STOP, agv_supervisor_first_reason(&supervisor));
}

/* Shows: HW-1, FSM-4, OUTPUT_FEEDBACK */
void test_a_contact_that_does_not_close_opens_the_output(void) {
    inputs.output_feedback = HAL_CONTACT_OPEN;
    use_stubs();
    start();
    while (!closed && now_ms < 2000) {
        run(1);
    }
    TEST_ASSERT_TRUE(closed);
    run(99); /* a frame closed it, and the tick of that millisecond read the contact */
    TEST_ASSERT_TRUE(closed);
    run(1);
    TEST_ASSERT_FALSE(closed);
    TEST_ASSERT_EQUAL(AGV_FAULT_OUTPUT_FEEDBACK, agv_supervisor_first_reason(&supervisor));
}

/* Shows: HW-1, FSM-4 */
void test_a_contact_that_reads_closed_keeps_the_output_open(void) {
    config.output_feedback_ms = 1000;
    inputs.output_feedback = HAL_CONTACT_CLOSED;
    use_stubs();
    start();
    run(900);
    TEST_ASSERT_EQUAL(AGV_STATE_INIT, agv_supervisor_state(&supervisor));
    TEST_ASSERT_FALSE(closed);
    inputs.output_feedback = HAL_CONTACT_OPEN;
    run(499);
    TEST_ASSERT_FALSE(closed);
    run(2);
    TEST_ASSERT_TRUE(closed);
}

/* Shows: HW-4, SELF_TEST_FAILED */
void test_the_event_of_a_failed_self_test_names_the_parts(void) {
    walk_to_standby();
    failed = HAL_SELF_TEST_FLASH | HAL_SELF_TEST_RAM;
    run(1);
    TEST_ASSERT_FALSE(closed);
    agv_event_t event = {0};
    uint32_t index = agv_recorder_next_sequence(&recorder);
    while (event.kind != AGV_EVENT_FAULT && agv_recorder_get(&recorder, --index, &event)) {
    }
    TEST_ASSERT_EQUAL(AGV_FAULT_SELF_TEST_FAILED, event.a);
    TEST_ASSERT_EQUAL_HEX16(HAL_SELF_TEST_FLASH | HAL_SELF_TEST_RAM, event.missing);
}

/* Shows: INT-5, FSM-9, MEMORY_CORRUPTED */
void test_corrupted_memory_starts_anew_in_tripped(void) {
    walk_to_standby();
    be_strict();
    now_ms++;
    core->vehicle.angle_raw ^= 4;
    hal_safety_output_set_Expect(&hal, false);
    expect_status(HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    expect_status(HAL_CAN_AI, HAL_CAN_ERROR_ACTIVE);
    hal_store_read_latch_ExpectAndReturn(&hal, NULL, sizeof(agv_latch_t), 0);
    hal_store_read_latch_IgnoreArg_record();
    expect_latch(0x96, AGV_FAULT_MEMORY_CORRUPTED, AGV_FAULT_MEMORY_CORRUPTED);
    hal_can_purge_Expect(&hal, HAL_CAN_VEHICLE);
    expect_safe_commands(0);
    expect_first_status_frame(AGV_STATE_TRIPPED, AGV_FAULT_MEMORY_CORRUPTED);
    hal_led_set_Expect(&hal, true);
    expect_status(HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    hal_safety_output_set_Expect(&hal, false); /* the step begins anew: the next one feeds */
    tick();
    TEST_ASSERT_EQUAL(AGV_STATE_TRIPPED, agv_supervisor_state(&supervisor));
}

/* --- the gate refuses --- */

/* The test changes the supervisor's memory and corrects its seal, so only the gate can detect it. A forwarded gear that
 * waits for the controller becomes 03h, an invalid gear. */
/* Shows: INT-4, TX_GATE_REFUSED */
void test_a_refused_frame_is_not_sent_and_trips(void) {
    config.topology = AGV_TOPOLOGY_GATEWAY;
    config.gear_change = AGV_GEAR_CHANGE_ANY;
    walk_to_active();
    hal_takes = false;
    ai_frame(0x168, 1, 0);
    TEST_ASSERT_EQUAL_HEX8(1, core->transmitter.kept_data[AGV_MSG_GEAR_COMMAND][0]);
    core->transmitter.kept_data[AGV_MSG_GEAR_COMMAND][0] = 3;
    supervisor.seal = agv_seal(supervisor.memory, sizeof supervisor.memory);
    be_strict();
    now_ms++;
    expect_status(HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    expect_status(HAL_CAN_AI, HAL_CAN_ERROR_ACTIVE);
    expect_fed(true);
    tick();
    TEST_ASSERT_EQUAL_UINT32(1, agv_supervisor_counters(&supervisor)->gate_refused);
    now_ms++; /* faults are evaluated once a call, before anything is sent */
    expect_status(HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    expect_status(HAL_CAN_AI, HAL_CAN_ERROR_ACTIVE);
    hal_can_purge_Expect(&hal, HAL_CAN_VEHICLE);
    expect_held_angle();
    expect_safe_commands(own_counter());
    expect_latch(0x96, AGV_FAULT_TX_GATE_REFUSED, AGV_FAULT_NONE);
    expect_fed(true);
    expect_led_on();
    tick();
    TEST_ASSERT_EQUAL(AGV_STATE_TRIPPED, agv_supervisor_state(&supervisor));
    TEST_ASSERT_EQUAL(AGV_FAULT_TX_GATE_REFUSED, agv_supervisor_first_reason(&supervisor));
    TEST_ASSERT_EQUAL_UINT32(1, agv_supervisor_counters(&supervisor)->gate_refused);
}

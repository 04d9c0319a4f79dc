/* The flight recorder: ring, snapshots, torn events, restarts, what is still to be stored. */
#include "agv/recorder.h"

#include <string.h>

#include "unity.h"

static agv_recorder_t recorder;

void setUp(void) {
    memset(&recorder, 0xA5, sizeof recorder); /* what is in RAM after a power-on */
    agv_recorder_start(&recorder);
}

void tearDown(void) {
}

/* Events whose time is their number. */
static void add(uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        const agv_entry_t entry = {
            .kind = AGV_EVENT_FAULT, .a = 1, .b = 2, .c = 3, .missing = 4, .state = 5, .first_reason = 6};
        agv_recorder_add(&recorder, &entry, agv_recorder_next_sequence(&recorder));
    }
}

static void expect_there(uint32_t sequence) {
    agv_event_t event;
    TEST_ASSERT_TRUE(agv_recorder_get(&recorder, sequence, &event));
    TEST_ASSERT_EQUAL_UINT32(sequence, event.sequence);
}

static void expect_gone(uint32_t sequence) {
    agv_event_t event = {.sequence = 77};
    TEST_ASSERT_FALSE(agv_recorder_get(&recorder, sequence, &event));
    TEST_ASSERT_EQUAL_UINT32(77, event.sequence); /* not touched */
}

/* Store all that is waiting; returns how many. The first one has to have this number. */
static uint32_t store_all(uint32_t first) {
    uint32_t count = 0;
    for (const agv_event_t *e; (e = agv_recorder_next_to_store(&recorder)) != NULL; count++) {
        TEST_ASSERT_EQUAL_UINT32((count == 0) ? first : e->sequence, e->sequence);
        agv_recorder_stored(&recorder);
    }
    return count;
}

/* 00000000 00000000 02 01 02 03 04 05 06 00 0000, then 88 bytes 0: CRC-32 346C2F9Ch, of which the inverse's upper half is kept. */
void test_the_checksum_of_an_event_is_known(void) {
    agv_event_t event;
    add(1);
    TEST_ASSERT_TRUE(agv_recorder_get(&recorder, 0, &event));
    TEST_ASSERT_EQUAL_HEX16(0xCB93, event.checksum);
}

/* Kinds count from 1. */
void test_what_has_no_kind_is_no_event(void) {
    const agv_entry_t entry = {.kind = 0, .a = 1};
    agv_recorder_add(&recorder, &entry, 0);
    expect_gone(0);
}

void test_an_event_holds_what_was_said_of_it(void) {
    const uint8_t gear[8] = {8, 0, 0, 0, 0, 0, 0, 1};
    const uint8_t wheels[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    agv_event_t event;
    agv_recorder_frame(&recorder, AGV_MSG_GEAR_STATUS, gear);
    agv_recorder_frame(&recorder, AGV_MSG_WHEEL_SPEED, wheels);
    agv_recorder_frame(&recorder, AGV_MSG_NONE, gear);
    add(1);
    TEST_ASSERT_TRUE(agv_recorder_get(&recorder, 0, &event));
    TEST_ASSERT_EQUAL_UINT8(AGV_EVENT_FAULT, event.kind);
    TEST_ASSERT_EQUAL_UINT8(1, event.a);
    TEST_ASSERT_EQUAL_UINT8(2, event.b);
    TEST_ASSERT_EQUAL_UINT8(3, event.c);
    TEST_ASSERT_EQUAL_UINT8(4, event.missing);
    TEST_ASSERT_EQUAL_UINT8(5, event.state);
    TEST_ASSERT_EQUAL_UINT8(6, event.first_reason);
    TEST_ASSERT_EQUAL_UINT8(0, event.run);
    TEST_ASSERT_EQUAL_HEX16(1u << 5 | 1u << 10, event.seen);
    TEST_ASSERT_EQUAL_UINT8_ARRAY(gear, event.frames[AGV_MSG_GEAR_STATUS], 8);
    TEST_ASSERT_EQUAL_UINT8_ARRAY(wheels, event.frames[AGV_MSG_WHEEL_SPEED], 8);
    TEST_ASSERT_EACH_EQUAL_UINT8(0, event.frames[AGV_MSG_VEHICLE_STATUS], 8);
}

void test_after_a_power_on_nothing_is_there(void) {
    TEST_ASSERT_EQUAL_UINT32(0, agv_recorder_next_sequence(&recorder));
    for (uint32_t i = 0; i < 600; i++) {
        expect_gone(i);
    }
    TEST_ASSERT_NULL(agv_recorder_next_to_store(&recorder));
}

/* All 0 has a kind of 0, which is no event. */
void test_empty_memory_holds_no_event(void) {
    memset(&recorder, 0, sizeof recorder);
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(0, agv_recorder_next_sequence(&recorder));
    expect_gone(0);
    TEST_ASSERT_NULL(agv_recorder_next_to_store(&recorder));
}

/* Shows: INT-3 */
void test_the_last_256_events_are_kept(void) {
    add(256);
    expect_there(0);
    expect_there(255);
    add(1);
    expect_gone(0);
    expect_there(1);
    expect_there(256);
    expect_gone(257);
    add(1000);
    expect_gone(1000);
    expect_there(1001);
    expect_there(1256);
}

/* Shows: INT-3 */
void test_a_restart_keeps_the_events_and_counts_on(void) {
    const uint8_t gear[8] = {8};
    agv_event_t event;
    agv_recorder_frame(&recorder, AGV_MSG_GEAR_STATUS, gear);
    add(300);
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(300, agv_recorder_next_sequence(&recorder));
    expect_gone(43);
    expect_there(44);
    expect_there(299);
    add(1);
    TEST_ASSERT_TRUE(agv_recorder_get(&recorder, 300, &event));
    TEST_ASSERT_EQUAL_UINT8(1, event.run);
    TEST_ASSERT_EQUAL_HEX16(0, event.seen); /* of this run, nothing was received yet */
    TEST_ASSERT_EACH_EQUAL_UINT8(0, event.frames[AGV_MSG_GEAR_STATUS], 8);
}

/* Shows: INT-3 */
void test_a_torn_write_loses_the_newest_event_only(void) {
    add(10);
    recorder.events[9].frames[3][2] ^= 0x10;
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(9, agv_recorder_next_sequence(&recorder));
    expect_there(8);
    expect_gone(9);
}

/* Every byte of an event is under its checksum. */
/* Shows: INT-3, INT-5 */
void test_every_changed_byte_of_an_event_is_found(void) {
    add(2);
    unsigned char *bytes = (unsigned char *)&recorder.events[1];
    for (size_t i = 0; i < sizeof recorder.events[1]; i++) {
        bytes[i] ^= 0x40;
        expect_gone(1);
        bytes[i] ^= 0x40;
        expect_there(1);
    }
}

/* Shows: INT-3 */
void test_holes_do_not_end_what_is_kept(void) {
    add(20);
    recorder.events[3].a ^= 1;
    recorder.events[7].checksum ^= 1;
    recorder.events[0].kind = 0;
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(20, agv_recorder_next_sequence(&recorder));
    expect_gone(0);
    expect_gone(3);
    expect_gone(7);
    expect_there(1);
    expect_there(19);
    TEST_ASSERT_EQUAL_UINT32(17, store_all(1));
}

/* A good event that lies where it does not belong (memory that was shifted) is dropped. */
void test_an_event_in_a_wrong_place_is_dropped(void) {
    add(5);
    recorder.events[100] = recorder.events[4];
    recorder.events[4].kind = 0;
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(4, agv_recorder_next_sequence(&recorder));
    expect_gone(100);
    expect_gone(4);
}

/* Four events before the sequence wraps. */
static void start_before_the_wrap(void) {
    recorder.next_sequence = 0xFFFFFFFCu;
    recorder.stored_sequence = 0xFFFFFFFCu;
    add(10);
}

/* Shows: INT-3, TIM-2 */
void test_the_sequence_wraps(void) {
    start_before_the_wrap();
    TEST_ASSERT_EQUAL_UINT32(6, agv_recorder_next_sequence(&recorder));
    expect_there(0xFFFFFFFCu);
    expect_there(0xFFFFFFFFu);
    expect_there(0);
    expect_there(5);
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(6, agv_recorder_next_sequence(&recorder));
    expect_there(0xFFFFFFFCu);
    TEST_ASSERT_EQUAL_UINT32(10, store_all(0xFFFFFFFCu));
}

/* Shows: INT-3, TIM-2 */
void test_a_restart_counts_on_wherever_the_numbers_stand(void) {
    recorder.next_sequence = 0x90000010u;
    recorder.stored_sequence = 0x90000010u;
    add(20);
    for (unsigned i = 0; i < 5; i++) {
        TEST_ASSERT_NOT_NULL(agv_recorder_next_to_store(&recorder));
        agv_recorder_stored(&recorder);
    }
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(0x90000024u, agv_recorder_next_sequence(&recorder));
    expect_there(0x90000010u);
    TEST_ASSERT_EQUAL_UINT32(15, store_all(0x90000015u));
}

/* Shows: INT-3 */
void test_a_mark_beyond_large_numbers_stores_all(void) {
    recorder.next_sequence = 0x90000010u;
    add(20);
    recorder.stored_sequence = 0xA0000010u;
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(20, store_all(0x90000010u));
}

/* Shows: INT-3 */
void test_a_mark_before_the_oldest_event_stores_all(void) {
    add(1000);
    recorder.stored_sequence = 5;
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(256, store_all(744));
}

/* Up to half of all numbers ahead is newer. */
/* Shows: TIM-2 */
void test_a_number_far_ahead_is_newer(void) {
    recorder.next_sequence = 10;
    add(1);
    recorder.next_sequence = 0x60000010u;
    add(1);
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(0x60000011u, agv_recorder_next_sequence(&recorder));
}

/* Shows: TIM-2 */
void test_runs_wrap(void) {
    agv_event_t event;
    for (unsigned start = 1; start <= 256; start++) {
        add(1);
        agv_recorder_start(&recorder);
    }
    add(1);
    TEST_ASSERT_TRUE(agv_recorder_get(&recorder, 256, &event));
    TEST_ASSERT_EQUAL_UINT8(0, event.run);
}

/* Shows: INT-3 */
void test_every_event_is_stored_once_and_in_order(void) {
    add(3);
    const agv_event_t *event = agv_recorder_next_to_store(&recorder);
    TEST_ASSERT_EQUAL_UINT32(0, event->sequence);
    TEST_ASSERT_EQUAL_PTR(event, agv_recorder_next_to_store(&recorder)); /* until it is said to be stored */
    TEST_ASSERT_EQUAL_UINT32(3, store_all(0));
    add(1);
    TEST_ASSERT_EQUAL_UINT32(1, store_all(3));
    agv_recorder_start(&recorder); /* what is in flash stays known */
    TEST_ASSERT_NULL(agv_recorder_next_to_store(&recorder));
    add(1);
    TEST_ASSERT_EQUAL_UINT32(1, store_all(4));
}

void test_what_was_replaced_before_it_was_stored_is_lost(void) {
    add(2);
    TEST_ASSERT_EQUAL_UINT32(2, store_all(0));
    add(300);
    TEST_ASSERT_EQUAL_UINT32(256, store_all(46));
    add(1000); /* however many: 302 to 1301 */
    TEST_ASSERT_EQUAL_UINT32(256, store_all(1046));
}

void test_a_mark_that_makes_no_sense_stores_all(void) {
    add(5);
    recorder.stored_sequence = 6;
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(5, store_all(0));
    recorder.stored_sequence = 0x80000000u;
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(5, store_all(0));
}

void test_a_ring_of_holes_stores_nothing_but_the_last(void) {
    add(256);
    for (unsigned i = 0; i < 255; i++) {
        recorder.events[i].kind = 0;
    }
    TEST_ASSERT_EQUAL_UINT32(1, store_all(255));
    add(256);
    for (unsigned i = 0; i < 256; i++) {
        recorder.events[i].kind = 0;
    }
    TEST_ASSERT_NULL(agv_recorder_next_to_store(&recorder));
    TEST_ASSERT_NULL(agv_recorder_next_to_store(&recorder));
}

/* The flight recorder: ring, snapshots, torn events, restarts, events still to be stored. */
#include "agv/recorder.h"

#include <stddef.h>
#include <string.h>

#include "agv/checksum.h"
#include "agv/state.h"
#include "unity.h"

static agv_recorder_t recorder;

void setUp(void) {
    memset(&recorder, 0xA5, sizeof recorder); /* content of RAM after a power-on */
    agv_recorder_start(&recorder);
}

/* Events whose time is their number. */
static void add(uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        const agv_entry_t entry = {
            .kind = AGV_EVENT_OUTPUT, .a = 1, .b = 2, .c = 3, .missing = 4, .state = 5, .first_reason = 6};
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

/* Store all waiting events, the first of which must have this number. @return number of stored events */
static uint32_t store_all(uint32_t first) {
    uint32_t count = 0;
    for (const agv_event_t *e; (e = agv_recorder_next_to_store(&recorder)) != NULL; count++) {
        TEST_ASSERT_EQUAL_UINT32((count == 0) ? first : e->sequence, e->sequence);
        agv_recorder_stored(&recorder);
    }
    return count;
}

/* 00000000 00000000 03 01 02 03 0400 05 06 0000 0000, then 90 bytes 0: CRC-32 F7821234h; the upper half of its inverse is kept. */
void test_the_checksum_of_an_event_is_known(void) {
    agv_event_t event;
    add(1);
    TEST_ASSERT_TRUE(agv_recorder_get(&recorder, 0, &event));
    TEST_ASSERT_EQUAL_HEX16(0x087D, event.checksum);
}

/* Kinds count from 1. */
void test_bytes_without_a_kind_are_no_event(void) {
    const agv_entry_t entry = {.kind = 0, .a = 1};
    agv_recorder_add(&recorder, &entry, 0);
    expect_gone(0);
}

void test_an_event_holds_its_parameters(void) {
    const uint8_t gear[8] = {8, 0, 0, 0, 0, 0, 0, 1};
    const uint8_t wheels[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    agv_event_t event;
    agv_recorder_frame(&recorder, AGV_MSG_GEAR_STATUS, gear);
    agv_recorder_frame(&recorder, AGV_MSG_WHEEL_SPEED, wheels);
    agv_recorder_frame(&recorder, AGV_MSG_NONE, gear);
    add(1);
    TEST_ASSERT_TRUE(agv_recorder_get(&recorder, 0, &event));
    TEST_ASSERT_EQUAL_UINT8(AGV_EVENT_OUTPUT, event.kind);
    TEST_ASSERT_EQUAL_UINT8(1, event.a);
    TEST_ASSERT_EQUAL_UINT8(2, event.b);
    TEST_ASSERT_EQUAL_UINT8(3, event.c);
    TEST_ASSERT_EQUAL_UINT16(4, event.missing);
    TEST_ASSERT_EQUAL_UINT16(0, event.left_out);
    TEST_ASSERT_EQUAL_UINT8(5, event.state);
    TEST_ASSERT_EQUAL_UINT8(6, event.first_reason);
    TEST_ASSERT_EQUAL_UINT8(0, event.run);
    TEST_ASSERT_EQUAL_HEX16(1u << 5 | 1u << 10, event.seen);
    TEST_ASSERT_EQUAL_UINT8_ARRAY(gear, event.frames[AGV_MSG_GEAR_STATUS], 8);
    TEST_ASSERT_EQUAL_UINT8_ARRAY(wheels, event.frames[AGV_MSG_WHEEL_SPEED], 8);
    TEST_ASSERT_EACH_EQUAL_UINT8(0, event.frames[AGV_MSG_VEHICLE_STATUS], 8);
}

void test_after_a_power_on_the_recorder_is_empty(void) {
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
    TEST_ASSERT_EQUAL_UINT8(0, recorder.events[9].kind); /* a dump of the memory does not have it either */
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
void test_holes_do_not_end_the_kept_events(void) {
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

/* A valid event in the wrong place is dropped, to whichever side memory is shifted. */
TEST_CASE(100)
TEST_CASE(1)
void test_an_event_in_a_wrong_place_is_dropped(unsigned place) {
    add(5);
    recorder.events[place] = recorder.events[4];
    recorder.events[4].kind = 0;
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(4, agv_recorder_next_sequence(&recorder));
    expect_gone(place);
    expect_gone(4);
    expect_there(3);
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
    TEST_ASSERT_EQUAL_PTR(event, agv_recorder_next_to_store(&recorder)); /* until it is reported as stored */
    TEST_ASSERT_EQUAL_UINT32(3, store_all(0));
    add(1);
    TEST_ASSERT_EQUAL_UINT32(1, store_all(3));
    agv_recorder_start(&recorder); /* the mark of stored events is kept */
    TEST_ASSERT_NULL(agv_recorder_next_to_store(&recorder));
    add(1);
    TEST_ASSERT_EQUAL_UINT32(1, store_all(4));
}

void test_events_replaced_before_they_were_stored_are_lost(void) {
    add(2);
    TEST_ASSERT_EQUAL_UINT32(2, store_all(0));
    add(300);
    TEST_ASSERT_EQUAL_UINT32(256, store_all(46));
    add(1000); /* however many: 302 to 1301 */
    TEST_ASSERT_EQUAL_UINT32(256, store_all(1046));
}

void test_an_invalid_mark_stores_all(void) {
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
    add(300); /* 256 to 555, of which 300 and later are kept */
    for (unsigned i = 0; i < 256; i++) {
        recorder.events[i].kind = (i == 555 - 512) ? recorder.events[i].kind : 0;
    }
    TEST_ASSERT_EQUAL_UINT32(1, store_all(555));
    add(256);
    for (unsigned i = 0; i < 256; i++) {
        recorder.events[i].kind = 0;
    }
    TEST_ASSERT_NULL(agv_recorder_next_to_store(&recorder));
    TEST_ASSERT_NULL(agv_recorder_next_to_store(&recorder));
}

/* ---- The last 8 trips ---- */

/* A change to TRIPPED for this reason, at a time that identifies it. */
static void trip(uint32_t number) {
    const agv_entry_t entry = {.kind = AGV_EVENT_STATE,
                               .a = AGV_STATE_ACTIVE,
                               .b = AGV_STATE_TRIPPED,
                               .c = AGV_FAULT_BUS_OFF,
                               .state = AGV_STATE_TRIPPED,
                               .first_reason = AGV_FAULT_BUS_OFF};
    agv_recorder_add(&recorder, &entry, number);
}

/* Exactly the last of these trips are kept, the latest first. */
static void expect_trips(uint32_t latest, uint32_t count) {
    agv_event_t event = {.time_ms = 77};
    for (uint32_t i = 0; i < count; i++) {
        TEST_ASSERT_TRUE(agv_recorder_get_trip(&recorder, i, &event));
        TEST_ASSERT_EQUAL_UINT32(latest - i, event.time_ms);
        TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_BUS_OFF, event.c);
    }
    event.time_ms = 77;
    TEST_ASSERT_FALSE(agv_recorder_get_trip(&recorder, count, &event));
    TEST_ASSERT_FALSE(agv_recorder_get_trip(&recorder, UINT32_MAX, &event));
    TEST_ASSERT_EQUAL_UINT32(77, event.time_ms); /* not touched */
}

/* Shows: INT-3 */
void test_the_last_8_trips_are_kept_apart(void) {
    expect_trips(0, 0);
    for (uint32_t number = 1; number <= 30; number++) {
        trip(number);
        expect_trips(number, (number < 8) ? number : 8);
        add(40); /* later events do not replace it */
    }
    add(1000);
    expect_trips(30, 8);
}

/* With the snapshot of the trip. */
/* Shows: INT-3 */
void test_a_trip_is_kept_with_its_snapshot(void) {
    const uint8_t gear[8] = {1, 0, 0, 0, 0, 0, 0, 7};
    agv_event_t event;
    agv_recorder_frame(&recorder, AGV_MSG_GEAR_STATUS, gear);
    trip(1);
    agv_recorder_frame(&recorder, AGV_MSG_GEAR_STATUS, (const uint8_t[8]){8});
    add(300);
    TEST_ASSERT_TRUE(agv_recorder_get_trip(&recorder, 0, &event));
    TEST_ASSERT_EQUAL_UINT8_ARRAY(gear, event.frames[AGV_MSG_GEAR_STATUS], 8);
    TEST_ASSERT_EQUAL_UINT8(AGV_STATE_ACTIVE, event.a);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_BUS_OFF, event.first_reason);
}

/* No trip: a withdrawn confirmation, another state, another kind of event. */
/* Shows: INT-3 */
void test_other_events_replace_no_trip(void) {
    const agv_entry_t others[] = {
        {.kind = AGV_EVENT_STATE, .a = AGV_STATE_SAFE, .b = AGV_STATE_TRIPPED, .c = AGV_FAULT_NONE},
        {.kind = AGV_EVENT_STATE, .a = AGV_STATE_TRIPPED, .b = AGV_STATE_SAFE, .c = AGV_FAULT_BUS_OFF},
        {.kind = AGV_EVENT_STATE, .a = AGV_STATE_STANDBY, .b = AGV_STATE_ACTIVE, .c = AGV_FAULT_BUS_OFF},
        {.kind = AGV_EVENT_FAULT, .a = AGV_FAULT_BUS_OFF, .b = AGV_STATE_TRIPPED, .c = 1}};
    trip(1);
    for (unsigned i = 0; i < 4; i++) {
        agv_recorder_add(&recorder, &others[i], 2);
        expect_trips(1, 1);
    }
}

/* It is no event, so the oldest of the eight stays. */
/* Shows: INT-3 */
void test_an_entry_without_a_kind_replaces_no_trip(void) {
    const agv_entry_t none = {.kind = 0, .a = AGV_STATE_ACTIVE, .b = AGV_STATE_TRIPPED, .c = AGV_FAULT_BUS_OFF};
    for (uint32_t number = 1; number <= 8; number++) {
        trip(number);
    }
    agv_recorder_add(&recorder, &none, 9);
    expect_trips(8, 8);
}

/* Shows: INT-3 */
void test_trips_outlive_a_restart_and_the_wrap_of_the_numbers(void) {
    recorder.next_sequence = 0xFFFFFFFBu;
    recorder.stored_sequence = 0xFFFFFFFBu;
    for (uint32_t number = 1; number <= 10; number++) {
        trip(number);
        agv_recorder_start(&recorder);
    }
    expect_trips(10, 8);
}

/* A torn trip is dropped, and its place is used next. */
/* Shows: INT-3, INT-5 */
void test_a_torn_trip_loses_that_one_only(void) {
    for (uint32_t number = 1; number <= 8; number++) {
        trip(number);
    }
    recorder.trips[7].c ^= 1; /* the latest */
    expect_trips(7, 7);
    agv_recorder_start(&recorder);
    expect_trips(7, 7);
    TEST_ASSERT_EQUAL_UINT8(0, recorder.trips[7].kind);
    trip(8);
    expect_trips(8, 8);
    recorder.trips[0].checksum ^= 1; /* also detected when it is used */
    trip(9);
    expect_trips(9, 8);
}

/* The event is torn, but the kept trip is not. Its number is not used again. */
/* Shows: INT-3 */
void test_a_torn_event_whose_trip_is_kept(void) {
    trip(1);
    trip(2);
    recorder.events[1].kind = 0;
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(2, agv_recorder_next_sequence(&recorder));
    trip(3);
    expect_trips(3, 3);
    memset(recorder.events, 0, sizeof recorder.events); /* all of them */
    agv_recorder_start(&recorder);
    for (uint32_t number = 4; number <= 20; number++) {
        trip(number);
        expect_trips(number, (number < 8) ? number : 8);
    }
    agv_event_t event;
    TEST_ASSERT_TRUE(agv_recorder_get_trip(&recorder, 0, &event));
    TEST_ASSERT_EQUAL_UINT8(2, event.run); /* the third start: that of the kept trip was the second */
}

/* An event before the trips is no trip: the oldest of the eight is replaced, also after a restart. */
/* Shows: INT-3 */
void test_the_oldest_trip_is_replaced_after_a_restart(void) {
    add(1);
    for (uint32_t number = 1; number <= 9; number++) {
        trip(number);
    }
    agv_recorder_start(&recorder);
    trip(10);
    expect_trips(10, 8);
}

/* The first event of a start in TRIPPED. */
static void add_tripped(uint8_t reason, uint32_t number) {
    const agv_entry_t entry = {.kind = AGV_EVENT_STATE,
                               .b = AGV_STATE_TRIPPED,
                               .c = reason,
                               .state = AGV_STATE_TRIPPED,
                               .first_reason = reason};
    agv_recorder_add(&recorder, &entry, number);
}

static void start_tripped(uint8_t reason, uint32_t number) {
    agv_recorder_start(&recorder);
    add_tripped(reason, number);
}

/* However often the supervisor restarts: the trip of the run before goes on. */
/* Shows: INT-3, FSM-7 */
void test_a_start_that_continues_a_trip_is_no_trip(void) {
    trip(1);
    for (uint32_t number = 2; number <= 300; number++) {
        start_tripped(AGV_FAULT_BUS_OFF, number);
    }
    expect_trips(1, 1);
}

/* Shows: INT-3, FSM-7 */
void test_a_start_with_another_reason_or_after_a_reset_is_a_trip(void) {
    const agv_entry_t reset = {.kind = AGV_EVENT_STATE,
                               .a = AGV_STATE_SAFE,
                               .b = AGV_STATE_STANDBY,
                               .c = AGV_FAULT_NONE,
                               .state = AGV_STATE_STANDBY,
                               .first_reason = AGV_FAULT_NONE};
    agv_event_t event;
    start_tripped(AGV_FAULT_BUS_OFF, 1); /* the first event of all */
    expect_trips(1, 1);
    agv_recorder_add(&recorder, &reset, 2);
    start_tripped(AGV_FAULT_BUS_OFF, 3);
    start_tripped(AGV_FAULT_SUPERVISOR_RESET, 4);
    TEST_ASSERT_TRUE(agv_recorder_get_trip(&recorder, 0, &event));
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_SUPERVISOR_RESET, event.c);
    TEST_ASSERT_TRUE(agv_recorder_get_trip(&recorder, 1, &event));
    TEST_ASSERT_EQUAL_UINT32(3, event.time_ms);
    TEST_ASSERT_TRUE(agv_recorder_get_trip(&recorder, 2, &event));
    TEST_ASSERT_FALSE(agv_recorder_get_trip(&recorder, 3, &event));
    start_tripped(AGV_FAULT_BUS_OFF, 5); /* of a lower rank than the reason before it */
    TEST_ASSERT_TRUE(agv_recorder_get_trip(&recorder, 0, &event));
    TEST_ASSERT_EQUAL_UINT32(5, event.time_ms);
}

/* A torn event says nothing: then the start counts. */
/* Shows: INT-3 */
void test_a_start_after_a_torn_event_is_a_trip(void) {
    trip(1);
    recorder.events[0].time_ms ^= 1;
    start_tripped(AGV_FAULT_BUS_OFF, 2);
    expect_trips(2, 2);
    agv_recorder_start(&recorder);
    recorder.events[1].time_ms ^= 1; /* later than the start has looked */
    add_tripped(AGV_FAULT_BUS_OFF, 3);
    expect_trips(3, 3);
}

/* ---- Four times a second ---- */

/* Whether an event of this fault is recorded, and how many were left out before it. */
static int recorded(unsigned fault, uint32_t time_ms) {
    const agv_entry_t entry = {.kind = AGV_EVENT_FAULT, .a = (uint8_t)fault, .b = AGV_CLASS_TRIP, .c = 1};
    const uint32_t sequence = agv_recorder_next_sequence(&recorder);
    agv_event_t event;
    agv_recorder_add(&recorder, &entry, time_ms);
    if (agv_recorder_next_sequence(&recorder) == sequence) {
        return -1;
    }
    TEST_ASSERT_TRUE(agv_recorder_get(&recorder, sequence, &event));
    TEST_ASSERT_EQUAL_UINT8(fault, event.a);
    return event.left_out;
}

/* The fourth one before it has to be a second ago. */
/* Shows: INT-3, TIM-2 */
TEST_CASE(0)
TEST_CASE(0xFFFFFE00)
void test_one_fault_is_recorded_four_times_a_second(uint32_t start_ms) {
    for (uint32_t ms = 0; ms < 400; ms += 100) {
        TEST_ASSERT_EQUAL_INT(0, recorded(AGV_FAULT_RX_OVERRUN, start_ms + ms));
    }
    for (uint32_t ms = 400; ms < 1000; ms++) {
        TEST_ASSERT_EQUAL_INT(-1, recorded(AGV_FAULT_RX_OVERRUN, start_ms + ms));
    }
    TEST_ASSERT_EQUAL_INT(600, recorded(AGV_FAULT_RX_OVERRUN, start_ms + 1000));
    TEST_ASSERT_EQUAL_INT(-1, recorded(AGV_FAULT_RX_OVERRUN, start_ms + 1099));
    TEST_ASSERT_EQUAL_INT(1, recorded(AGV_FAULT_RX_OVERRUN, start_ms + 1100));
    TEST_ASSERT_EQUAL_INT(0, recorded(AGV_FAULT_RX_OVERRUN, start_ms + 5000));
}

/* The limit is for each fault by itself, and only for faults. */
/* Shows: INT-3 */
void test_a_fault_that_flickers_leaves_room_for_the_others(void) {
    for (uint32_t i = 0; i < 1000; i++) {
        (void)recorded(AGV_FAULT_RX_OVERRUN, 50);
    }
    TEST_ASSERT_EQUAL_UINT32(4, agv_recorder_next_sequence(&recorder));
    for (unsigned fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        TEST_ASSERT_EQUAL_INT((fault == AGV_FAULT_RX_OVERRUN) ? -1 : 0, recorded(fault, 50));
    }
    const agv_entry_t state = {.kind = AGV_EVENT_STATE, .a = AGV_FAULT_RX_OVERRUN, .b = AGV_STATE_SAFE};
    const agv_entry_t none = {.kind = AGV_EVENT_FAULT, .a = AGV_FAULT_NONE};
    const uint32_t sequence = agv_recorder_next_sequence(&recorder);
    for (unsigned i = 0; i < 10; i++) {
        agv_recorder_add(&recorder, &state, 50);
        agv_recorder_add(&recorder, &none, 50);
    }
    TEST_ASSERT_EQUAL_UINT32(sequence + 20, agv_recorder_next_sequence(&recorder));
}

/* The number is that of this event alone, not of what was in its place 256 events before. */
/* Shows: INT-3 */
void test_the_number_left_out_is_not_that_of_a_replaced_event(void) {
    agv_event_t event;
    for (uint32_t ms = 0; ms <= 1000; ms += 100) {
        (void)recorded(AGV_FAULT_RX_OVERRUN, ms);
    }
    TEST_ASSERT_TRUE(agv_recorder_get(&recorder, 4, &event));
    TEST_ASSERT_EQUAL_UINT16(6, event.left_out);
    add(256);
    TEST_ASSERT_TRUE(agv_recorder_get(&recorder, 260, &event));
    TEST_ASSERT_EQUAL_UINT16(0, event.left_out);
}

/* However many. */
/* Shows: INT-3 */
void test_the_number_left_out_saturates(void) {
    for (uint32_t i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_INT(0, recorded(AGV_FAULT_BUS_OFF, 0));
    }
    for (uint32_t i = 0; i < 70000; i++) {
        TEST_ASSERT_EQUAL_INT(-1, recorded(AGV_FAULT_BUS_OFF, 999));
    }
    TEST_ASSERT_EQUAL_INT(65535, recorded(AGV_FAULT_BUS_OFF, 1000));
}

/* A restart clears the rates. */
/* Shows: INT-3 */
void test_a_restart_begins_the_rates_anew(void) {
    for (uint32_t i = 0; i < 10; i++) {
        (void)recorded(AGV_FAULT_BUS_OFF, 0);
    }
    agv_recorder_start(&recorder);
    for (uint32_t i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_INT(0, recorded(AGV_FAULT_BUS_OFF, 5));
    }
    TEST_ASSERT_EQUAL_INT(-1, recorded(AGV_FAULT_BUS_OFF, 5));
}

/* An event of a crash holds two addresses in place of a snapshot, and its checksum is right. */
/* Shows: INT-3 */
void test_a_crash_is_recorded_with_its_addresses(void) {
    static const uint8_t addresses[AGV_DLC] = {0x34, 0x12, 0, 8, 0x79, 0x56, 0, 8};
    static const uint8_t seen[AGV_DLC] = {1, 2, 3, 4, 5, 6, 7, 8};
    static const uint8_t none[AGV_DLC] = {0};
    const agv_entry_t entry = {.kind = AGV_EVENT_CRASH, .a = 3, .b = 2};
    agv_event_t event;
    add(3);
    agv_recorder_frame(&recorder, 0, seen);
    agv_recorder_frame(&recorder, 1, seen);
    agv_recorder_add_crash(&recorder, &entry, addresses, 7);
    TEST_ASSERT_TRUE(agv_recorder_get(&recorder, 3, &event));
    TEST_ASSERT_TRUE(agv_event_is_valid(&event));
    TEST_ASSERT_EQUAL_UINT8(6, event.kind);
    TEST_ASSERT_EQUAL_UINT8(3, event.a);
    TEST_ASSERT_EQUAL_UINT8(2, event.b);
    TEST_ASSERT_EQUAL_UINT32(7, event.time_ms);
    TEST_ASSERT_EQUAL_UINT16(0, event.seen);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(addresses, event.frames[0], AGV_DLC);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(none, event.frames[1], AGV_DLC);
    event.frames[0][0] ^= 1;
    TEST_ASSERT_FALSE(agv_event_is_valid(&event));
    add(1);
    TEST_ASSERT_TRUE(agv_recorder_get(&recorder, 4, &event));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(seen, event.frames[0], AGV_DLC); /* later events have the snapshot again */
}

/* After a start in empty memory and one restart there are free places for two more trips. */
/* Shows: INT-3 */
void test_trips_after_a_restart_fill_the_free_places_first(void) {
    memset(&recorder, 0, sizeof recorder);
    agv_recorder_start(&recorder);
    trip(1);
    agv_recorder_start(&recorder);
    trip(2);
    trip(3);
    expect_trips(3, 3);
}

/* Half of all numbers ahead is not newer. */
/* Shows: TIM-2 */
void test_a_trip_half_of_all_numbers_ahead_is_not_newer(void) {
    recorder.next_sequence = 0x7FFFFFFFu;
    trip(1);
    memset(recorder.events, 0, sizeof recorder.events);
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(0, agv_recorder_next_sequence(&recorder));
}

/* One less than half of all numbers ahead is newer: of a trip, and of an event in the ring. */
/* Shows: TIM-2 */
void test_just_less_than_half_of_all_numbers_ahead_is_newer(void) {
    recorder.next_sequence = 0x7FFFFFFEu;
    trip(1);
    memset(recorder.events, 0, sizeof recorder.events);
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(0x7FFFFFFFu, agv_recorder_next_sequence(&recorder));
    setUp();
    add(1);
    recorder.next_sequence = 0x7FFFFFFFu;
    add(1);
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(0x80000000u, agv_recorder_next_sequence(&recorder));
}

/* A kept event is of a later version, which uses the reserved byte. Its place is filled anew, with a 0. */
void test_the_reserved_byte_of_a_new_event_is_0(void) {
    agv_event_t event;
    add(1);
    recorder.events[0].reserved = 1;
    recorder.events[0].checksum =
        (uint16_t)(agv_crc32(AGV_CRC32_START, &recorder.events[0], offsetof(agv_event_t, checksum)) >> 16u);
    agv_recorder_start(&recorder);
    expect_there(0);
    add(256);
    TEST_ASSERT_TRUE(agv_recorder_get(&recorder, 256, &event));
    TEST_ASSERT_EQUAL_UINT8(0, event.reserved);
}

/* The ring is lost, but not the trip 256, and all was stored: the mark starts at 0. A call goes at most 256 numbers further. */
/* Shows: INT-1, INT-3 */
void test_a_mark_far_behind_reaches_the_newest_event_in_two_calls(void) {
    add(256);
    trip(256);
    add(300);
    (void)store_all(301);
    memset(recorder.events, 0, sizeof recorder.events);
    agv_recorder_start(&recorder);
    TEST_ASSERT_EQUAL_UINT32(257, agv_recorder_next_sequence(&recorder));
    add(1);
    TEST_ASSERT_NULL(agv_recorder_next_to_store(&recorder));
    TEST_ASSERT_EQUAL_UINT32(1, store_all(257));
}

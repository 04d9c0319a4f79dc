#include "expect.h"

#include <string.h>

#include "unity.h"

static const fixture_sent_t *the_one_in_call(const fixture_t *f, uint32_t call, uint32_t id) {
    const fixture_sent_t *found = NULL;
    for (uint32_t i = 0; i < f->sent_count; i++) {
        if (f->sent[i].call == call && f->sent[i].id == id) {
            TEST_ASSERT_NULL_MESSAGE(found, f->what);
            found = &f->sent[i];
        }
    }
    TEST_ASSERT_NOT_NULL_MESSAGE(found, f->what);
    return found;
}

void expect_safe_frame(const fixture_t *f, const fixture_sent_t *frame, int32_t hold_raw) {
    const uint8_t hold[8] = {(uint8_t)((unsigned)hold_raw & 0xFFu), (uint8_t)((unsigned)hold_raw >> 8u)};
    const bool signals = frame->id == traffic_id(&f->config, M_SIGNALS);
    const uint8_t *expected = signals              ? SAFE_SIGNALS
                              : frame->id == 0x168 ? SAFE_PARK
                              : frame->id == 0x075 ? SAFE_THROTTLE
                                                   : hold;
    TEST_ASSERT_EQUAL_INT_MESSAGE(HAL_CAN_VEHICLE, frame->side, f->what);
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(0, frame->flags, f->what);
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(8, frame->length, f->what);
    TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(expected, frame->data, signals ? SAFE_SIGNALS_BYTES : 8, f->what);
    TEST_ASSERT_TRUE_MESSAGE(expected != hold || (frame->id == 0x065 && hold_raw != NO_HOLD), f->what);
}

static uint32_t count_in_call(const fixture_t *f, uint32_t call) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < f->sent_count; i++) {
        count += f->sent[i].call == call && f->sent[i].side == HAL_CAN_VEHICLE ? 1u : 0u;
    }
    return count;
}

void expect_safe_commands(const fixture_t *f, uint32_t call, int32_t hold_raw) {
    const uint32_t ids[] = {traffic_id(&f->config, M_SIGNALS), 0x168, 0x075, 0x065};
    for (unsigned i = 0; i < (hold_raw != NO_HOLD ? 4u : 3u); i++) {
        expect_safe_frame(f, the_one_in_call(f, call, ids[i]), hold_raw);
    }
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(hold_raw != NO_HOLD ? 4 : 3, count_in_call(f, call), f->what);
}

static agv_event_t last_event(const fixture_t *f, agv_event_kind_t kind) {
    agv_event_t event = {0};
    TEST_ASSERT_TRUE_MESSAGE(fixture_events(f, kind, ANY, ANY, &event) > 0, f->what);
    return event;
}

static void expect_raised_now(const fixture_t *f, agv_fault_t fault, agv_fault_class_t fault_class) {
    agv_event_t event;
    expect_fault(f, fault, true);
    TEST_ASSERT_TRUE_MESSAGE(fixture_last_raised(f, fault, &event), f->what);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(f->now_ms, event.time_ms, f->what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(fault_class, event.b, f->what);
}

/* The vehicle may confirm in the same moment: then SAFE follows at once. */
static void expect_entered_tripped_now(const fixture_t *f, agv_fault_t reason) {
    agv_event_t event = last_event(f, AGV_EVENT_STATE);
    if (event.b == AGV_STATE_SAFE) {
        TEST_ASSERT_TRUE_MESSAGE(event.sequence > 0, f->what);
        uint32_t before = event.sequence;
        do {
            TEST_ASSERT_TRUE_MESSAGE(agv_recorder_get(&f->recorder, --before, &event), f->what);
        } while (event.kind != AGV_EVENT_STATE);
    }
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(AGV_STATE_TRIPPED, event.b, f->what);
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(reason, event.c, f->what);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(f->now_ms, event.time_ms, f->what);
}

void expect_trip(const fixture_t *f, agv_fault_t fault, uint32_t call, int32_t hold_raw) {
    expect_raised_now(f, fault, AGV_CLASS_TRIP);
    expect_reason(f, fault);
    expect_entered_tripped_now(f, fault);
    const agv_state_t state = agv_supervisor_state(&f->supervisor);
    TEST_ASSERT_TRUE_MESSAGE(state == AGV_STATE_TRIPPED || state == AGV_STATE_SAFE, f->what);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(f->now_ms, f->sent[0].time_ms, f->what); /* not earlier */
    expect_safe_commands(f, call, hold_raw);
}

void expect_warning(const fixture_t *f, agv_fault_t fault, agv_state_t state) {
    expect_raised_now(f, fault, AGV_CLASS_WARN);
    expect_state(f, state);
    expect_reason(f, AGV_FAULT_NONE);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(fixture_raised(f, fault), agv_supervisor_counters(&f->supervisor)->warnings,
                                     f->what);
}

void expect_nothing(const fixture_t *f, agv_fault_t fault, agv_state_t state) {
    expect_fault(f, fault, false);
    expect_state(f, state);
    expect_reason(f, AGV_FAULT_NONE);
}

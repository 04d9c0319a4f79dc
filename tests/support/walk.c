#include "walk.h"

#include "unity.h"

void walk_alarm(fixture_t *f, uint8_t alarms) {
    f->traffic[AGV_MSG_VEHICLE_STATUS].data[4] = alarms;
}

void walk_trip(fixture_t *f) {
    walk_alarm(f, ALARM_S_DRIVER);
    fixture_send_now(f, AGV_MSG_VEHICLE_STATUS);
    walk_alarm(f, ALARM_NONE);
    expect_state(f, AGV_STATE_TRIPPED);
    expect_reason(f, AGV_FAULT_S_DRIVER_ALARM);
}

uint32_t walk_until(fixture_t *f, agv_state_t state, uint32_t within_ms) {
    uint32_t took_ms = 0;
    while (took_ms < within_ms && agv_supervisor_state(&f->supervisor) != state) {
        fixture_run(f, 1);
        took_ms++;
    }
    expect_state(f, state);
    return took_ms;
}

void walk_to_safe(fixture_t *f) {
    fixture_active(f);
    walk_trip(f);
    fixture_vehicle_confirms(f);
    fixture_mute_ai(f, true);
    fixture_run(f, 1000);
    expect_state(f, AGV_STATE_SAFE);
}

void walk_to_tripped(fixture_t *f) {
    fixture_active(f);
    fixture_mute_ai(f, true);
    walk_trip(f);
}

void walk_driving(fixture_t *f, int32_t mm_s) {
    fixture_active(f);
    fixture_drive(f, mm_s);
    fixture_run(f, 300);
    fixture_forget_sent(f);
}

void walk_to_tripped_driving(fixture_t *f, int32_t mm_s) {
    walk_driving(f, mm_s);
    fixture_mute_ai(f, true);
    walk_trip(f);
}

uint32_t walk_refusals(const fixture_t *f, uint16_t *missing) {
    agv_event_t event = {0};
    const uint32_t count = fixture_events(f, AGV_EVENT_RESET, 0, ANY, &event);
    *missing = event.missing;
    return count;
}

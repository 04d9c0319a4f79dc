/*
 * Ways through the states that several tests go, and a look at the recorder's events.
 */
#ifndef WALK_H
#define WALK_H

#include "fixture.h"

/* 363h byte 5. */
enum {
    ALARM_NONE = 0x00,
    ALARM_REMOTE_SIGNAL = 0x01,
    ALARM_REMOTE_POWER = 0x02,
    ALARM_EPS_HARDWARE = 0x10,
    ALARM_S_DRIVER = 0x80
};

/* 363h byte 5 from its next frame on. */
void walk_alarm(fixture_t *f, uint8_t alarms);

/* One 363h with the S-driver alarm, now: trips. The alarm is gone in the next one. */
void walk_trip(fixture_t *f);

/* Run until the state is there, which has to be within so many milliseconds. Returns how many it took. */
uint32_t walk_until(fixture_t *f, agv_state_t state, uint32_t within_ms);

/* fixture_active(), a trip, the vehicle confirms, and it has stood for a second: SAFE. */
void walk_to_safe(fixture_t *f);

/* fixture_active(), and a trip that the vehicle does not confirm: it stays engaged and in D. The AI computer is silent. */
void walk_to_tripped(fixture_t *f);

/* fixture_active(), then the vehicle drives with this speed, steadily: wheels and VCU say so. */
void walk_driving(fixture_t *f, int32_t mm_s);

/* walk_driving(), and a trip that the vehicle does not confirm: it drives on, engaged and in D. The AI computer is silent. */
void walk_to_tripped_driving(fixture_t *f, int32_t mm_s);

/* Events of presses that were held in vain; what the last one missed. */
uint32_t walk_refusals(const fixture_t *f, uint16_t *missing);

#endif

/**
 * @file expect.h
 * What a fault has to do, as expectations that several tests share. The bytes are written by hand. A failed expectation
 * names f->what.
 */
#ifndef EXPECT_H
#define EXPECT_H

#include "fixture.h"

/** No 065h is among the safe commands. */
enum { NO_HOLD = -1 };

/** This frame is one of the safe commands, byte for byte but for the alive counter; 065h commands this angle. */
void expect_safe_frame(const fixture_t *f, const fixture_sent_t *frame, int32_t hold_raw);

/**
 * In this call to the supervisor all safe commands were sent at once, one each and to the vehicle, and nothing else:
 * 43Fh, 168h, 075h, and 065h with the held angle.
 */
void expect_safe_commands(const fixture_t *f, uint32_t call, int32_t hold_raw);

/**
 * Just now, in this call, the supervisor tripped for this reason: raised as a trip, recorded, TRIPPED entered, the safe
 * commands sent.
 */
void expect_trip(const fixture_t *f, agv_fault_t fault, uint32_t call, int32_t hold_raw);

/** Just now this fault was raised as a warning: recorded and counted, and nothing else came of it. */
void expect_warning(const fixture_t *f, agv_fault_t fault, agv_state_t state);

/** This fault is not there, and nothing tripped. */
void expect_nothing(const fixture_t *f, agv_fault_t fault, agv_state_t state);

#endif

/*
 * A saved state of the testbed (testbed.h). It does not contain the stored log and the recorder's events, which have no
 * effect on decisions.
 */
#ifndef TESTBED_STATE_H
#define TESTBED_STATE_H

#include <stddef.h>

#include "testbed.h"

typedef struct {
    agv_supervisor_t supervisor;
    struct hal hal;
    rules_t rules;
    traffic_message_t traffic[TRAFFIC_MESSAGES];
    uint8_t store[offsetof(sim_store_t, log)];
    uint8_t recorder[offsetof(agv_recorder_t, events)];
    uint64_t now_ms;
    uint64_t ticked_ms;
    uint32_t unsettled;
} testbed_state_t;

void testbed_save(testbed_state_t *state);
void testbed_restore(const testbed_state_t *state);

#endif

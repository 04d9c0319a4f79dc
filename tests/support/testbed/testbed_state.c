#include "testbed_state.h"

#include <string.h>

void testbed_save(testbed_state_t *state) {
    state->supervisor = testbed.supervisor;
    state->hal = testbed.hal;
    state->rules = testbed.rules;
    memcpy(state->traffic, testbed.traffic, sizeof state->traffic);
    memcpy(state->store, &testbed.store, sizeof state->store);
    memcpy(state->recorder, &testbed.recorder, sizeof state->recorder);
    state->now_ms = testbed.now_ms;
    state->ticked_ms = testbed.ticked_ms;
    state->unsettled = testbed.unsettled;
}

void testbed_restore(const testbed_state_t *state) {
    testbed.supervisor = state->supervisor;
    testbed.hal = state->hal;
    testbed.rules = state->rules;
    memcpy(testbed.traffic, state->traffic, sizeof state->traffic);
    memcpy(&testbed.store, state->store, sizeof state->store);
    memcpy(&testbed.recorder, state->recorder, sizeof state->recorder);
    testbed.now_ms = state->now_ms;
    testbed.ticked_ms = state->ticked_ms;
    testbed.unsettled = state->unsettled;
}

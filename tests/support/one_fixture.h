/*
 * What most integration tests begin with: one fixture, healthy before each test. Included by the test itself, and by no
 * other file; make_runners.rb knows that setUp() is here.
 */
#ifndef ONE_FIXTURE_H
#define ONE_FIXTURE_H

#include "fixture.h"
#include "unity.h"

static fixture_t f;

void setUp(void) {
    fixture_init(&f);
}

#endif

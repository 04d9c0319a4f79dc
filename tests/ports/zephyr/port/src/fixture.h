/**
 * @file fixture.h
 * A port on simulated parts, new for every test.
 */
#ifndef FIXTURE_H
#define FIXTURE_H

#include <zephyr/ztest.h>

#include "fake_parts.h"
#include "hal_zephyr/zephyr_hal.h"

extern hal_t hal;
extern zephyr_hal_retained_t retained;

/** Reset parts and port; every suite's "before". */
void fixture_before(void *unused);

/** Stop the port; every suite's "after". */
void fixture_after(void *unused);

/** Start the port again, as after a reset. @return result of zephyr_hal_init() */
bool fixture_begin(void);

/** The same with controllers that only listen. */
bool fixture_begin_listening(void);

/** Called once, after that many looks of the port into a queue of received frames: what arrives between two looks. */
extern void (*fixture_arrives)(void);
extern uint32_t fixture_looks;

/** Read the vehicle side's status. */
hal_can_status_t fixture_status(void);

#endif

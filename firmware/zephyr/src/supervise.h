/**
 * @file supervise.h
 * One supervisor on the Zephyr port: what its thread does.
 */
#ifndef AGV_APP_SUPERVISE_H
#define AGV_APP_SUPERVISE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/recorder.h"
#include "agv/supervisor.h"
#include "hal_zephyr/zephyr_hal.h"

/** All of it, in static memory. */
typedef struct {
    hal_t hal;
    agv_supervisor_t supervisor;
    agv_ports_t ports;
    uint32_t ticked_ms;
    uint32_t printed; /**< the recorder's next sequence number when events were last printed */
    int8_t printed_led;
#if defined(CONFIG_AGV_SHELL)
    agv_ids_t ids;                  /**< of the messages on this vehicle */
    uint32_t frames[AGV_MSG_COUNT]; /**< received of each message, for the shell's rates */
#endif
} supervise_t;

/** Start it. The recorder and the port's retained memory outlive a reset; the program owns both. */
void supervise_start(supervise_t *self, agv_recorder_t *recorder, zephyr_hal_retained_t *retained);

/** Wait for a frame or a millisecond, and handle it. */
void supervise_once(supervise_t *self);

/**
 * The integrator's own test of RAM, flash and processor. Called after zephyr_hal_init() and before the supervisor starts. The
 * default is a weak function that returns true.
 * @return false: the supervisor starts with SELF_TEST_FAILED, part "processor"
 */
bool supervise_self_test(void);

#endif

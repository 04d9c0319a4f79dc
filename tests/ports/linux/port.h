/**
 * @file port.h
 * The port of a supervisor for the tests: opened with all identifiers; frames are received one by one, sent frames are
 * recorded.
 */
#ifndef TESTS_LINUX_PORT_H
#define TESTS_LINUX_PORT_H

#include "hal_linux/linux_hal.h"

#define PORT_LEFT_MAX 64u

/** The frames that on_left reported. */
typedef struct {
    unsigned count;
    hal_can_side_t sides[PORT_LEFT_MAX];
    hal_can_frame_t frames[PORT_LEFT_MAX];
    uint64_t at_us[PORT_LEFT_MAX];
} port_left_t;

/** A received frame. */
typedef struct {
    hal_can_side_t side;
    hal_can_frame_t frame;
    uint64_t at_us;
} port_received_t;

/** Open the port on these interfaces; the AI side may be NULL. Identifiers 100h .. 10Fh and 065h pass. */
void port_open(hal_t *hal, const char *vehicle, const char *ai, port_left_t *left);

/** The next frame, which must come soon. */
port_received_t port_receive(hal_t *hal);

/** Receive; there must be nothing. */
void port_receive_nothing(hal_t *hal);

/** Receive until nothing comes any more. @return number of frames */
unsigned port_drain(hal_t *hal);

/** Run a program for this many milliseconds: receive, tick. */
void port_run_ms(hal_t *hal, unsigned ms);

/** Send a frame of 8 bytes, vehicle side. */
bool port_send(hal_t *hal, uint32_t id);

/** The status of a side. */
hal_can_status_t port_status(hal_t *hal, hal_can_side_t side);

#endif

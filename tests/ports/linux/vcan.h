/**
 * @file vcan.h
 * A tester on a virtual CAN interface, made of the kernel's own structures and nothing of hal/linux; and commands that
 * change interfaces. Everything that does not work fails the test.
 */
#ifndef TESTS_LINUX_VCAN_H
#define TESTS_LINUX_VCAN_H

#include <stdbool.h>
#include <stdint.h>

#include <linux/can.h>
#include <linux/can/error.h>

#include "hal/can.h"

/** How long is waited for what has to come, and for what must not. */
#define VCAN_SOON_MS 2000
#define VCAN_NEVER_MS 30

/** What was sent is delivered at once, or a moment later when the computer is busy. */
#define VCAN_SETTLED_MS 20

#define VCAN_STUCK_MAX 10

/** In setUp: wait until the kernel stamps frames, which it begins a moment after the first socket that wants it. */
void vcan_begin(void);

/** @name Interfaces: whatever is done to vcan0 and vcan1 is undone by vcan_restore() @{ */
void vcan_up(const char *interface);
void vcan_down(const char *interface);
void vcan_add(const char *interface);
void vcan_remove(const char *interface);

/** From now on vcan0 keeps what is sent in a queue for VCAN_STUCK_MAX frames. (Who listens on this computer hears them.) */
void vcan_stick(void);

/** No longer; what was in the queue is gone. */
void vcan_unstick(void);

/** How often this queue had no room. */
unsigned vcan_dropped(void);

/** Run a shell command. */
void vcan_run(const char *command);

/** In tearDown: the interfaces as at the start, and every tester closed. */
void vcan_restore(void);
/** @} */

/** A raw socket that receives everything, error frames too, but for what it sends. */
int vcan_open(const char *interface);

/** Send a classic frame: identifier with CAN_EFF_FLAG and so on, and 8 bytes of which the first count. */
void vcan_send(int tester, uint32_t can_id, uint8_t length, const uint8_t *data);

/** The same, when the kernel may have no room. @return whether it had */
bool vcan_try(int tester, uint32_t can_id);

/** Send a CAN FD frame, bytes 1, 2, 3, ... */
void vcan_send_fd(int tester, uint32_t can_id, uint8_t length);

/** Send an error frame: its classes, and byte 1 of it. */
void vcan_send_error(int tester, uint32_t classes, uint8_t controller);

/** The next frame has to be this classic one. */
void vcan_expect(int tester, uint32_t can_id, uint8_t length, const uint8_t *data);

/** The next frame has to have this identifier. */
void vcan_expect_id(int tester, uint32_t can_id);

/** No frame comes. */
void vcan_expect_nothing(int tester);

/** Forget what came. */
void vcan_drain(int tester);

/** CLOCK_REALTIME in microseconds. */
uint64_t vcan_real_us(void);

/** Sleep. */
void vcan_pause_ms(unsigned ms);

/** A data frame with 8 bytes 0x11 .. 0x88. */
hal_can_frame_t vcan_frame(uint32_t id);

#endif

/**
 * @file vcan.h
 * A tester on a virtual CAN interface, which uses only the kernel's structures and nothing of hal/linux; and commands
 * that change interfaces. Every error fails the test.
 */
#ifndef TESTS_LINUX_VCAN_H
#define TESTS_LINUX_VCAN_H

#include <stdbool.h>
#include <stdint.h>

#include <linux/can.h>
#include <linux/can/error.h>

#include "hal/can.h"

/** Waiting time for expected frames, and for frames that must not come. */
#define VCAN_SOON_MS 2000
#define VCAN_NEVER_MS 30

/** A sent frame is delivered at once, or a little later on a busy computer. */
#define VCAN_SETTLED_MS 20

#define VCAN_STUCK_MAX 10

/** Call in setUp: waits until the kernel stamps frames, a little after the first socket requested it. */
void vcan_begin(void);

/** @name Interfaces: vcan_restore() undoes all changes of vcan0 and vcan1 @{ */
void vcan_up(const char *interface);
void vcan_down(const char *interface);
void vcan_add(const char *interface);
void vcan_remove(const char *interface);

/** From now on vcan0 keeps sent frames in a queue for VCAN_STUCK_MAX frames. (Local sockets still receive them.) */
void vcan_stick(void);

/** End this; the frames in the queue are lost. */
void vcan_unstick(void);

/** Number of frames that this queue refused. */
unsigned vcan_dropped(void);

/** Run a shell command. */
void vcan_run(const char *command);

/** Call in tearDown: restores the interfaces and closes every tester. */
void vcan_restore(void);
/** @} */

/** A raw socket that receives everything, also error frames, except its own frames. */
int vcan_open(const char *interface);

/** Send a classic frame: identifier with CAN_EFF_FLAG and so on, and 8 bytes of which the first count. */
void vcan_send(int tester, uint32_t can_id, uint8_t length, const uint8_t *data);

/** The same, when the kernel may have no room. @return whether it had */
bool vcan_try(int tester, uint32_t can_id);

/** Send a CAN FD frame, bytes 1, 2, 3, ... */
void vcan_send_fd(int tester, uint32_t can_id, uint8_t length);

/** Send an error frame: its classes, and byte 1 of it. */
void vcan_send_error(int tester, uint32_t classes, uint8_t controller);

/** The next frame must be this classic one. */
void vcan_expect(int tester, uint32_t can_id, uint8_t length, const uint8_t *data);

/** The next frame must have this identifier. */
void vcan_expect_id(int tester, uint32_t can_id);

/** No frame comes. */
void vcan_expect_nothing(int tester);

/** Discard received frames. */
void vcan_drain(int tester);

/** CLOCK_REALTIME in microseconds. */
uint64_t vcan_real_us(void);

/** Sleep. */
void vcan_pause_ms(unsigned ms);

/** A data frame with 8 bytes 0x11 .. 0x88. */
hal_can_frame_t vcan_frame(uint32_t id);

#endif

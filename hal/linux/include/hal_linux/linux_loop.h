/**
 * @file linux_loop.h
 * The event loop: one epoll for sockets and other files, a timer that ticks every millisecond, and the signals that end a
 * program. A program blocks only here.
 */
#ifndef HAL_LINUX_LINUX_LOOP_H
#define HAL_LINUX_LINUX_LOOP_H

#include <stdbool.h>
#include <stdint.h>

/** Result of linux_loop_wait(): bits. */
#define LINUX_LOOP_TICK 0x01u   /**< one or more milliseconds have passed: a late program gets only one tick */
#define LINUX_LOOP_SIGNAL 0x02u /**< SIGINT, SIGTERM or SIGHUP came, or waiting failed: the program must end */
#define LINUX_LOOP_FILE 0x04u   /**< one of the added files is ready; the program must try them */

/** A loop; change it through the functions. */
typedef struct {
    int epoll;
    int timer;
    int signals;
} linux_loop_t;

/**
 * Open the loop. From now on SIGINT, SIGTERM and SIGHUP do not end the program: the loop reports them.
 * @return false: failed; errno is set.
 */
bool linux_loop_open(linux_loop_t *loop);

/**
 * Align the ticks with the whole milliseconds of a clock, so that times counted in milliseconds are evaluated when they
 * change, not up to a millisecond later.
 * @param now_us the clock now
 * @return false: failed, and the ticks continue as before; errno is set.
 */
bool linux_loop_align(linux_loop_t *loop, uint64_t now_us);

/** Add a file to wait for, for reading. @return false: failed, for example for a regular file; errno is set. */
bool linux_loop_add(linux_loop_t *loop, int fd);

/** Remove a file. */
void linux_loop_remove(linux_loop_t *loop, int fd);

/** Wait for an event. @return LINUX_LOOP_* bits, at least one */
uint32_t linux_loop_wait(linux_loop_t *loop);

/** Close the loop. The signals remain blocked. */
void linux_loop_close(linux_loop_t *loop);

/** Room for a message of linux_loop_realtime(). */
#define LINUX_LOOP_ERROR_SIZE 160u

/**
 * Run in real time: SCHED_FIFO at a middle priority, memory locked.
 * @param error LINUX_LOOP_ERROR_SIZE bytes for a one-line error message that names the missing capability
 * @return false: refused, and nothing has changed
 */
bool linux_loop_realtime(char *error);

#endif

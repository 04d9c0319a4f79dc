/**
 * @file linux_loop.h
 * Waiting: one epoll for sockets and other files, a timer that ticks every millisecond, and the signals that end a
 * program. Nothing else of a program blocks.
 */
#ifndef HAL_LINUX_LINUX_LOOP_H
#define HAL_LINUX_LINUX_LOOP_H

#include <stdbool.h>
#include <stdint.h>

/** What linux_loop_wait() returns: a word of bits. */
#define LINUX_LOOP_TICK 0x01u   /**< a millisecond passed, or several: a late program gets one tick, not a burst */
#define LINUX_LOOP_SIGNAL 0x02u /**< SIGINT, SIGTERM or SIGHUP came */
#define LINUX_LOOP_FILE 0x04u   /**< a file that was added is ready, which one the program tries out */

/** A loop; change it through the functions. */
typedef struct {
    int epoll;
    int timer;
    int signals;
} linux_loop_t;

/**
 * Open the loop. From here on SIGINT, SIGTERM and SIGHUP do not end the program: they are told by the loop.
 * @return false: the system refused; errno says why.
 */
bool linux_loop_open(linux_loop_t *loop);

/**
 * Let the ticks fall on the whole milliseconds of a clock, and just after them: what is counted in these is judged when it
 * changes, not up to a millisecond later.
 * @param now_us what the clock reads now
 * @return false: errno says why; the ticks go on as before
 */
bool linux_loop_align(linux_loop_t *loop, uint64_t now_us);

/** Watch a file for reading as well. @return false: errno says why (a regular file cannot be waited for). */
bool linux_loop_add(linux_loop_t *loop, int fd);

/** No longer watch it. */
void linux_loop_remove(linux_loop_t *loop, int fd);

/** Wait until something happens. @return LINUX_LOOP_*, at least one */
uint32_t linux_loop_wait(linux_loop_t *loop);

/** Close; the signals stay held back. */
void linux_loop_close(linux_loop_t *loop);

/** Room for a message of linux_loop_realtime(). */
#define LINUX_LOOP_ERROR_SIZE 160u

/**
 * Run in real time: SCHED_FIFO at a middle priority, memory locked.
 * @param error LINUX_LOOP_ERROR_SIZE bytes for one line that says what was refused and what right it needs
 * @return false: refused, nothing has changed
 */
bool linux_loop_realtime(char *error);

#endif

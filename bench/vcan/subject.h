/**
 * @file subject.h
 * Starts, observes and stops the measured program. That program prints its state to standard output, one JSON object a
 * line, as `host_sim run --events -` does: `"to": "STANDBY"`, and at its end `"received": 123`.
 */
#ifndef BENCH_VCAN_SUBJECT_H
#define BENCH_VCAN_SUBJECT_H

#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>

#define SUBJECT_WORD_SIZE 16u
#define SUBJECT_LINE_SIZE 512u

/** The members may be read. */
typedef struct {
    char **command; /**< ends with NULL; only NULL: there is no program (the kernel's gateway is measured) */
    pid_t pid;      /**< 0: not running */
    int output_fd;
    char line[SUBJECT_LINE_SIZE];
    unsigned length;
    char state[SUBJECT_WORD_SIZE]; /**< as last printed; empty before */
    uint64_t received;             /**< as last printed */
    bool told_received;            /**< `received` was printed since this was last cleared */
} subject_t;

/** Start the program. @return false: printed to standard error */
bool subject_start(subject_t *subject);

/** Read the new output, if any. @return false: the program has ended */
bool subject_listen(subject_t *subject);

/** Whether this is the last printed state. */
bool subject_is(const subject_t *subject, const char *state);

/** End the program with SIGTERM, and read the rest of its output. */
void subject_end(subject_t *subject);

/** Send a signal to the program. */
void subject_signal(const subject_t *subject, int number);

/** CPU time of the program, user and system, in nanoseconds. */
uint64_t subject_cpu_ns(const subject_t *subject);

#endif

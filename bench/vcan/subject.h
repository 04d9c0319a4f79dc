/**
 * @file subject.h
 * The program that is measured: started, asked, stopped. It says its state on standard output, one JSON object a line, as
 * `host_sim run --events -` does: `"to": "STANDBY"`, and in the end `"received": 123`.
 */
#ifndef BENCH_VCAN_SUBJECT_H
#define BENCH_VCAN_SUBJECT_H

#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>

#define SUBJECT_WORD_SIZE 16u
#define SUBJECT_LINE_SIZE 512u

/** Read the members freely. */
typedef struct {
    char **command; /**< ended by NULL; its first NULL: there is no subject (the kernel does it) */
    pid_t pid;      /**< 0: not running */
    int output_fd;
    char line[SUBJECT_LINE_SIZE];
    unsigned length;
    char state[SUBJECT_WORD_SIZE]; /**< as last said; empty before */
    uint64_t received;             /**< as last said */
    bool told_received;            /**< since it was last cleared */
} subject_t;

/** Start it. @return false: said on standard error */
bool subject_start(subject_t *subject);

/** Read what it has said, if anything. @return false: it has ended */
bool subject_listen(subject_t *subject);

/** Whether this was the last state that it said. */
bool subject_is(const subject_t *subject, const char *state);

/** End it with SIGTERM, and hear its last words. */
void subject_end(subject_t *subject);

/** Send it a signal. */
void subject_signal(const subject_t *subject, int number);

/** The processor time that it has used, user and system, in nanoseconds. */
uint64_t subject_cpu_ns(const subject_t *subject);

#endif

/**
 * @file report.h
 * How the program ends and how it says what is wrong: one line on standard error, an exit status.
 */
#ifndef HOST_SIM_REPORT_H
#define HOST_SIM_REPORT_H

#include <stdbool.h>
#include <stddef.h>

/** Exit statuses of every command. */
typedef enum {
    STATUS_OK = 0,       /**< it ran */
    STATUS_UNMET = 1,    /**< it ran, and an expectation did not hold */
    STATUS_UNUSABLE = 2, /**< bad option, bad file, nothing that could be run */
} status_t;

/**
 * Print "host_sim: " and a message as one line on standard error. What came in with the arguments and is no text in one
 * line (a file name with a line break) is shown as `?`; what is longer than some 1000 characters is cut.
 * @return false, so that a check can `return report("...")`
 */
bool report(const char *format, ...) __attribute__((format(printf, 1, 2)));

/** The same for a place in a file: "FILE:LINE: " and the message. */
bool report_at(const char *file, size_t line, const char *format, ...) __attribute__((format(printf, 3, 4)));

/** Like report(), for information that is not an error. */
void note(const char *format, ...) __attribute__((format(printf, 1, 2)));

/** How messages call a file that is read: "standard input" for "-". */
const char *report_input_name(const char *path);

/**
 * Flush standard output and see whether everything arrived.
 * @return false: it did not (full disk, closed pipe); that was reported.
 */
bool report_stdout(void);

#endif

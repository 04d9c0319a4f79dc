/**
 * @file log_foreign.h
 * Logs of formats that are not read: their names, and the command that converts them.
 */
#ifndef HOST_SIM_LOG_FOREIGN_H
#define HOST_SIM_LOG_FOREIGN_H

#include <stddef.h>

#include "text/text.h"

/** More bytes than are needed to tell a format. */
#define LOG_FOREIGN_BYTES 64u

/** A format that is not read. */
typedef struct {
    const char *name;    /**< "a Vector BLF log" */
    const char *convert; /**< what to do; each @ is the file */
} log_foreign_t;

/** Add what a file is and what to do: "a Vector BLF log; convert it: ...". @param path a name longer than 150 is "FILE" */
void log_foreign_advice(text_t *text, const log_foreign_t *format, const char *path);

/** Tell a binary format by the first bytes of a file. @return NULL: none that is known */
const log_foreign_t *log_foreign_binary(const char *bytes, size_t size);

/** Tell a text format by its first line that is not blank. @return NULL: none that is known */
const log_foreign_t *log_foreign_text(const char *line, size_t length);

#endif

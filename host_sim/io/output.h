/**
 * @file output.h
 * A file that is written whole or not at all: under a temporary name beside it, renamed by output_commit. Standard
 * output, pipes and devices are written directly.
 */
#ifndef HOST_SIM_OUTPUT_H
#define HOST_SIM_OUTPUT_H

#include <stdbool.h>
#include <stddef.h>

#define OUTPUT_BUFFER_SIZE 65536u

/** An output. All zero: not open. Some 64 KiB: not for the stack. */
typedef struct {
    const char *name; /**< for messages */
    char *path;       /**< where it goes in the end; NULL: it is there already */
    char *temporary;  /**< where it is until then */
    int fd;
    bool is_open;
    bool is_slow; /**< a pipe, terminal or device: a write may block */
    int error;    /**< errno of the first write that failed; 0 = none */
    size_t used;
    char buffer[OUTPUT_BUFFER_SIZE];
} output_t;

/**
 * Open an output. From here on signals are held back (interrupt.h) if it has a temporary file.
 * @param path "-" or /dev/stdout = standard output; must outlive the output
 * @return false: it cannot be written; was reported.
 */
bool output_open(output_t *output, const char *path);

/**
 * Open a regular file without a temporary file, for readers that follow it while it grows. An existing file is
 * unchanged until output_empty().
 * @return false: it cannot be written; was reported.
 */
bool output_open_in_place(output_t *output, const char *path);

/** Empty a file that output_open_in_place() has opened. @return false: was reported. */
bool output_empty(output_t *output);

/**
 * Open a named pipe without waiting for its reader. The pipe keeps its content for a later reader.
 * @return false: it cannot be written; was reported.
 */
bool output_open_pipe(output_t *output, const char *path);

/** Write. After a failure nothing more is written. @return false: this or an earlier write failed; not reported. */
bool output_write(output_t *output, const void *bytes, size_t size);

/** Write what is in the buffer. @return as output_write() */
bool output_flush(output_t *output);

/**
 * Everything is written: flush, close, and put it in its place. Nothing, successfully, when it is not open.
 * @return false: not everything arrived; was reported, and the temporary file is gone.
 */
bool output_commit(output_t *output);

/** Flush several. @return false: one failed, now or before; was reported, and its temporary file is gone. */
bool output_flush_all(output_t outputs[], size_t count);

/**
 * Commit several: none is put in its place unless all could be written.
 * @return false: not everything arrived; was reported, for the first of them.
 */
bool output_commit_all(output_t outputs[], size_t count);

/** Forget it: an unfinished file is removed. Nothing when it is not open. */
void output_discard(output_t *output);

/** Whether a path means standard output: "-", /dev/stdout. NULL does not. */
bool output_is_stdout(const char *path);

/** The role of a file in a command, for output_check_distinct(). */
typedef struct {
    const char *role; /**< "--out" */
    const char *path; /**< NULL: not used */
    bool is_written;
} output_role_t;

/**
 * Check that no file has two roles of which one is written. "-" is the file that standard input or output is; as two
 * outputs it always counts.
 * @return false: two have; was reported.
 */
bool output_check_distinct(const output_role_t *roles, size_t count);

/** Check that a path is a folder in which files can be written. @param role "--found" @return false: was reported */
bool output_check_folder(const char *role, const char *path);

/** Write a file of these bytes. @return false: was reported */
bool output_put(output_t *output, const char *path, const void *bytes, size_t size);

#endif

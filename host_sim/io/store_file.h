/**
 * @file store_file.h
 * What outlives a reset, as a file: the latch, the recorder's log in flash, and the recorder's RAM. It is text, one
 * item a line in hexadecimal, ended by a checksum:
 *
 *     agv-store 1
 *     latch 96091C01...
 *     record 0000...      oldest first, one line each
 *     recorder 0000...
 *     check 1A2B3C4D      CRC-32 over all lines before
 */
#ifndef HOST_SIM_STORE_FILE_H
#define HOST_SIM_STORE_FILE_H

#include <stdbool.h>

#include "agv/recorder.h"
#include "hal_sim/sim_store.h"
#include "io/output.h"

/**
 * Read a store. A file that is not there is an empty store. A file that is damaged anywhere (cut off, changed, no store
 * at all) is read as far as it goes, and its latch as bytes that fail their checksum. The supervisor then treats
 * the latch as corrupt (FSM-7).
 *
 * @param store is filled in
 * @param recorder is filled in; all zero where the file has none
 * @return false: it exists and cannot be read (a folder, no permission); was reported.
 */
bool store_file_load(const char *path, sim_store_t *store, agv_recorder_t *recorder);

/** Whether a file begins as a store does. */
bool store_file_is(const char *text, size_t size);

/**
 * Whether a store may be written to a path: there is no file, a store that may be damaged, or one that was cut off at its very
 * beginning, but not a file of another kind. What cannot be read is left to store_file_load().
 * @return false: was reported
 */
bool store_file_may_replace(const char *path);

/** As store_file_load, of a file that is in memory. */
void store_file_take(const char *text, size_t size, sim_store_t *store, agv_recorder_t *recorder);

/** Write a store. A failure is remembered in @p output. */
void store_file_save(output_t *output, const sim_store_t *store, const agv_recorder_t *recorder);

#endif

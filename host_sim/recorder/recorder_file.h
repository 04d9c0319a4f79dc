/**
 * @file recorder_file.h
 * The events of a device's flight recorder, read from a file in any of the forms in which they leave it:
 * - text with lines `agv-event HEX` (the shell's `agv dump`, with whatever a terminal adds around them), or lines that
 *   are one event in hexadecimal; a line `agv-version TEXT` names the device's version and configuration;
 * - the `--store` file of replay;
 * - bytes: an agv_recorder_t, or events one after another, as a debugger dumps them from RAM or flash.
 */
#ifndef HOST_SIM_RECORDER_FILE_H
#define HOST_SIM_RECORDER_FILE_H

#include <stdbool.h>
#include <stddef.h>

#include "agv/recorder.h"

#define RECORDER_DEVICE_SIZE 120u

/** Events in the order of their sequence numbers, each once. All zero: none. */
typedef struct {
    agv_event_t *events;
    size_t count;
    size_t room;
    size_t damaged;                    /**< lines of text that were no valid event */
    char device[RECORDER_DEVICE_SIZE]; /**< version and configuration of the device; "": not known */
} recorder_events_t;

/** Read a file; "-" = standard input. @return false: it cannot be read, or has no event; was reported */
bool recorder_file_read(const char *path, recorder_events_t *events);

/** Release them. */
void recorder_events_free(recorder_events_t *events);

#endif

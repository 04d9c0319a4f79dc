/**
 * @file events.h
 * What the flight recorder records, as lines of the log.
 */
#ifndef AGV_APP_EVENTS_H
#define AGV_APP_EVENTS_H

#include <stdint.h>

#include "agv/config.h"
#include "agv/recorder.h"

/** Print version and configuration. @return the sequence number of the first event of this run */
uint32_t events_begin(const agv_config_t *config, const agv_recorder_t *recorder);

/** Print the events from sequence number *printed on that the recorder still has, and advance *printed. */
void events_print(const agv_recorder_t *recorder, uint32_t *printed);

/** Initial value of *printed of events_print_led(): no code was printed yet. */
#define EVENTS_NO_LED INT8_MIN

/** Print the LED code (agv_supervisor_led_code()) if it differs from *printed, and update *printed. */
void events_print_led(uint32_t now_ms, int8_t code, int8_t *printed);

/** The version, with what makes this build differ from one that acts. */
const char *events_version(void);

/** What the board of this build does not have, such as "second clock, reset button"; "nothing" if it has everything. */
const char *events_lacks(void);

#endif

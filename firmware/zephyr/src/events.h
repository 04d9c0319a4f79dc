/**
 * @file events.h
 * What the flight recorder records, as lines of the log.
 */
#ifndef AGV_APP_EVENTS_H
#define AGV_APP_EVENTS_H

#include <stdint.h>

#include "agv/config.h"
#include "agv/recorder.h"

/** Print version and configuration. @return from which event on this run is to be told */
uint32_t events_begin(const agv_config_t *config, const agv_recorder_t *recorder);

/** Print what is new since *told, at most what the recorder still has. */
void events_tell(const agv_recorder_t *recorder, uint32_t *told);

/** What *told stands for before anything was told. */
#define EVENTS_NO_LED INT8_MIN

/** Print the LED's code, as agv_supervisor_led_code(), when it is not the one that was told. */
void events_tell_led(uint32_t now_ms, int8_t code, int8_t *told);

/** The version, with what makes this build differ from one that acts. */
const char *events_version(void);

#endif

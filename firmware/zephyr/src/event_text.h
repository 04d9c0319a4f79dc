/**
 * @file event_text.h
 * An event of the flight recorder as a line for people: the console and the shell print the same.
 */
#ifndef AGV_APP_EVENT_TEXT_H
#define AGV_APP_EVENT_TEXT_H

#include <stddef.h>
#include <stdint.h>

#include "agv/recorder.h"

/** Size of a buffer that every line fits into. */
#define EVENT_TEXT_SIZE 160u

/** Write the line, such as "812 ms: => TRIPPED: EPS_HEARTBEAT_LOST", without a line end. */
void event_text(const agv_event_t *event, char *line, size_t size);

/** Write the names of the parts that failed the self-test (HAL_SELF_TEST_* bits), each after a space. */
void event_text_parts(uint32_t failed, char *words, size_t size);

#endif

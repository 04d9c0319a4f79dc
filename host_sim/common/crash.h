/**
 * @file crash.h
 * AGV_EVENT_CRASH in words: how the run before ended.
 */
#ifndef HOST_SIM_CRASH_H
#define HOST_SIM_CRASH_H

#include "agv/recorder.h"

#define CRASH_TEXT_SIZE 80u

/** Program counter and link register of the event; 0 where they are not known. */
typedef struct {
    uint32_t pc;
    uint32_t lr;
} crash_addresses_t;

crash_addresses_t crash_addresses(const agv_event_t *event);

/** Such as "reset by lock-up, stack overflow, PC 08001234, LR 08005678". @return text */
const char *crash_text(const agv_event_t *event, char text[CRASH_TEXT_SIZE]);

#endif

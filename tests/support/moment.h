/*
 * A moment of the world (world.h), to come back to very often. What is in the log and in the recorder decides nothing and
 * is left as it is.
 */
#ifndef MOMENT_H
#define MOMENT_H

#include <stddef.h>

#include "world.h"

typedef struct {
    agv_supervisor_t supervisor;
    struct hal hal;
    rules_t rules;
    traffic_message_t traffic[TRAFFIC_MESSAGES];
    uint8_t store[offsetof(sim_store_t, log)];
    uint8_t recorder[offsetof(agv_recorder_t, events)];
    uint64_t now_ms;
    uint64_t ticked_ms;
    uint32_t unsettled;
} moment_t;

/* The one that is kept. */
extern moment_t moment;

void moment_save(void);
void moment_restore(void);

#endif

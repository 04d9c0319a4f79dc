/*
 * The faults, and the causes that one message can be for them: a bit, silence, a counter that stands still, a value. By
 * hand from docs/requirements.md (SUP-2 to SUP-5) and docs/protocol.md, in the order of the faults' ranks.
 */
#ifndef CAUSES_H
#define CAUSES_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/faults.h"
#include "traffic.h"

/* A fault. The order is the rank. */
typedef struct {
    const char *name;
    bool trip;   /* its default class */
    uint8_t led; /* flash code; 0: none of its own */
} fault_row_t;

enum { FAULT_ROWS = 68 };
extern const fault_row_t FAULT_ROW[FAULT_ROWS];

typedef enum {
    BY_BITS,         /* `bits` set in byte `byte` of `count` frames */
    BY_BITS_ENGAGED, /* the same, while engaged */
    BY_SILENCE,      /* no frame for more than `count` ms */
    BY_SILENCE_ENGAGED,
    BY_FREEZE, /* no change of the counter for more than `count` ms */
    BY_VALUE   /* `bits` are the value of byte `byte`; raised within `count` ms while engaged */
} cause_how_t;

typedef struct {
    agv_fault_t fault;
    cause_how_t how;
    unsigned message;
    uint32_t count;
    uint8_t byte; /* 1..8, as the document counts */
    uint8_t bits;
    bool steering_held; /* the safe commands of a trip while engaged hold the steering; not with an EPS at fault */
} cause_t;

enum { CAUSES = 38 };
extern const cause_t CAUSE[CAUSES];

/* The cause of the traffic of this row begins, or is over. */
void cause_set(traffic_message_t traffic[TRAFFIC_MESSAGES], const cause_t *cause, bool on);

#endif

/**
 * @file faults.h
 * The faults and their properties (both from fault_table.def), and sets of faults.
 */
#ifndef AGV_FAULTS_H
#define AGV_FAULTS_H

#include <stdbool.h>
#include <stdint.h>

/** A fault. The value is its rank; 0 is the highest. */
typedef enum {
#define AGV_FAULT(name, class, led, flags) AGV_FAULT_##name,
#define AGV_FAULT_TRANSIENT(name, class, led, flags) AGV_FAULT_##name,
#include "agv/fault_table.def"
#undef AGV_FAULT
#undef AGV_FAULT_TRANSIENT
    AGV_FAULT_COUNT,
    AGV_FAULT_NONE = AGV_FAULT_COUNT
} agv_fault_t;

/** Whether a fault warns or trips when it is raised. */
typedef enum { AGV_CLASS_WARN = 0, AGV_CLASS_TRIP = 1 } agv_fault_class_t;

/** Number of 32-bit words of a set of faults. */
#define AGV_FAULT_WORDS (((uint32_t)AGV_FAULT_COUNT + 31u) / 32u)

/** A set of faults: bit n % 32 of word n / 32 is the fault of rank n. */
typedef struct {
    uint32_t words[AGV_FAULT_WORDS];
} agv_fault_set_t;

/** Add a fault to a set (@p in true) or remove it (false). AGV_FAULT_NONE and values above are ignored. */
void agv_fault_set_put(agv_fault_set_t *set, uint32_t fault, bool in);

/** Whether a set contains a fault. False for AGV_FAULT_NONE and values above. */
bool agv_fault_is_in(const agv_fault_set_t *set, uint32_t fault);

/** The highest-ranking fault of a set; AGV_FAULT_NONE if the set is empty. */
uint32_t agv_fault_first(const agv_fault_set_t *set);

/** Properties of a fault; fault_table.def explains them. */
#define AGV_FAULT_FLAG_UNRESETTABLE 0x01u
#define AGV_FAULT_FLAG_FIXED 0x02u
#define AGV_FAULT_FLAG_FROM_AI 0x04u
#define AGV_FAULT_FLAG_OF_EPS 0x08u
#define AGV_FAULT_FLAG_GATEWAY 0x10u

/** The properties of a fault, AGV_FAULT_FLAG_* bits; 0 for AGV_FAULT_NONE and values above. */
uint8_t agv_fault_flags(uint32_t fault);

/** The default class of a fault; AGV_CLASS_WARN for AGV_FAULT_NONE and values above. */
agv_fault_class_t agv_fault_default_class(uint32_t fault);

/** LED code of a fault: 1..17; 0 if the protocol document has none, and for AGV_FAULT_NONE and values above. */
uint8_t agv_fault_led_code(uint32_t fault);

#endif

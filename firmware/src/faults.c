#include "agv/faults.h"

enum {
    NONE = AGV_FAULT_FLAG_NONE,
    UNRESETTABLE = AGV_FAULT_FLAG_UNRESETTABLE,
    EVENT = AGV_FAULT_FLAG_EVENT,
    FIXED = AGV_FAULT_FLAG_FIXED,
    FROM_AI = AGV_FAULT_FLAG_FROM_AI,
    OF_EPS = AGV_FAULT_FLAG_OF_EPS
};

_Static_assert((uint32_t)AGV_FAULT_COUNT <= 64u, "a fault set has 64 bits");

static const uint8_t led_codes[AGV_FAULT_COUNT] = {
#define AGV_FAULT(name, class, led, flags) (led),
#include "agv/fault_table.def"
#undef AGV_FAULT
};

/* Each set is made from the table by the compiler: one term a row. */
enum { WARN = AGV_CLASS_WARN, TRIP = AGV_CLASS_TRIP };
#define IF_SET(condition, name) | ((agv_fault_set_t)((condition) ? 1u : 0u) << (uint32_t)AGV_FAULT_##name)

#define AGV_FAULT(name, class, led, flags) IF_SET(((flags) & UNRESETTABLE) != 0, name)
const agv_fault_set_t agv_faults_unresettable = 0u
#include "agv/fault_table.def"
    ;
#undef AGV_FAULT

#define AGV_FAULT(name, class, led, flags) IF_SET(((flags) & EVENT) != 0, name)
const agv_fault_set_t agv_faults_events = 0u
#include "agv/fault_table.def"
    ;
#undef AGV_FAULT

#define AGV_FAULT(name, class, led, flags) IF_SET(((flags) & FIXED) != 0, name)
const agv_fault_set_t agv_faults_fixed = 0u
#include "agv/fault_table.def"
    ;
#undef AGV_FAULT

#define AGV_FAULT(name, class, led, flags) IF_SET(((flags) & FROM_AI) != 0, name)
const agv_fault_set_t agv_faults_from_ai = 0u
#include "agv/fault_table.def"
    ;
#undef AGV_FAULT

#define AGV_FAULT(name, class, led, flags) IF_SET(((flags) & OF_EPS) != 0, name)
const agv_fault_set_t agv_faults_of_eps = 0u
#include "agv/fault_table.def"
    ;
#undef AGV_FAULT

#define AGV_FAULT(name, class, led, flags) IF_SET((class) == TRIP, name)
const agv_fault_set_t agv_faults_default_trips = 0u
#include "agv/fault_table.def"
    ;
#undef AGV_FAULT

static const uint8_t event_faults[AGV_EVENT_FAULT_COUNT] = {AGV_FAULT_SUPERVISOR_RESET,
                                                            AGV_FAULT_TX_GATE_REFUSED,
                                                            AGV_FAULT_STEP_OVERRUN,
                                                            AGV_FAULT_AI_COMMAND_OUT_OF_RANGE,
                                                            AGV_FAULT_FOREIGN_COMMAND_SENDER,
                                                            AGV_FAULT_COMMAND_TOO_FAST,
                                                            AGV_FAULT_RX_OVERRUN,
                                                            AGV_FAULT_STORE_INVALID};

static bool in_set(agv_fault_set_t set, agv_fault_t fault) {
    return (set & agv_fault_bit(fault)) != 0u;
}

agv_fault_t agv_fault_highest(agv_fault_set_t set) {
    uint32_t rank = 0u;
    while ((rank < (uint32_t)AGV_FAULT_COUNT) && !in_set(set, (agv_fault_t)rank)) {
        rank++;
    }
    return (agv_fault_t)rank;
}

uint8_t agv_fault_led_code(agv_fault_t fault) {
    return ((uint32_t)fault < (uint32_t)AGV_FAULT_COUNT) ? led_codes[fault] : 0u;
}

void agv_faults_init(agv_faults_t *faults) {
    *faults = (agv_faults_t){0};
}

void agv_faults_levels(agv_faults_t *faults, agv_fault_set_t judged, agv_fault_set_t causes) {
    faults->active = (faults->active & ~judged) | (causes & judged);
}

void agv_faults_event(agv_faults_t *faults, agv_fault_t fault, uint32_t now_ms) {
    for (uint32_t i = 0u; i < AGV_EVENT_FAULT_COUNT; i++) {
        if (event_faults[i] == (uint8_t)fault) {
            faults->active |= agv_fault_bit(fault);
            faults->event_ms[i] = now_ms;
        }
    }
}

void agv_faults_tick(agv_faults_t *faults, uint32_t now_ms, uint16_t event_hold_ms) {
    if ((faults->active & agv_faults_events) == 0u) {
        return;
    }
    for (uint32_t i = 0u; i < AGV_EVENT_FAULT_COUNT; i++) {
        if ((now_ms - faults->event_ms[i]) >= event_hold_ms) {
            faults->active &= ~agv_fault_bit((agv_fault_t)event_faults[i]);
        }
    }
}

agv_fault_changes_t agv_faults_report(agv_faults_t *faults, agv_fault_set_t trip_classes) {
    const agv_fault_set_t tripping = faults->active & trip_classes;
    const agv_fault_set_t reclassified = (tripping ^ faults->tripping) & faults->active;
    const agv_fault_changes_t changes = {
        .raised = (faults->active & ~faults->reported) | reclassified,
        .ended = faults->reported & ~faults->active,
        .trips = tripping & ~faults->tripping,
    };
    faults->reported = faults->active;
    faults->tripping = tripping;
    return changes;
}

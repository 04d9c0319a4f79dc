#include "agv/faults.h"

#include "agv/core.h"

/* A row is kept as one byte, LED code and properties; EVENT and FIXED beyond it make sets only. */
enum {
    NONE = 0,
    LED_CODE = 0x1F,
    UNRESETTABLE = AGV_FAULT_FLAG_UNRESETTABLE,
    FROM_AI = AGV_FAULT_FLAG_FROM_AI,
    OF_EPS = AGV_FAULT_FLAG_OF_EPS,
    KEPT = LED_CODE | UNRESETTABLE | FROM_AI | OF_EPS,
    EVENT = 0x100,
    FIXED = 0x200
};

_Static_assert((uint32_t)AGV_FAULT_COUNT <= 64u, "a fault set has 64 bits");

/* What is FIXED trips by default: nothing could be weaker than a warning. */
#define AGV_FAULT(name, class, led, flags)                                                                             \
    _Static_assert((AGV_CLASS_##class == AGV_CLASS_TRIP) || (((flags) & FIXED) == 0), #name);                          \
    _Static_assert((led) <= LED_CODE, #name);
#include "agv/fault_table.def"
#undef AGV_FAULT

static const uint8_t rows[AGV_FAULT_COUNT] = {
#define AGV_FAULT(name, class, led, flags) (((led) | (flags)) & KEPT),
#include "agv/fault_table.def"
#undef AGV_FAULT
};

static const uint8_t event_faults[AGV_EVENT_FAULT_COUNT] = {AGV_FAULT_SUPERVISOR_RESET,
                                                            AGV_FAULT_TX_GATE_REFUSED,
                                                            AGV_FAULT_STEP_OVERRUN,
                                                            AGV_FAULT_AI_COMMAND_OUT_OF_RANGE,
                                                            AGV_FAULT_FOREIGN_COMMAND_SENDER,
                                                            AGV_FAULT_COMMAND_TOO_FAST,
                                                            AGV_FAULT_RX_OVERRUN,
                                                            AGV_FAULT_STORE_INVALID};

/* The sets are made from the table by the compiler: one term a row. */
enum { WARN = AGV_CLASS_WARN, TRIP = AGV_CLASS_TRIP };
#define IF_SET(condition, name) | ((agv_fault_set_t)((condition) ? 1u : 0u) << (uint32_t)AGV_FAULT_##name)

#define AGV_FAULT(name, class, led, flags) IF_SET(((flags) & FIXED) != 0, name)
const agv_fault_set_t agv_faults_fixed = 0u
#include "agv/fault_table.def"
    ;
#undef AGV_FAULT

#define AGV_FAULT(name, class, led, flags) IF_SET(((flags) & EVENT) != 0, name)
const agv_fault_set_t agv_faults_events = 0u
#include "agv/fault_table.def"
    ;
#undef AGV_FAULT

#define AGV_FAULT(name, class, led, flags) IF_SET((class) == TRIP, name)
const agv_fault_set_t agv_faults_default_trips = 0u
#include "agv/fault_table.def"
    ;
#undef AGV_FAULT

static bool is_fault(uint32_t fault) {
    return fault < (uint32_t)AGV_FAULT_COUNT;
}

agv_fault_set_t agv_fault_bit(uint32_t fault) {
    return is_fault(fault) ? ((agv_fault_set_t)1u << fault) : 0u;
}

bool agv_fault_is_in(agv_fault_set_t set, uint32_t fault) {
    /* In words of 32 bits: a shift of 64 by a variable is long on a small processor. */
    const uint32_t word = (uint32_t)((fault < 32u) ? set : (set >> 32u));
    return is_fault(fault) && (((word >> (fault & 31u)) & 1u) != 0u);
}

uint8_t agv_fault_flags(uint32_t fault) {
    return is_fault(fault) ? (uint8_t)(rows[fault] & ~(uint32_t)LED_CODE) : 0u;
}

uint8_t agv_fault_led_code(uint32_t fault) {
    return is_fault(fault) ? (uint8_t)(rows[fault] & (uint32_t)LED_CODE) : 0u;
}

void agv_faults_level(agv_core_t *core, uint32_t fault, bool cause) {
    if (is_fault(fault) && (cause != agv_faults_is_active(core, fault))) {
        core->faults.marks[fault] ^= AGV_MARK_ACTIVE;
        core->summary.changed = true;
    }
}

void agv_faults_event(agv_core_t *core, uint32_t fault) {
    for (uint32_t i = 0u; i < AGV_EVENT_FAULT_COUNT; i++) {
        if (event_faults[i] == fault) {
            agv_watch_start(core, (uint32_t)AGV_WATCH_EVENT + i);
            agv_faults_level(core, fault, true);
        }
    }
}

void agv_faults_tick(agv_core_t *core) {
    for (uint32_t i = 0u; i < AGV_EVENT_FAULT_COUNT; i++) {
        if (agv_watch_reached(core, (uint32_t)AGV_WATCH_EVENT + i)) {
            agv_faults_level(core, event_faults[i], false);
        }
    }
}

bool agv_faults_is_active(const agv_core_t *core, uint32_t fault) {
    return is_fault(fault) && ((core->faults.marks[fault] & AGV_MARK_ACTIVE) != 0u);
}

agv_fault_set_t agv_faults_marked(const agv_faults_t *faults, uint8_t marks) {
    agv_fault_set_t set = 0u;
    for (uint32_t i = 0u; i < (uint32_t)AGV_FAULT_COUNT; i++) {
        if ((faults->marks[i] & marks) == marks) {
            set |= agv_fault_bit(i);
        }
    }
    return set;
}

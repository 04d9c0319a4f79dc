/**
 * @file fault_table.c
 * The properties of each fault, from fault_table.def, and sets of faults (faults.h).
 */
#include "agv/faults.h"

#define AGV_FAULT_TRANSIENT AGV_FAULT

enum {
    NONE = 0,
    UNRESETTABLE = AGV_FAULT_FLAG_UNRESETTABLE,
    FIXED = AGV_FAULT_FLAG_FIXED,
    FROM_AI = AGV_FAULT_FLAG_FROM_AI,
    OF_EPS = AGV_FAULT_FLAG_OF_EPS,
    GATEWAY = AGV_FAULT_FLAG_GATEWAY,
    WARN = AGV_CLASS_WARN,
    TRIP = AGV_CLASS_TRIP
};

static const struct {
    uint8_t class_by_default;
    uint8_t led_code;
    uint8_t flags;
} rows[AGV_FAULT_COUNT] = {
#define AGV_FAULT(name, class, led, properties)                                                                        \
    [AGV_FAULT_##name] = {.class_by_default = (class), .led_code = (led), .flags = (uint8_t)(properties)},
#include "agv/fault_table.def"
#undef AGV_FAULT
};

static bool is_fault(uint32_t fault) {
    return fault < (uint32_t)AGV_FAULT_COUNT;
}

void agv_fault_set_put(agv_fault_set_t *set, uint32_t fault, bool in) {
    if (is_fault(fault)) {
        const uint32_t bit = (uint32_t)1u << (fault % 32u);
        uint32_t *const word = &set->words[fault / 32u];
        *word = in ? (*word | bit) : (*word & ~bit);
    }
}

bool agv_fault_is_in(const agv_fault_set_t *set, uint32_t fault) {
    return is_fault(fault) && (((set->words[fault / 32u] >> (fault % 32u)) & 1u) != 0u);
}

uint32_t agv_fault_first(const agv_fault_set_t *set) {
    for (uint32_t i = 0u; i < AGV_FAULT_WORDS; i++) {
        uint32_t fault = i * 32u;
        for (uint32_t word = set->words[i]; word != 0u; word >>= 1u) {
            if ((word & 1u) != 0u) {
                return fault;
            }
            fault++;
        }
    }
    return AGV_FAULT_NONE;
}

uint8_t agv_fault_flags(uint32_t fault) {
    return is_fault(fault) ? rows[fault].flags : 0u;
}

agv_fault_class_t agv_fault_default_class(uint32_t fault) {
    return is_fault(fault) ? (agv_fault_class_t)rows[fault].class_by_default : AGV_CLASS_WARN;
}

uint8_t agv_fault_led_code(uint32_t fault) {
    return is_fault(fault) ? rows[fault].led_code : 0u;
}

/* What single frames say in their bytes, for rules.c: nothing of it needs a memory. */
#ifndef RULES_BYTES_H
#define RULES_BYTES_H

#include <stdbool.h>
#include <stdint.h>

#include "rules.h"

enum { SIGNALS = 0, GEAR = 1, THROTTLE = 2, STEERING = 3 };
enum { SLOW_MM_S = 50 };

static inline bool is_fast(const uint8_t *data) {
    const uint32_t raw =
        (uint32_t)data[0] | ((uint32_t)data[1] << 8u) | ((uint32_t)data[2] << 16u) | ((uint32_t)data[3] << 24u);
    const uint32_t amount = (raw < 0x80000000u) ? raw : (0u - raw);
    return amount >= (uint32_t)SLOW_MM_S;
}

static inline bool in_range(int command, const uint8_t *data) {
    switch (command) {
    case GEAR:
        return (data[0] == 1u) || (data[0] == 2u) || (data[0] == 4u) || (data[0] == 8u);
    case THROTTLE:
        return data[0] <= 250u;
    case STEERING:
        return ((unsigned)data[0] | ((unsigned)data[1] << 8u)) <= 18000u;
    default:
        return true;
    }
}

/* Reserved bits of a command as 0 (P14). */
static inline void clear_reserved(int command, uint8_t data[8]) {
    static const uint8_t USED[RULES_COMMANDS][8] = {{0, 0, 0, 0, 0xF0, 0, 0, 0xFF}, {0xFF}, {0xFF}, {0xFF, 0xFF}};
    for (int i = 0; i < 8; i++) {
        data[i] &= USED[command][i];
    }
}

/* TOP-1: whether a VCU may have taken it for a command other than the safe one. */
static inline bool differs_from_safe(int command, const hal_can_frame_t *frame) {
    if (frame->length != 8u) {
        return true;
    }
    switch (command) {
    case SIGNALS:
        return (frame->data[4] & 0xF0u) != 0x70u;
    case GEAR:
        return frame->data[0] != 8u;
    default:
        return frame->data[0] != 0u;
    }
}

#endif

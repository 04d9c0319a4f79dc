/* Meaning of states and single frames, for oracle.c and rules.c. */
#ifndef FRAME_BYTES_H
#define FRAME_BYTES_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/state.h"
#include "hal/can.h"

enum { SIGNALS = 0, GEAR = 1, THROTTLE = 2, STEERING = 3 };
enum { SLOW_MM_S = 50 };

static inline bool commands_safe(agv_state_t state) {
    return (state != AGV_STATE_STANDBY) && (state != AGV_STATE_ACTIVE);
}

static inline bool is_latched(agv_state_t state) {
    return commands_safe(state) && (state != AGV_STATE_INIT);
}

static inline uint16_t word_at(const uint8_t *low) {
    return (uint16_t)(low[0] | ((unsigned)low[1] << 8));
}

static inline bool is_gear(uint8_t gear) {
    return (gear == 1) || (gear == 2) || (gear == 4) || (gear == 8);
}

static inline bool is_fast(const uint8_t *data) {
    const uint32_t raw = word_at(data) | ((uint32_t)word_at(&data[2]) << 16);
    const uint32_t amount = (raw < 0x80000000u) ? raw : (0 - raw);
    return amount >= SLOW_MM_S;
}

static inline bool in_range(int command, const uint8_t *data) {
    switch (command) {
    case GEAR:
        return is_gear(data[0]);
    case THROTTLE:
        return data[0] <= 250;
    case STEERING:
        return word_at(data) <= 18000;
    default:
        return true;
    }
}

/* Reserved bits of a command as 0 (P14). */
static inline void clear_reserved(int command, uint8_t data[8]) {
    static const uint8_t USED[][8] = {{0, 0, 0, 0, 0xF0, 0, 0, 0xFF}, {0xFF}, {0xFF}, {0xFF, 0xFF}};
    for (int i = 0; i < 8; i++) {
        data[i] &= USED[command][i];
    }
}

/* TOP-1: whether a VCU may obey the frame as a command other than the safe one. */
static inline bool differs_from_safe(int command, const hal_can_frame_t *frame) {
    if (frame->length != 8) {
        return true;
    }
    switch (command) {
    case SIGNALS:
        return (frame->data[4] & 0xF0u) != 0x70u;
    case GEAR:
        return frame->data[0] != 8;
    default:
        return frame->data[0] != 0;
    }
}

#endif

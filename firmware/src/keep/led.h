/**
 * @file led.h
 * The alarm LED (LED-1): code n = n flashes (200 ms on, 200 ms off), then 1.4 s dark; healthy = 1 s on, 1 s off; a fault
 * without a code = 100 ms on, 100 ms off; healthy in shadow mode = 100 ms on, 1.9 s off (TOP-4).
 */
#ifndef AGV_LED_H
#define AGV_LED_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/faults.h"

/** Codes beside 1..17. */
#define AGV_LED_HEALTHY 0
#define AGV_LED_BLINK (-1)

/** The LED's pattern. */
typedef struct {
    int8_t code;
    bool on;
    uint16_t phase_ms; /**< within the pattern */
} agv_led_t;

/** The code of a fault: 1..17 or AGV_LED_BLINK; AGV_LED_HEALTHY for AGV_FAULT_NONE. */
int32_t agv_led_code(uint32_t fault);

/**
 * Advance the pattern. A new code starts its pattern at once.
 * @return whether the LED must be switched, to `on`.
 */
bool agv_led_tick(agv_led_t *led, int8_t code, bool shadow, uint32_t elapsed_ms);

#endif

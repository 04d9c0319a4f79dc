#include "agv/led.h"

enum {
    FLASH_ON_MS = 200,
    FLASH_MS = 400,
    PAUSE_MS = 1400,
    BLINK_ON_MS = 100,
    BLINK_MS = 200,
    HEALTHY_ON_MS = 1000,
    HEALTHY_MS = 2000,
    SHADOW_ON_MS = 100
};

int8_t agv_led_code(agv_fault_t fault) {
    const uint8_t code = agv_fault_led_code(fault);
    if ((code == 0u) && (fault != AGV_FAULT_NONE)) {
        return AGV_LED_BLINK;
    }
    return (int8_t)code;
}

static uint32_t period_ms(int8_t code) {
    if (code > AGV_LED_HEALTHY) {
        /* The dark 200 ms of the last flash belong to the flash; the pause comes on top. */
        return ((uint32_t)code * FLASH_MS) + PAUSE_MS;
    }
    return (code == AGV_LED_HEALTHY) ? HEALTHY_MS : BLINK_MS;
}

static bool is_on(int8_t code, bool shadow, uint32_t phase_ms) {
    if (code > AGV_LED_HEALTHY) {
        return (phase_ms < ((uint32_t)code * FLASH_MS)) && ((phase_ms % FLASH_MS) < FLASH_ON_MS);
    }
    if (code == AGV_LED_HEALTHY) {
        return phase_ms < (uint32_t)(shadow ? SHADOW_ON_MS : HEALTHY_ON_MS);
    }
    return phase_ms < BLINK_ON_MS;
}

bool agv_led_tick(agv_led_t *led, int8_t code, bool shadow, uint32_t elapsed_ms) {
    const bool was_on = led->on;
    const uint32_t period = period_ms(code);
    uint32_t phase = 0u;
    if (code == led->code) {
        phase = led->phase_ms + elapsed_ms;
        phase = (phase < period) ? phase : (phase % period);
    }
    led->code = code;
    led->phase_ms = (uint16_t)phase;
    led->on = is_on(code, shadow, phase);
    return led->on != was_on;
}

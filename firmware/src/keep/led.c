#include "keep/led.h"

/* The second half of a flash is dark; the pause follows after the last one. */
enum { FLASH_MS = 400, PAUSE_MS = 1400, BLINK_MS = 200, HEALTHY_MS = 2000, SHADOW_ON_MS = 100 };

int32_t agv_led_code(uint32_t fault) {
    const uint8_t code = agv_fault_led_code(fault);
    if ((code == 0u) && (fault != (uint32_t)AGV_FAULT_NONE)) {
        return AGV_LED_BLINK;
    }
    return code;
}

bool agv_led_tick(agv_led_t *led, int8_t code, bool shadow, uint32_t elapsed_ms) {
    const bool was_on = led->on;
    const uint32_t since_ms = (code == led->code) ? (led->phase_ms + elapsed_ms) : 0u;
    uint32_t flash_ms = BLINK_MS;
    uint32_t flashes_ms = BLINK_MS;
    uint32_t period_ms = BLINK_MS;
    if (code > AGV_LED_HEALTHY) {
        flash_ms = FLASH_MS;
        flashes_ms = (uint32_t)code * FLASH_MS;
        period_ms = flashes_ms + PAUSE_MS;
    } else if (code == AGV_LED_HEALTHY) {
        flash_ms = HEALTHY_MS;
        flashes_ms = shadow ? SHADOW_ON_MS : HEALTHY_MS;
        period_ms = HEALTHY_MS;
    } else {
        /* blink */
    }
    const uint32_t phase_ms = since_ms % period_ms;
    led->code = code;
    led->phase_ms = (uint16_t)phase_ms;
    led->on = (phase_ms < flashes_ms) && ((phase_ms % flash_ms) < (flash_ms / 2u));
    return led->on != was_on;
}

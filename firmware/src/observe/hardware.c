#include "observe/hardware.h"

#include "hal/clock.h"
#include "hal/inputs.h"
#include "hal/self_test.h"

/* The clocks are compared once a second, and may differ by a 20th (5 %). */
enum { COMPARISON_MS = 1000, DEVIATION_PART = 20 };

void agv_hardware_self_test(agv_hardware_t *hardware, agv_fault_monitor_t *faults, hal_t *hal, uint32_t failed) {
    hardware->failed |= (uint8_t)(hal_self_test(hal) | failed);
    agv_fault_monitor_set(faults, AGV_FAULT_SELF_TEST_FAILED, hardware->failed != 0u);
}

/* HW-1: a contact that comes and goes is found too. */
static void check_feedback(agv_hardware_t *hardware, agv_fault_monitor_t *faults, const agv_config_t *config,
                           uint32_t elapsed_ms, bool output_closed) {
    const uint32_t full = 2u * (uint32_t)config->output_feedback_ms;
    const bool closed = hardware->feedback == (uint8_t)HAL_CONTACT_CLOSED;
    const uint32_t spent = hardware->mismatch_halves;
    const uint32_t ms = (elapsed_ms < full) ? elapsed_ms : full;
    uint32_t halves;
    if ((hardware->feedback != (uint8_t)HAL_CONTACT_NONE) && (closed != output_closed)) {
        halves = ((2u * ms) < (full - spent)) ? (spent + (2u * ms)) : full;
    } else {
        halves = (ms < spent) ? (spent - ms) : 0u;
    }
    hardware->mismatch_halves = (uint16_t)halves;
    if ((halves == full) || (halves == 0u)) {
        agv_fault_monitor_set(faults, AGV_FAULT_OUTPUT_FEEDBACK, halves == full);
    }
}

/* HW-3: until it has been read alike for the first time, the button is unknown: one that is stuck is no press. */
static void debounce(agv_hardware_t *hardware, uint8_t contact, uint32_t elapsed_ms) {
    const uint8_t raw = (uint8_t)((contact == (uint8_t)HAL_CONTACT_CLOSED) ? AGV_BUTTON_DOWN : AGV_BUTTON_UP);
    const uint32_t ms =
        hardware->button_ms + ((elapsed_ms < AGV_BUTTON_DEBOUNCE_MS) ? elapsed_ms : AGV_BUTTON_DEBOUNCE_MS);
    if (raw != hardware->button_raw) {
        hardware->button_raw = raw;
        hardware->button_ms = 0u;
    } else if (ms < AGV_BUTTON_DEBOUNCE_MS) {
        hardware->button_ms = (uint8_t)ms;
    } else {
        hardware->button_ms = AGV_BUTTON_DEBOUNCE_MS;
        hardware->button = raw;
    }
}

/* HW-4: a clock that runs too fast or too slow makes all times wrong. */
static void compare_clocks(agv_hardware_t *hardware, agv_fault_monitor_t *faults, hal_t *hal, uint32_t now_ms) {
    const uint32_t first_ms = now_ms - hardware->compared_ms;
    uint32_t second_ms;
    if ((hardware->compared && (first_ms < (uint32_t)COMPARISON_MS)) || !hal_clock_second_ms(hal, &second_ms)) {
        return;
    }
    if (hardware->compared) {
        const uint32_t passed_ms = second_ms - hardware->second_ms;
        const uint32_t off_ms = (passed_ms > first_ms) ? (passed_ms - first_ms) : (first_ms - passed_ms);
        agv_fault_monitor_set(faults, AGV_FAULT_CLOCK_DEVIATION, off_ms > (first_ms / (uint32_t)DEVIATION_PART));
    }
    hardware->compared = true;
    hardware->compared_ms = now_ms;
    hardware->second_ms = second_ms;
}

void agv_hardware_tick(agv_hardware_t *hardware, agv_fault_monitor_t *faults, const agv_timers_t *timers,
                       const agv_config_t *config, hal_t *hal, uint32_t elapsed_ms, bool output_closed) {
    hal_inputs_t inputs;
    hal_inputs_read(hal, &inputs);
    const bool stop_reads = inputs.emergency_stop != (uint8_t)HAL_CONTACT_NONE;
    agv_fault_monitor_set(faults, AGV_FAULT_EMERGENCY_STOP,
                          stop_reads && (inputs.emergency_stop != (uint8_t)HAL_CONTACT_CLOSED));
    hardware->feedback = inputs.output_feedback;
    check_feedback(hardware, faults, config, elapsed_ms, output_closed);
    debounce(hardware, inputs.reset_button, elapsed_ms);
    compare_clocks(hardware, faults, hal, timers->now_ms);
    agv_hardware_self_test(hardware, faults, hal, 0u);
}

bool agv_hardware_output_reads_open(const agv_hardware_t *hardware) {
    return (hardware->feedback == (uint8_t)HAL_CONTACT_NONE) || (hardware->feedback == (uint8_t)HAL_CONTACT_OPEN);
}

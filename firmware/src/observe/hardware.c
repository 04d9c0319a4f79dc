#include "observe/hardware.h"

#include "hal/clock.h"
#include "hal/inputs.h"
#include "hal/self_test.h"

/* The clocks are compared when one of them has come a second further, and may differ by a 20th (5 %). */
enum { COMPARISON_MS = 1000, DEVIATION_PART = 20 };

/* Optional parts that the board was seen to have, and what one of them reads when it is silent. */
enum { HAS_FEEDBACK = 0x01, HAS_STOP = 0x02, HAS_CLOCK = 0x04, SILENT = UINT8_MAX };

void agv_hardware_self_test(agv_hardware_t *hardware, agv_fault_monitor_t *faults, hal_t *hal, uint32_t failed) {
    hardware->failed |= (uint8_t)(hal_self_test(hal) | failed);
    agv_fault_monitor_set(faults, AGV_FAULT_SELF_TEST_FAILED, hardware->failed != 0u);
}

/* A board has an input always or never. One that is gone is broken: it counts as an invalid value. */
static uint8_t contact_of(agv_hardware_t *hardware, uint8_t part, uint8_t contact) {
    if (contact != (uint8_t)HAL_CONTACT_NONE) {
        hardware->parts |= part;
        return contact;
    }
    return ((hardware->parts & part) != 0u) ? (uint8_t)SILENT : contact;
}

/* HW-1: a contact that comes and goes is found too. */
static void check_feedback(agv_hardware_t *hardware, agv_fault_monitor_t *faults, const agv_config_t *config,
                           uint32_t elapsed_ms, bool output_closed) {
    const uint8_t right = (uint8_t)(output_closed ? HAL_CONTACT_CLOSED : HAL_CONTACT_OPEN);
    const bool wrong = (hardware->feedback != (uint8_t)HAL_CONTACT_NONE) && (hardware->feedback != right);
    /* After a change the contact cannot be wrong for longer than the change is old: a late step does not count in full. */
    const uint32_t ms = (hardware->was_closed == output_closed) ? elapsed_ms : 1u;
    hardware->was_closed = output_closed;
    agv_budget_add(&hardware->mismatch, wrong, ms, config->output_feedback_ms);
    agv_fault_monitor_set(faults, AGV_FAULT_OUTPUT_FEEDBACK, hardware->mismatch.present);
}

/* An input that falls silent ends a press, but does not release the button. */
static uint8_t button_of(uint8_t contact) {
    if (contact == (uint8_t)HAL_CONTACT_CLOSED) {
        return AGV_BUTTON_DOWN;
    }
    return (uint8_t)((contact == (uint8_t)HAL_CONTACT_OPEN) ? AGV_BUTTON_UP : AGV_BUTTON_UNHEARD);
}

/* HW-3: a button is unknown until its input has been stable for the debounce time, so one that is stuck is no press. */
static void debounce(agv_hardware_t *hardware, uint8_t contact, uint32_t elapsed_ms) {
    const uint8_t raw = button_of(contact);
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

/* HW-4: a clock that runs too fast or too slow makes all times wrong. A second clock that falls silent stands still. */
static void compare_clocks(agv_hardware_t *hardware, agv_fault_monitor_t *faults, hal_t *hal, uint32_t now_ms) {
    const bool known = (hardware->parts & (uint8_t)HAS_CLOCK) != 0u;
    uint32_t second_ms;
    if (!hal_clock_second_ms(hal, &second_ms)) {
        if (!known) {
            return;
        }
        second_ms = hardware->second_ms;
    }
    const uint32_t first_passed_ms = now_ms - hardware->compared_ms;
    const uint32_t second_passed_ms = second_ms - hardware->second_ms;
    const bool is_slow = second_passed_ms > first_passed_ms;
    const uint32_t longer_ms = is_slow ? second_passed_ms : first_passed_ms;
    if (known && (longer_ms < (uint32_t)COMPARISON_MS)) {
        return;
    }
    if (known) {
        const uint32_t off_ms = longer_ms - (is_slow ? first_passed_ms : second_passed_ms);
        agv_fault_monitor_set(faults, AGV_FAULT_CLOCK_DEVIATION, off_ms > (longer_ms / (uint32_t)DEVIATION_PART));
    }
    hardware->parts |= (uint8_t)HAS_CLOCK;
    hardware->compared_ms = now_ms;
    hardware->second_ms = second_ms;
}

void agv_hardware_tick(agv_hardware_t *hardware, agv_fault_monitor_t *faults, const agv_timers_t *timers,
                       const agv_config_t *config, hal_t *hal, uint32_t elapsed_ms, bool output_closed) {
    hal_inputs_t inputs = {0};
    hal_inputs_read(hal, &inputs);
    const uint8_t stop = contact_of(hardware, HAS_STOP, inputs.emergency_stop);
    agv_fault_monitor_set(faults, AGV_FAULT_EMERGENCY_STOP,
                          (stop != (uint8_t)HAL_CONTACT_NONE) && (stop != (uint8_t)HAL_CONTACT_CLOSED));
    hardware->feedback = contact_of(hardware, HAS_FEEDBACK, inputs.output_feedback);
    check_feedback(hardware, faults, config, elapsed_ms, output_closed);
    debounce(hardware, inputs.reset_button, elapsed_ms);
    compare_clocks(hardware, faults, hal, timers->now_ms);
    agv_hardware_self_test(hardware, faults, hal, 0u);
}

bool agv_hardware_output_reads_open(const agv_hardware_t *hardware) {
    return (hardware->feedback == (uint8_t)HAL_CONTACT_NONE) || (hardware->feedback == (uint8_t)HAL_CONTACT_OPEN);
}

/**
 * @file hardware.h
 * The hardware that answers, evaluated at every tick: contact of the safety output, emergency stop, reset button, second
 * clock, self-test (HW-1 to HW-4). A board without one of them raises nothing; one that it had and that falls silent is broken.
 */
#ifndef AGV_HARDWARE_H
#define AGV_HARDWARE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/fault_monitor.h"
#include "base/score.h"
#include "base/timers.h"
#include "hal/hal.h"

/** Time for which the input of the reset button must be stable, ms (HW-3). */
enum { AGV_BUTTON_DEBOUNCE_MS = 20 };

/** State of a button. */
typedef enum {
    AGV_BUTTON_UNKNOWN,
    AGV_BUTTON_DOWN,
    AGV_BUTTON_UP,
    AGV_BUTTON_UNHEARD /**< unknown: the remote receiver has lost signal or power, or the push button's input is silent */
} agv_button_t;

/** What is known of the hardware. */
typedef struct {
    uint32_t compared_ms;  /**< time of the last comparison of the clocks */
    uint32_t second_ms;    /**< the second clock at that time */
    agv_budget_t mismatch; /**< how long the contact was wrong */
    uint8_t feedback;      /**< hal_contact_t of the safety output at the last tick, or an invalid value */
    uint8_t button;        /**< agv_button_t, debounced */
    uint8_t button_raw;    /**< agv_button_t at the last tick */
    uint8_t button_ms;     /**< time for which button_raw has not changed */
    uint8_t failed;        /**< HAL_SELF_TEST_* bits of the parts that have failed */
    bool was_closed;       /**< command of the safety output at the last tick */
    uint8_t parts;         /**< optional parts that the board was seen to have */
} agv_hardware_t;

/** Run the self-test of the port, and raise SELF_TEST_FAILED if a part has failed. @param failed parts found elsewhere */
void agv_hardware_self_test(agv_hardware_t *hardware, agv_fault_monitor_t *faults, hal_t *hal, uint32_t failed);

/**
 * Read and evaluate the inputs and the clocks; raises OUTPUT_FEEDBACK, EMERGENCY_STOP and CLOCK_DEVIATION.
 * @param output_closed what the safety output was set to
 */
void agv_hardware_tick(agv_hardware_t *hardware, agv_fault_monitor_t *faults, const agv_timers_t *timers,
                       const agv_config_t *config, hal_t *hal, uint32_t elapsed_ms, bool output_closed);

/** Whether the contact does not contradict an open output: it reads open, or is not read back. */
bool agv_hardware_output_reads_open(const agv_hardware_t *hardware);

#endif

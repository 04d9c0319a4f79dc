/* Start of the port. */
#include "hal_template/hal_template.h"

void hal_template_init(hal_t *hal) {
    *hal = (struct hal){.reset_cause = HAL_RESET_UNKNOWN};
    /*
     * TODO, in this order:
     * 1. Safety output pin: open, and driven (not floating). A pull resistor keeps it open from reset on.
     * 2. Hardware watchdog: start it with the configured period (default 100 ms), so that it cannot be stopped.
     * 3. Reset cause: read the register once, into hal->reset_cause, and clear it, so that it does not appear again after
     *    the next reset. Report HAL_RESET_UNKNOWN if the cause is not certain: after HAL_RESET_POWER_ON a tripped
     *    supervisor is no longer tripped (FSM-7).
     * 4. Clock, LED pin, store.
     * 5. CAN controllers: the vehicle's bit rate, no acceptance filter (the supervisor counts what it rejects), automatic
     *    retransmission on, automatic recovery from bus-off OFF, no reception of own frames.
     * 6. Fault handlers of the processor (hard fault, stack overflow): open the safety output first (FSM-4), then wait
     *    for the watchdog without feeding it.
     */
}

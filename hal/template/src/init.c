/* Begin. */
#include "hal_template/hal_template.h"

void hal_template_init(hal_t *hal) {
    *hal = (struct hal){.reset_cause = HAL_RESET_UNKNOWN};
    /*
     * TODO, in this order:
     * 1. Safety output pin: open, and driven (not floating). Let the hardware have it open from reset on: a pull resistor.
     * 2. Hardware watchdog: start it with the configured period (default 100 ms), so that it cannot be stopped.
     * 3. Reset cause: read the register once, into hal->reset_cause, and clear it, or the next reset shows this one too.
     *    What the hardware cannot tell apart stays HAL_RESET_UNKNOWN: only a sure power-on may be HAL_RESET_POWER_ON,
     *    because that is the one cause after which a supervisor that was tripped is not tripped any more (FSM-7).
     * 4. Clock, LED pin, store.
     * 5. CAN controllers: the vehicle's bit rate, no acceptance filter (the supervisor counts what it rejects), automatic
     *    retransmission on, automatic recovery from bus-off OFF, no reception of frames that it sent itself.
     * 6. Fault handlers of the processor (hard fault, stack overflow): open the safety output first of all (FSM-4), do
     *    not feed the watchdog, wait for it.
     */
}

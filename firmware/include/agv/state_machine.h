/**
 * @file state_machine.h
 * What to do: INIT, STANDBY, ACTIVE, TRIPPED, SAFE (FSM-1 to FSM-5, FSM-9), the reset, the safety output. Knows facts
 * only, no frames and no hardware. Its times are watches (watch.h).
 */
#ifndef AGV_STATE_MACHINE_H
#define AGV_STATE_MACHINE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/faults.h"
#include "agv/state.h"

struct agv_core;

/** What may be missing for a reset or for leaving INIT: words of the events `reset` and `startup`. */
#define AGV_MISSING_STATE 0x01u         /**< not in SAFE */
#define AGV_MISSING_VCU_HEARTBEAT 0x02u /**< VCU not alive */
#define AGV_MISSING_EPS_HEARTBEAT 0x04u /**< EPS not alive */
#define AGV_MISSING_TRIP_CAUSE 0x08u    /**< a trip cause is active */
#define AGV_MISSING_STANDSTILL 0x10u
#define AGV_MISSING_MANUAL 0x20u   /**< manual is not reported */
#define AGV_MISSING_BUTTON 0x40u   /**< the press began before the trip, or there is none */
#define AGV_MISSING_MESSAGES 0x80u /**< a trip-class status message is not fresh */
#define AGV_MISSING_ALL 0xFFu

/**
 * The facts that a step goes by: a word of bits. A fact whose lack may be what is missing has the bit of AGV_MISSING_X.
 * What is wrong stands in core->summary.
 */
#define AGV_FACT_VCU_ALIVE AGV_MISSING_VCU_HEARTBEAT
#define AGV_FACT_EPS_ALIVE AGV_MISSING_EPS_HEARTBEAT
#define AGV_FACT_STANDSTILL AGV_MISSING_STANDSTILL
#define AGV_FACT_MANUAL AGV_MISSING_MANUAL
#define AGV_FACT_MESSAGES AGV_MISSING_MESSAGES /**< every trip-class status message is fresh */
#define AGV_FACT_ENGAGED 0x0040u               /**< beside MANUAL, as in 363h */
#define AGV_FACT_AI_ALIVE 0x0200u
#define AGV_FACT_AUTOPILOT_OFF 0x0400u /**< confirmed by the VCU */
#define AGV_FACT_IN_PARK 0x0800u       /**< confirmed by the VCU */
#define AGV_FACT_BUTTON_DOWN 0x1000u   /**< remote button 1 is pressed */
#define AGV_FACT_BUTTON_UP 0x2000u     /**< and is not; neither before the VCU has told */
#define AGV_FACT_OUTPUT_UNSAFE 0x4000u /**< bus-off, transmit stalled, watchdog not fed: the output opens at once */

/** What a step did: a word of bits, and the AGV_MISSING_* of what is reported. */
#define AGV_STEP_TRIPPED 0x0100u           /**< entered TRIPPED by a trip: send all safe commands at once */
#define AGV_STEP_RESET_ACCEPTED 0x0200u    /**< left SAFE */
#define AGV_STEP_RESET_REFUSED 0x0400u     /**< a press was held in vain; the missing bits say why */
#define AGV_STEP_STARTUP_TIMED_OUT 0x0800u /**< the missing bits say what keeps INIT from being left */

/** The machine. */
typedef struct {
    uint8_t state;         /**< agv_state_t */
    uint8_t latched;       /**< AGV_LATCH_CLOSED in TRIPPED and SAFE, else AGV_LATCH_OPEN */
    uint8_t first_reason;  /**< agv_fault_t */
    uint8_t unresettable;  /**< agv_fault_t: what only a power-on ends */
    uint8_t press_missing; /**< AGV_MISSING_* seen during the press */
    bool button_before;
    bool pressed_after_trip; /**< a rising edge came after the trip */
    bool press_refused;      /**< and was reported */
    bool park_released;      /**< 168h may be sent */
    bool output_closed;
    bool startup_reported;
    bool safe_state_unconfirmed; /**< the fault of that name has a cause */
} agv_state_machine_t;

/** Start, from zeroed memory, in INIT (@p reason AGV_FAULT_NONE) or in TRIPPED; the output is open. */
void agv_state_machine_start(struct agv_core *core, uint32_t reason);

/** One step, after each frame and each tick. At most one transition. @return AGV_STEP_* and AGV_MISSING_* */
uint32_t agv_state_machine_step(struct agv_core *core, uint32_t facts);

/** 168h P was sent: from its first time after the trip the vehicle has confirm_timeout_ms. */
void agv_state_machine_park_sent(struct agv_core *core);

/** Whether state and latch fit together (INT-5). */
bool agv_state_machine_is_sound(const agv_state_machine_t *machine);

#endif

/**
 * @file state_machine.h
 * What to do: INIT, STANDBY, ACTIVE, TRIPPED, SAFE (FSM-1 to FSM-5, FSM-9), the reset, the safety output. Knows facts
 * only, no frames and no hardware.
 */
#ifndef AGV_STATE_MACHINE_H
#define AGV_STATE_MACHINE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/faults.h"
#include "agv/state.h"
#include "agv/timer.h"

/** What may be missing for a reset or for leaving INIT: words of the events `reset` and `startup`. */
#define AGV_MISSING_STATE 0x01u         /**< not in SAFE */
#define AGV_MISSING_VCU_HEARTBEAT 0x02u /**< VCU not alive */
#define AGV_MISSING_EPS_HEARTBEAT 0x04u /**< EPS not alive */
#define AGV_MISSING_TRIP_CAUSE 0x08u    /**< a trip cause is active */
#define AGV_MISSING_STANDSTILL 0x10u
#define AGV_MISSING_MANUAL 0x20u   /**< manual is not reported */
#define AGV_MISSING_BUTTON 0x40u   /**< the press began before the trip, or there is none */
#define AGV_MISSING_MESSAGES 0x80u /**< a trip-class status message is not fresh */

/** The facts that a step goes by. */
typedef struct {
    agv_fault_t raised;  /**< highest-ranking fault raised as a trip since the last step; AGV_FAULT_NONE */
    agv_fault_t cause;   /**< highest-ranking trip with a cause now that does not come from the AI; AGV_FAULT_NONE */
    agv_fault_t forever; /**< unresettable fault with a cause; AGV_FAULT_NONE */
    uint8_t missing;     /**< AGV_MISSING_* but STATE, BUTTON and TRIP_CAUSE */
    bool ai_cause;       /**< a trip that comes from the AI has a cause */
    bool engaged;
    bool ai_alive;
    bool autopilot_off; /**< confirmed by the VCU */
    bool in_park;       /**< confirmed by the VCU */
    bool button;        /**< remote button 1 is pressed */
    bool button_known;  /**< the VCU has told so since the start */
    bool output_unsafe; /**< bus-off, transmit stalled, watchdog not fed: the output opens at once */
} agv_situation_t;

/** The machine. */
typedef struct {
    agv_timer_t good;        /**< INIT: all well; TRIPPED, SAFE: everything that a reset needs holds */
    agv_timer_t init;        /**< since the start, in INIT */
    agv_timer_t unconfirmed; /**< since the trip or the withdrawal of the confirmation: autopilot off is awaited */
    agv_timer_t park_sent;   /**< since the first P, or that withdrawal: P is awaited */
    agv_timer_t park_wait;   /**< since the trip or the start: P at the latest (park: at_standstill) */
    agv_timer_t press;       /**< button 1 held, in TRIPPED or SAFE */
    uint8_t state;           /**< agv_state_t */
    uint8_t latched;         /**< AGV_LATCH_CLOSED in TRIPPED and SAFE, else AGV_LATCH_OPEN */
    uint8_t first_reason;    /**< agv_fault_t */
    uint8_t unresettable;    /**< agv_fault_t: what only a power-on ends */
    uint8_t press_missing;   /**< AGV_MISSING_* seen during the press */
    bool button_before;
    bool pressed_after_trip; /**< a rising edge came after the trip */
    bool press_refused;      /**< and was reported */
    bool park_released;      /**< 168h may be sent */
    bool output_closed;
    bool startup_reported;
    bool safe_state_unconfirmed; /**< the fault of that name has a cause */
} agv_state_machine_t;

/** What a step did. */
typedef struct {
    uint8_t from;    /**< state before */
    uint8_t missing; /**< AGV_MISSING_* of what is reported */
    bool tripped;    /**< entered TRIPPED by a trip: send all safe commands at once */
    bool reset_accepted;
    bool reset_refused;     /**< a press was held in vain; `missing` says why */
    bool startup_timed_out; /**< `missing` says what keeps INIT from being left */
} agv_step_t;

/** Start in INIT (@p reason AGV_FAULT_NONE) or in TRIPPED; the output is open. */
void agv_state_machine_start(agv_state_machine_t *machine, agv_fault_t reason, uint32_t now_ms);

/** One step, after each frame and each tick. At most one transition. */
agv_step_t agv_state_machine_step(agv_state_machine_t *machine, const agv_config_t *config,
                                  const agv_situation_t *situation, uint32_t now_ms);

/** 168h P was sent: from its first time after the trip the vehicle has confirm_timeout_ms. */
void agv_state_machine_park_sent(agv_state_machine_t *machine, uint32_t now_ms);

/** Whether state and latch fit together (INT-5). */
bool agv_state_machine_is_sound(const agv_state_machine_t *machine);

#endif

/**
 * @file state_machine.h
 * The state machine: INIT, STANDBY, ACTIVE, TRIPPED, SAFE (FSM-1 to FSM-5, FSM-9), the reset, the safety output. Its
 * inputs are facts, not frames or hardware. Its output is a set of actions, which the supervisor carries out.
 */
#ifndef AGV_STATE_MACHINE_H
#define AGV_STATE_MACHINE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/recorder.h"
#include "agv/state.h"
#include "base/fault_monitor.h"
#include "base/timers.h"

/** Inputs of a step: bits. A fact that is a condition of a reset has the bit of its AGV_MISSING_*. */
#define AGV_FACT_VCU_ALIVE AGV_MISSING_VCU_HEARTBEAT
#define AGV_FACT_EPS_ALIVE AGV_MISSING_EPS_HEARTBEAT
#define AGV_FACT_STANDSTILL AGV_MISSING_STANDSTILL
#define AGV_FACT_MANUAL AGV_MISSING_MANUAL
#define AGV_FACT_MESSAGES AGV_MISSING_MESSAGES  /**< every trip-class status message is fresh */
#define AGV_FACT_IDLE AGV_MISSING_THROTTLE      /**< 050h is at idle; in INIT: it is not above idle */
#define AGV_FACT_OUTPUT_OPEN AGV_MISSING_OUTPUT /**< the contact reads open, is not read back, or may be closed */
#define AGV_FACT_ENGAGED 0x1000u
#define AGV_FACT_AI_ALIVE 0x2000u
#define AGV_FACT_AUTOPILOT_OFF 0x4000u  /**< confirmed by the VCU */
#define AGV_FACT_IN_PARK 0x8000u        /**< confirmed by the VCU */
#define AGV_FACT_SLOW 0x10000u          /**< wheels and VCU report standstill speeds now */
#define AGV_FACT_WHEELS_STAND 0x20000u  /**< both wheels have been slow for standstill_ms */
#define AGV_FACT_OUTPUT_UNSAFE 0x40000u /**< the safety output must be open (FSM-4) */
#define AGV_FACT_RESET 0x80000u         /**< a press of the button resets (reset_button.h) */

/** Actions that a step requests: bits. */
#define AGV_ACTION_TRIP 0x0001u           /**< entered TRIPPED by a trip: send all safe commands at once */
#define AGV_ACTION_RESET_ACCEPTED 0x0002u /**< left SAFE */
#define AGV_ACTION_RESET_REFUSED 0x0004u  /**< report that a press did not reset; `missing` says why */
#define AGV_ACTION_STARTUP_LATE 0x0008u   /**< report that INIT takes too long; `missing` says why */
#define AGV_ACTION_STATE 0x0010u          /**< report a change of state; `from` is the old state */
#define AGV_ACTION_DISCARD 0x0020u        /**< discard the frames that wait to be sent to the vehicle */
#define AGV_ACTION_PURGE 0x0040u          /**< also discard the frames in the controller */
#define AGV_ACTION_UNLATCH 0x0080u        /**< unlatch all faults */
#define AGV_ACTION_STORE_LATCH 0x0100u    /**< store the changed latch record */
#define AGV_ACTION_OPEN_OUTPUT 0x0200u    /**< open the safety output, before anything that takes time */
#define AGV_ACTION_CLOSE_OUTPUT 0x0400u   /**< close the safety output, after everything else */
#define AGV_ACTION_END_ENGAGEMENT 0x0800u /**< left ACTIVE for STANDBY: a gateway sends throttle 0 (TOP-2) */

/** Result of a step. */
typedef struct {
    uint32_t what;        /**< AGV_ACTION_* bits */
    uint16_t missing;     /**< AGV_MISSING_* bits */
    uint8_t from;         /**< agv_state_t before the step */
    uint8_t first_reason; /**< agv_fault_t before the step */
} agv_actions_t;

/** The state machine. */
typedef struct {
    uint8_t state;        /**< agv_state_t */
    uint8_t latched;      /**< AGV_LATCH_CLOSED in TRIPPED and SAFE, else AGV_LATCH_OPEN */
    uint8_t first_reason; /**< agv_fault_t */
    uint8_t unresettable; /**< agv_fault_t that only a power-on ends; AGV_FAULT_NONE: there is none */
    bool park_released;   /**< 168h may be sent */
    bool output_closed;
    bool startup_reported;
} agv_state_machine_t;

/** Start, from zeroed memory, with the output open: in INIT if @p reason is AGV_FAULT_NONE, otherwise in TRIPPED. */
void agv_state_machine_start(agv_state_machine_t *machine, agv_timers_t *timers, const agv_config_t *config,
                             uint32_t reason);

/** Forbid every reset, because of an unresettable fault found before the start. Ignored for AGV_FAULT_NONE. */
void agv_state_machine_forbid_reset(agv_state_machine_t *machine, uint32_t fault);

/** Make one step, with at most one transition. Call after each frame and each tick. */
agv_actions_t agv_state_machine_step(agv_state_machine_t *machine, agv_timers_t *timers, const agv_config_t *config,
                                     const agv_fault_summary_t *faults, uint32_t facts);

/** The conditions of a reset that do not hold (FSM-3): AGV_MISSING_* bits. */
uint32_t agv_state_machine_lacks_for_reset(const agv_state_machine_t *machine, const agv_fault_summary_t *faults,
                                           uint32_t facts);

/** Whether INIT takes too long (STARTUP_TIMEOUT). */
bool agv_state_machine_is_startup_late(const agv_state_machine_t *machine, const agv_timers_t *timers);

/** Whether the state is valid and matches the latch (INT-5). */
bool agv_state_machine_is_sound(const agv_state_machine_t *machine);

#endif

/**
 * @file state_machine.h
 * What to do: INIT, STANDBY, ACTIVE, TRIPPED, SAFE (FSM-1 to FSM-5, FSM-9), the reset, the safety output. It knows facts
 * only, no frames and no hardware, and says what is to be done as a list of actions; the supervisor carries them out.
 */
#ifndef AGV_STATE_MACHINE_H
#define AGV_STATE_MACHINE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/recorder.h"
#include "agv/state.h"
#include "base/timers.h"
#include "decide/fault_monitor.h"

/** The facts that a step goes by: bits. A fact whose lack may be what is missing has the bit of AGV_MISSING_X. */
#define AGV_FACT_VCU_ALIVE AGV_MISSING_VCU_HEARTBEAT
#define AGV_FACT_EPS_ALIVE AGV_MISSING_EPS_HEARTBEAT
#define AGV_FACT_STANDSTILL AGV_MISSING_STANDSTILL
#define AGV_FACT_MANUAL AGV_MISSING_MANUAL
#define AGV_FACT_MESSAGES AGV_MISSING_MESSAGES /**< every trip-class status message is fresh */
#define AGV_FACT_IDLE AGV_MISSING_THROTTLE     /**< 050h is at idle */
#define AGV_FACT_ENGAGED 0x1000u
#define AGV_FACT_AI_ALIVE 0x2000u
#define AGV_FACT_AUTOPILOT_OFF 0x4000u  /**< confirmed by the VCU */
#define AGV_FACT_IN_PARK 0x8000u        /**< confirmed by the VCU */
#define AGV_FACT_SLOW 0x10000u          /**< wheels and VCU report the speeds of a standstill now */
#define AGV_FACT_WHEELS_STAND 0x20000u  /**< both wheels have been slow for standstill_ms */
#define AGV_FACT_OUTPUT_UNSAFE 0x40000u /**< a reason for the output to be open (FSM-4) */
#define AGV_FACT_RESET 0x80000u         /**< a press of the button resets (reset_button.h) */

/** Actions: bits. */
#define AGV_ACTION_TRIP 0x0001u           /**< entered TRIPPED by a trip: send all safe commands at once */
#define AGV_ACTION_RESET_ACCEPTED 0x0002u /**< left SAFE */
#define AGV_ACTION_RESET_REFUSED 0x0004u  /**< report a press that was in vain; `missing` says why */
#define AGV_ACTION_STARTUP_LATE 0x0008u   /**< report that INIT lasts; `missing` says what keeps it */
#define AGV_ACTION_STATE 0x0010u          /**< the state is another one: `from` says which it was */
#define AGV_ACTION_DISCARD 0x0020u        /**< what waits to be sent to the vehicle is never sent */
#define AGV_ACTION_PURGE 0x0040u          /**< nor what the controller has taken */
#define AGV_ACTION_UNLATCH 0x0080u        /**< what was latched is over */
#define AGV_ACTION_STORE_LATCH 0x0100u    /**< the latch record is another one */
#define AGV_ACTION_OPEN_OUTPUT 0x0200u    /**< open the safety output, before anything that takes time */
#define AGV_ACTION_CLOSE_OUTPUT 0x0400u   /**< close it, after everything else */
#define AGV_ACTION_END_ENGAGEMENT 0x0800u /**< left ACTIVE for STANDBY: a gateway sends throttle 0 (TOP-2) */

/** What a step wants done. */
typedef struct {
    uint32_t what;        /**< AGV_ACTION_* */
    uint16_t missing;     /**< AGV_MISSING_* */
    uint8_t from;         /**< agv_state_t before the step */
    uint8_t first_reason; /**< agv_fault_t before the step */
} agv_actions_t;

/** The machine. */
typedef struct {
    uint8_t state;        /**< agv_state_t */
    uint8_t latched;      /**< AGV_LATCH_CLOSED in TRIPPED and SAFE, else AGV_LATCH_OPEN */
    uint8_t first_reason; /**< agv_fault_t */
    uint8_t unresettable; /**< agv_fault_t: what only a power-on ends */
    bool park_released;   /**< 168h may be sent */
    bool output_closed;
    bool startup_reported;
} agv_state_machine_t;

/** Start, from zeroed memory, in INIT (@p reason AGV_FAULT_NONE) or in TRIPPED; the output is open. */
void agv_state_machine_start(agv_state_machine_t *machine, agv_timers_t *timers, const agv_config_t *config,
                             uint32_t reason);

/** An unresettable fault was found before the start. Ignored for AGV_FAULT_NONE. */
void agv_state_machine_forbid_reset(agv_state_machine_t *machine, uint32_t fault);

/** One step, after each frame and each tick. At most one transition. */
agv_actions_t agv_state_machine_step(agv_state_machine_t *machine, agv_timers_t *timers, const agv_config_t *config,
                                     const agv_fault_summary_t *faults, uint32_t facts);

/** The conditions of a reset that do not hold (FSM-3): AGV_MISSING_* bits. */
uint32_t agv_state_machine_lacks_for_reset(const agv_state_machine_t *machine, const agv_fault_summary_t *faults,
                                           uint32_t facts);

/** Whether INIT lasts for too long: STARTUP_TIMEOUT has a cause. */
bool agv_state_machine_is_startup_late(const agv_state_machine_t *machine, const agv_timers_t *timers);

/** Whether state and latch fit together (INT-5). */
bool agv_state_machine_is_sound(const agv_state_machine_t *machine);

#endif

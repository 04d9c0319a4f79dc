/**
 * @file monitor.h
 * Judges what arrives and what does not: keeps the vehicle's reported state and the ages up to date, and says which
 * faults have a cause (SUP-1 to SUP-6, SUP-8, P1). One handler a message in monitor_frames.c; the rules that depend on
 * time in monitor_timed.c. Time is core->now_ms; ages count from the receive time of a frame.
 */
#ifndef AGV_MONITOR_H
#define AGV_MONITOR_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/faults.h"
#include "agv/liveness.h"
#include "agv/protocol.h"
#include "agv/timer.h"
#include "hal/can.h"

struct agv_core;

/** Mode that 363h byte 7 reports. While both bits are set the mode before stands, until MODE_INVALID; then it is none. */
typedef enum { AGV_MODE_NONE, AGV_MODE_MANUAL, AGV_MODE_ENGAGED } agv_mode_t;

/** The vehicle as it last reported itself. */
typedef struct {
    agv_timer_t both_modes; /**< runs while both mode bits are set */
    agv_timer_t slow;       /**< runs while both wheels are below the standstill speed and 101h is fresh */
    int16_t angle_ddeg;     /**< last valid measured steering angle */
    int16_t command_ddeg;   /**< last valid steering command since the engagement (gateway: as sent on) */
    uint8_t mode;           /**< agv_mode_t */
    uint8_t gear;           /**< agv_gear_t of the last 0A3h; 0 when that was invalid */
    bool throttle_on;       /**< last 050h was valid and above 0 */
    bool eps_in_angle_mode; /**< mode of the last 167h */
    bool button_pressed;    /**< remote button 1 */
    bool angle_known;
    bool command_known;
} agv_vehicle_t;

/** What is counted in a row: bad frames, fast gaps. The first eight are the fault bits of 167h. */
enum {
    AGV_ROW_EPS_MODE = 8,
    AGV_ROW_GEAR_STATUS,
    AGV_ROW_THROTTLE_STATUS,
    AGV_ROW_STEERING_ANGLE,
    AGV_ROW_FAST_GAPS, /**< and the three after it: one a command */
    AGV_ROW_COUNT = AGV_ROW_FAST_GAPS + (int)AGV_COMMAND_COUNT
};

/** Everything that is known and wrong. */
typedef struct {
    agv_liveness_t liveness;
    agv_faults_t faults;
    agv_vehicle_t vehicle;
    agv_timer_t engaged;          /**< runs while engaged; limit engaged_grace_ms */
    agv_timer_t ai_awaited;       /**< runs while engaged with an AI never seen */
    agv_timer_t steering_off;     /**< runs while the steering is off its command and does not gain */
    agv_timer_t throttle_in_park; /**< runs while 050h is above 0 in gear P */
    agv_timer_t other_set[2];     /**< since the other ID set's 43Fh, 363h was last heard */
    uint16_t steering_off_ddeg;   /**< difference from which a gain is counted */
    uint8_t in_a_row[AGV_ROW_COUNT];
    bool ai_alarm_armed; /**< VCU alarm bit 3 was clear with the AI alive (SUP-8) */
    bool after_gap;      /**< this frame came more than two cycles after the one before */
} agv_monitor_t;

/** Nothing known; deadlines begin now. */
void agv_monitor_start(struct agv_core *core);

/**
 * A frame of the right shape with a message of the chosen ID set.
 * @return false when it is a command with a value out of range: drop it.
 */
bool agv_monitor_frame(struct agv_core *core, agv_message_t message, const hal_can_frame_t *frame);

/** A frame of the right shape with an identifier that only the other ID set has. */
void agv_monitor_other_id_set(struct agv_core *core, agv_message_t message);

/** The steering command that counts (SUP-5): as received, or as the gateway sent it on. */
void agv_monitor_steering_commanded(struct agv_core *core, int32_t angle_ddeg);

/** Judge all that depends on time. Call at every tick, after the frames stamped up to it. */
void agv_monitor_tick(struct agv_core *core);

/** The autopilot was disengaged: what only counts while engaged ends. */
void agv_monitor_disengage(struct agv_core *core);

/** A reset was accepted: the AI computer counts as never seen (SUP-8). */
void agv_monitor_forget_ai(struct agv_core *core);

/** Whether the autopilot is engaged. */
bool agv_monitor_engaged(const struct agv_core *core);

/** Whether it has been for engaged_grace_ms: the checks of SUP-5 count. */
bool agv_monitor_settled(struct agv_core *core);

/** Whether a fault is a trip at the moment: its configured class, and SUP-8 for the AI's heartbeat. */
bool agv_monitor_is_trip(const struct agv_core *core, agv_fault_t fault);

/** Whether every status message whose silence trips is fresh. */
bool agv_monitor_messages_fresh(const struct agv_core *core);

/** Whether the vehicle stands still: both wheels slow for standstill_ms, on fresh 101h. */
bool agv_monitor_standstill(struct agv_core *core);

/** Whether fresh 0A3h reports P. */
bool agv_monitor_in_park(const struct agv_core *core);

/** Whether a VCU that is alive reports the autopilot as not engaged, in an unambiguous way. */
bool agv_monitor_autopilot_off(const struct agv_core *core);

/** Whether the steering may be held: EPS alive and without a fault, in angle control, manual not reported (FSM-10). */
bool agv_monitor_steering_holdable(const struct agv_core *core);

#endif

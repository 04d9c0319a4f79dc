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

#include "agv/codec.h"
#include "agv/faults.h"
#include "agv/liveness.h"
#include "agv/protocol.h"
#include "hal/can.h"

struct agv_core;

/**
 * Mode that 363h byte 7 reports, as its two bits, one place further down. While both are set the mode before stands, until MODE_INVALID; then it
 * is none.
 */
typedef enum {
    AGV_MODE_NONE = 0,
    AGV_MODE_MANUAL = AGV_VCU_FLAG_MANUAL >> 1,
    AGV_MODE_ENGAGED = AGV_VCU_FLAG_AUTOPILOT >> 1
} agv_mode_t;

/** Remote button 1. */
typedef enum { AGV_BUTTON_UNKNOWN, AGV_BUTTON_DOWN, AGV_BUTTON_UP } agv_button_t;

/** The vehicle as it last reported itself. */
typedef struct {
    uint8_t mode;           /**< agv_mode_t */
    uint8_t gear;           /**< agv_gear_t of the last 0A3h; 0 when that was invalid */
    uint8_t throttle;       /**< counts of the last 050h; 0 when that was invalid */
    bool eps_in_angle_mode; /**< mode of the last 167h */
    uint8_t button;         /**< remote button 1: agv_button_t */
    bool angle_known;
    bool command_known;
    uint16_t angle_raw;   /**< last valid measured steering angle, 0.1 degree above the leftmost one (P5) */
    uint16_t command_raw; /**< last valid steering command since the engagement (gateway: as sent on), the same */
} agv_vehicle_t;

/** What is counted in a row: bad frames, fast gaps. */
enum {
    AGV_ROW_EPS_FAULTS = 0,      /**< eight: the fault bits of 167h */
    AGV_ROW_EPS_SUPPLY_LAST = 2, /**< the first three of them are those of the supply */
    AGV_ROW_VCU_ALARMS = 8,      /**< eight: the alarm bits of 363h */
    AGV_ROW_EPS_MODE = 16,
    AGV_ROW_GEAR_STATUS,
    AGV_ROW_THROTTLE_STATUS,
    AGV_ROW_STEERING_ANGLE,
    AGV_ROW_FAST_GAPS, /**< and the three after it: one a command */
    AGV_ROW_COUNT = AGV_ROW_FAST_GAPS + (int)AGV_COMMAND_COUNT
};

/** Everything that is known and wrong. */
typedef struct {
    uint8_t in_a_row[AGV_ROW_COUNT];
    uint16_t steering_off_ddeg; /**< difference from which a gain is counted */
    bool ai_alarm_armed;        /**< VCU alarm bit 3 was clear with the AI alive (SUP-8) */
    bool after_gap;             /**< this frame came more than two cycles after the one before */
} agv_monitor_t;

/** Nothing known, from zeroed memory; deadlines begin now. */
void agv_monitor_start(struct agv_core *core);

/**
 * A frame of the right shape with a message of the chosen ID set.
 * @return false when it is a command with a value out of range: drop it.
 */
bool agv_monitor_frame(struct agv_core *core, uint32_t message, const hal_can_frame_t *frame);

/** A frame of the right shape with an identifier that only the other ID set has. */
void agv_monitor_other_id_set(struct agv_core *core, uint32_t message);

/** The steering command that counts (SUP-5): as received, or as the gateway sent it on. */
void agv_monitor_steering_commanded(struct agv_core *core, uint32_t angle_raw);

/** Judge all that depends on time. Call at every tick, after the frames stamped up to it. */
void agv_monitor_tick(struct agv_core *core);

/** The autopilot was disengaged: what only counts while engaged ends. */
void agv_monitor_disengage(struct agv_core *core);

/** A reset was accepted: the AI computer counts as never seen (SUP-8). */
void agv_monitor_forget_ai(struct agv_core *core);

/** Whether it has been for engaged_grace_ms: the checks of SUP-5 count. */
bool agv_monitor_settled(struct agv_core *core);

/** Whether a fault is a trip at the moment: its configured class, and SUP-8 for the AI's heartbeat. */
bool agv_monitor_is_trip(const struct agv_core *core, uint32_t fault);

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

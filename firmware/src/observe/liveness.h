/**
 * @file liveness.h
 * The age of every message, and the three heartbeats (SUP-1 to SUP-3). deadlines.h decides which faults follow.
 */
#ifndef AGV_LIVENESS_H
#define AGV_LIVENESS_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/protocol.h"
#include "base/timers.h"
#include "hal/can.h"

/** The nodes with a heartbeat (SUP-1): 363h byte 8, 067h byte 1, 43Fh byte 8. */
typedef enum { AGV_NODE_VCU, AGV_NODE_EPS, AGV_NODE_AI, AGV_NODE_COUNT } agv_node_t;

/** State of a heartbeat. */
typedef enum {
    AGV_HEARTBEAT_UNSEEN = 0,    /**< no changed counter yet */
    AGV_HEARTBEAT_BASELINE = 1,  /**< AI only: the first value was seen and started the deadline; not alive yet */
    AGV_HEARTBEAT_ALIVE = 2,     /**< the counter changed within the deadline */
    AGV_HEARTBEAT_FORGOTTEN = 3, /**< AI only: it was seen before the last reset; its deadline still runs (SUP-8) */
    AGV_HEARTBEAT_LOST = 4,      /**< the deadline expired; remains until the counter changes again */
    AGV_HEARTBEAT_STUCK = 5      /**< as LOST, but frames with an unchanged counter were still received */
} agv_heartbeat_state_t;

/** One heartbeat. Its deadline is that of the message that carries it (AGV_TIMER_MESSAGE). */
typedef struct {
    uint8_t state;   /**< agv_heartbeat_state_t */
    uint8_t counter; /**< value last seen */
    bool counter_known;
    bool repeated;        /**< the last frame did not count as changed */
    uint8_t steps_needed; /**< correct steps needed until one counts as changed again (`increments`, SUP-2) */
} agv_heartbeat_t;

/** Age of a message that is older than AGV_AGE_LIMIT_MS or was never received: ages saturate (TIM-2). */
#define AGV_AGE_MAX UINT32_MAX
#define AGV_AGE_LIMIT_MS 6000u

/** Ages of all messages, and the heartbeats. */
typedef struct {
    uint32_t last_ms[AGV_MSG_COUNT]; /**< time of the last well-formed frame; before the first one, of the start */
    uint16_t heard;                  /**< bit n: message n was received at least once */
    uint16_t old;                    /**< bit n: its last_ms is older than AGV_AGE_LIMIT_MS */
    uint8_t next_to_age;             /**< message whose age the next tick checks */
    agv_heartbeat_t heartbeats[AGV_NODE_COUNT];
} agv_liveness_t;

/** Start, from zeroed memory: nothing received. All deadlines begin now, except that of the AI's heartbeat (SUP-8). */
void agv_liveness_start(agv_liveness_t *liveness, agv_timers_t *timers);

/**
 * Note a well-formed frame.
 * @return milliseconds since the previous one; AGV_AGE_MAX if there was none, or it is too long ago.
 */
uint32_t agv_liveness_arrived(agv_liveness_t *liveness, uint32_t message, uint32_t time_ms);

/** Restart the deadline of a valid frame. The deadline of a heartbeat only restarts if its alive counter has changed. */
void agv_liveness_refresh(agv_liveness_t *liveness, agv_timers_t *timers, const agv_config_t *config, uint32_t message,
                          const hal_can_frame_t *frame);

/** Restart the deadlines of the commands, except the AI's heartbeat, when the autopilot is engaged (SUP-3). */
void agv_liveness_restart_commands(agv_timers_t *timers, uint32_t time_ms);

/** Forget the AI computer after a reset: it is alive again when its counter changes (SUP-8). */
void agv_liveness_forget_ai(agv_liveness_t *liveness);

/**
 * Saturate ages and expire heartbeats. Call at every tick, after the timers, and when an engagement begins.
 * @param engaged if true, the heartbeat of a forgotten AI computer (AGV_HEARTBEAT_FORGOTTEN) expires too
 */
void agv_liveness_tick(agv_liveness_t *liveness, const agv_timers_t *timers, bool engaged);

/** The state of a heartbeat. */
agv_heartbeat_state_t agv_liveness_heartbeat(const agv_liveness_t *liveness, agv_node_t node);

/** Whether a heartbeat is alive. */
bool agv_liveness_alive(const agv_liveness_t *liveness, agv_node_t node);

/** Whether a message was received and its deadline has not expired. */
bool agv_liveness_fresh(const agv_liveness_t *liveness, const agv_timers_t *timers, uint32_t message);

/** Age of the last well-formed frame, ms; without one, the time since the start. Saturates to AGV_AGE_MAX. */
uint32_t agv_liveness_age_ms(const agv_liveness_t *liveness, const agv_timers_t *timers, uint32_t message);

#endif

/**
 * @file liveness.h
 * Who is alive, and how old is what is known (SUP-1 to SUP-3): the age of every message and the three heartbeats. Which
 * fault follows is not decided here (deadlines.h).
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
    AGV_HEARTBEAT_BASELINE = 1,  /**< AI: one value seen, which proves nothing yet, but begins the deadline */
    AGV_HEARTBEAT_ALIVE = 2,     /**< the counter changed within the deadline */
    AGV_HEARTBEAT_FORGOTTEN = 3, /**< AI: it was seen before the last reset; its deadline runs on (SUP-8) */
    AGV_HEARTBEAT_LOST = 4,      /**< deadline expired; stays until the counter changes again */
    AGV_HEARTBEAT_STUCK = 5      /**< as LOST, but frames with the old counter went on coming */
} agv_heartbeat_state_t;

/** One heartbeat. Its deadline is the one of the message that carries it (AGV_TIMER_MESSAGE). */
typedef struct {
    uint8_t state;   /**< agv_heartbeat_state_t */
    uint8_t counter; /**< value last seen */
    bool counter_known;
    bool repeated;        /**< the last frame did not count as changed */
    uint8_t steps_needed; /**< right steps until one counts again (`increments`, SUP-2) */
} agv_heartbeat_t;

/** Age returned for what is older than AGV_AGE_LIMIT_MS or was never heard: ages saturate (TIM-2). */
#define AGV_AGE_MAX UINT32_MAX
#define AGV_AGE_LIMIT_MS 6000u

/** Ages of all messages, and the heartbeats. */
typedef struct {
    uint32_t last_ms[AGV_MSG_COUNT]; /**< last frame of the right shape; before: the start */
    uint16_t heard;                  /**< bit n: message n was received at least once */
    uint16_t old;                    /**< bit n: its last_ms is older than AGV_AGE_LIMIT_MS */
    uint8_t next_to_age;             /**< message whose age is looked at by the next tick */
    agv_heartbeat_t heartbeats[AGV_NODE_COUNT];
} agv_liveness_t;

/** Nothing heard, from zeroed memory; all deadlines begin now, but the one of the AI's heartbeat (SUP-8). */
void agv_liveness_start(agv_liveness_t *liveness, agv_timers_t *timers);

/**
 * A frame of the right shape arrived.
 * @return milliseconds since the one before, AGV_AGE_MAX when that is too long ago or there was none.
 */
uint32_t agv_liveness_arrived(agv_liveness_t *liveness, uint32_t message, uint32_t time_ms);

/** A usable frame arrived: its deadline begins anew. One with an alive counter is usable when that has changed. */
void agv_liveness_refresh(agv_liveness_t *liveness, agv_timers_t *timers, const agv_config_t *config, uint32_t message,
                          const hal_can_frame_t *frame);

/** The autopilot was engaged at that time: the deadlines of the commands begin anew, but the AI's heartbeat (SUP-3). */
void agv_liveness_restart_commands(agv_timers_t *timers, uint32_t time_ms);

/** A reset was accepted: the AI computer is not alive before its counter changes (SUP-8). */
void agv_liveness_forget_ai(agv_liveness_t *liveness);

/**
 * Let ages saturate and heartbeats expire. Call at every tick, after the timers, and when an engagement begins.
 * @param engaged an AI computer that a reset made forget is expected again
 */
void agv_liveness_tick(agv_liveness_t *liveness, const agv_timers_t *timers, bool engaged);

/** What is known of a heartbeat. */
agv_heartbeat_state_t agv_liveness_heartbeat(const agv_liveness_t *liveness, agv_node_t node);

/** Whether a heartbeat is alive. */
bool agv_liveness_alive(const agv_liveness_t *liveness, agv_node_t node);

/** Whether a message was heard, and its deadline has not expired. */
bool agv_liveness_fresh(const agv_liveness_t *liveness, const agv_timers_t *timers, uint32_t message);

/** Age of the last frame of the right shape; since the start when none was heard. Saturates to AGV_AGE_MAX. */
uint32_t agv_liveness_age_ms(const agv_liveness_t *liveness, const agv_timers_t *timers, uint32_t message);

#endif

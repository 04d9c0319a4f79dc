/**
 * @file liveness.h
 * Who is alive, and how old is what we know (SUP-1 to SUP-3): the age of every message and the three heartbeats.
 */
#ifndef AGV_LIVENESS_H
#define AGV_LIVENESS_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/protocol.h"
#include "hal/can.h"

struct agv_core;

/** The nodes with a heartbeat (SUP-1): 363h byte 8, 067h byte 1, 43Fh byte 8. */
typedef enum { AGV_NODE_VCU, AGV_NODE_EPS, AGV_NODE_AI, AGV_NODE_COUNT } agv_node_t;

/** What is known of a heartbeat. ALIVE is asked for most, and so a bit that no other has. */
typedef enum {
    AGV_HEARTBEAT_UNSEEN = 0,   /**< no changed counter yet */
    AGV_HEARTBEAT_BASELINE = 1, /**< AI: one value seen, which proves nothing yet, but begins the deadline */
    AGV_HEARTBEAT_ALIVE = 2,    /**< the counter changed within the deadline */
    AGV_HEARTBEAT_LOST = 4,     /**< deadline expired; stays until the counter changes again */
    AGV_HEARTBEAT_STUCK = 5     /**< as LOST, but frames with the old counter went on coming */
} agv_heartbeat_state_t;

/** One heartbeat. Its deadline is the one of the message that carries it (AGV_WATCH_MESSAGE). */
typedef struct {
    uint8_t state;   /**< agv_heartbeat_state_t */
    uint8_t counter; /**< value last seen */
    bool counter_known;
    bool repeated; /**< the last frame had the value of the one before */
} agv_heartbeat_t;

/** Age returned for what is older than AGV_AGE_LIMIT_MS or was never heard: ages saturate (TIM-2). */
#define AGV_AGE_MAX UINT32_MAX
#define AGV_AGE_LIMIT_MS 6000u

/** What is known of the age of a message: bits. */
#define AGV_SEEN_HEARD 0x01u /**< received at least once */
#define AGV_SEEN_OLD 0x02u   /**< last_ms is older than AGV_AGE_LIMIT_MS */

/** All messages and heartbeats of one supervisor. */
typedef struct {
    uint32_t last_ms[AGV_MSG_COUNT]; /**< last frame of the right shape; before: the start */
    uint8_t seen[AGV_MSG_COUNT];     /**< AGV_SEEN_* */
    agv_heartbeat_t heartbeats[AGV_NODE_COUNT];
} agv_liveness_t;

/** Nothing heard, from zeroed memory; all deadlines begin now, but the one of the AI's heartbeat (SUP-8). */
void agv_liveness_start(struct agv_core *core);

/**
 * A frame of the right shape arrived.
 * @return milliseconds since the one before, AGV_AGE_MAX when that is too long ago or there was none.
 */
uint32_t agv_liveness_arrived(struct agv_core *core, uint32_t message, uint32_t time_ms);

/** A usable frame arrived: its deadline begins anew. One with an alive counter is usable when that has changed. */
void agv_liveness_refresh(struct agv_core *core, uint32_t message, const hal_can_frame_t *frame);

/** Judge the age of a message, at every tick. @return whether its deadline has expired, now or earlier. */
bool agv_liveness_judge(struct agv_core *core, uint32_t message);

/**
 * Judge a heartbeat, after the ages. The AI's is not awaited before it was seen (SUP-8).
 * @return what is known of it now
 */
agv_heartbeat_state_t agv_liveness_judge_beat(struct agv_core *core, uint32_t node);

/** Heard, and within its deadline. */
bool agv_liveness_fresh(const struct agv_core *core, uint32_t message);

/** Age of the last frame of the right shape; since the start when none was heard. Saturates to AGV_AGE_MAX. */
uint32_t agv_liveness_age_ms(const struct agv_core *core, uint32_t message);

#endif

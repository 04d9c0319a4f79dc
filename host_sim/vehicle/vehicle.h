/**
 * @file vehicle.h
 * A simulated vehicle: VCU, EPS and AI computer, which send their messages on their cycles (P16), and the motion of the
 * vehicle. The vehicle obeys the commands on the bus. Every node can misbehave on demand.
 *
 * The vehicle has no bus of its own: time and received frames are passed in, and what a node sends goes to a callback. So
 * the same vehicle runs on the simulated bus and on a real one. All random values follow from a seed: the same calls give
 * the same frames.
 *
 * How the nodes behave (the figures are members of vehicle_config_t):
 * - *VCU, commands*. In autopilot the VCU obeys 168h, 075h and 43Fh. In manual it obeys the remote control, and of the
 *   frames on the bus only gear P and autopilot off. Autopilot off ends autopilot mode at once: the gear stays, the
 *   throttle goes to 0. The VCU engages the autopilot when the operator asks for it, unless autopilot off was commanded
 *   in the last 300 ms. While gear P is commanded (the last 168h within 300 ms), and then until the operator drives anew,
 *   the remote control has no effect. When no 075h was received for 500 ms, the throttle is 0.
 * - *VCU, gear and throttle*. A gear takes time to engage. With the guard, the VCU brakes to walking pace before it engages
 *   P. Without the guard, it engages P at any speed, and the wheels lock. D and R against the motion engage only when the
 *   vehicle stands: the VCU brakes until then, with throttle 0. The throttle (050h) follows its command at a limited rate.
 *   363h carries the speed of the wheels in metres per hour.
 * - *VCU, alarms*. AI CAN signal lost: the counter of 43Fh is unchanged for ai_lost_ms; the throttle goes to 0. EPS CAN bus
 *   fault: the counter of 067h is unchanged for eps_lost_ms. EPS hardware fault: a bit in 167h byte 8. Remote signal or
 *   power lost: the VCU brakes in manual.
 * - *VCU, start*. Manual, all counters at 0, gear P when the vehicle stands, otherwise N.
 * - *EPS*. Angle control while 363h reports autopilot, otherwise steering assist; a change takes eps_mode_change_ms. In
 *   angle control it follows 065h, in steering assist the driver's hand, both at a limited rate.
 * - *AI computer*. It drives as told while 363h reports autopilot; otherwise it sends gear N, throttle 0, angle 0.
 *   To change between D and R, or out of N, it waits with throttle 0 until the wheels stand.
 *   A stubborn AI computer sends its commands at once and in every mode.
 *
 * Single-threaded, no allocation, no globals. All times are milliseconds since the start of the run.
 */
#ifndef VEHICLE_H
#define VEHICLE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/codec.h"
#include "agv/protocol.h"
#include "hal/can.h"

/** A node of the vehicle; VEHICLE_ROGUE is any other sender. */
typedef enum { VEHICLE_VCU, VEHICLE_EPS, VEHICLE_AI, VEHICLE_NODES, VEHICLE_ROGUE = VEHICLE_NODES } vehicle_node_t;

/** As a start time: the node stays off. */
#define VEHICLE_NEVER UINT32_MAX
/** As a number of frames: until it is cleared. */
#define VEHICLE_FOREVER UINT16_MAX
/** The longest VEHICLE_DO_DELAY. */
#define VEHICLE_DELAY_MAX_MS 1000u
/** The highest speed of VEHICLE_DO_VCU_ROLL, either way. */
#define VEHICLE_ROLL_MAX_MM_S 20000
/** Periodic senders of raw frames at one time. */
#define VEHICLE_ROGUES_MAX 8u

/** Called for every frame when it is sent. Must not call the vehicle. */
typedef void vehicle_send_fn(void *ctx, vehicle_node_t from, hal_can_side_t side, const hal_can_frame_t *frame);

/** How a vehicle is built. Start from vehicle_defaults(). */
typedef struct {
    agv_ids_t ids;                    /**< of all messages */
    bool gateway;                     /**< the AI computer is on the AI side, the others on the vehicle side */
    bool park_guard;                  /**< the VCU takes P only below walking pace (default) */
    bool obeys_short_frames;          /**< the VCU takes a 168h, 075h or 43Fh of any length and in FD format */
    uint32_t start_ms[VEHICLE_NODES]; /**< when each node starts; VEHICLE_NEVER */
    uint32_t seed;                    /**< of the garbage */
    uint16_t gear_change_ms;          /**< 120 */
    uint16_t walking_pace_mm_s;       /**< 800 */
    uint16_t top_speed_mm_s;          /**< 4000, at throttle 100 % */
    uint16_t acceleration_mm_s2;      /**< 1000 */
    uint16_t coasting_mm_s2;          /**< 400: slowing down with throttle below the speed */
    uint16_t braking_mm_s2;           /**< 3000: the VCU brakes */
    uint16_t locked_mm_s2;            /**< 5000: gear P */
    uint16_t steering_rate_ddeg_s;    /**< 3000 */
    uint16_t eps_mode_change_ms;      /**< 200 */
    uint16_t throttle_rise_pct_s;     /**< 500: how fast the throttle goes up; 0 = at once */
    uint16_t throttle_fall_pct_s;     /**< 500: and down */
    uint16_t reported_speed_pct;      /**< 100: of the speed of the wheels, in 363h */
    uint16_t phase_ms[AGV_MSG_COUNT]; /**< of the first frame of each message, after the start of its node */
    uint16_t ai_lost_ms;              /**< 1000 */
    uint16_t eps_lost_ms;             /**< 100 */
} vehicle_config_t;

/** The defaults: shared bus, heading IDs, guarded P, all nodes start at 0. */
void vehicle_defaults(vehicle_config_t *config);

/** What a node sends instead of its payloads. */
typedef enum {
    VEHICLE_GARBAGE_OFF,
    VEHICLE_GARBAGE_RANDOM,   /**< random payload, right length */
    VEHICLE_GARBAGE_LENGTH,   /**< right first bytes, random DLC 0..7 */
    VEHICLE_GARBAGE_EXTENDED, /**< 29-bit identifier */
    VEHICLE_GARBAGE_REMOTE    /**< remote request */
} vehicle_garbage_t;

/** Actions. */
typedef enum {
    /* a node: `node` */
    VEHICLE_DO_START,   /**< if it is off */
    VEHICLE_DO_STOP,    /**< it loses power: neither sends nor receives */
    VEHICLE_DO_RESTART, /**< off for `ms`, then as freshly started */
    VEHICLE_DO_FREEZE,  /**< its alive counter stands still */
    VEHICLE_DO_UNFREEZE,
    VEHICLE_DO_LAG,     /**< every cycle of it takes `ms` longer; 0 = no more */
    VEHICLE_DO_REPEAT,  /**< every frame of it is sent `count` times more; 0 = no more */
    VEHICLE_DO_GARBAGE, /**< `garbage` */
    VEHICLE_DO_RECOVER, /**< ends every misbehaviour of this node and of its messages */
    /* a message: `message` */
    VEHICLE_DO_MUTE, /**< it is not sent; for `count` frames (VEHICLE_FOREVER), again after every `every` frames */
    VEHICLE_DO_UNMUTE,
    VEHICLE_DO_PERIOD, /**< its cycle is `ms`; 0 = as it should be */
    VEHICLE_DO_PATCH, /**< bits that are 0 in `keep` are as in `value` in the next `count` frames (VEHICLE_FOREVER), and
                             again in the first `count` of every `every` frames; `every` 0 = once */
    VEHICLE_DO_HOLD,  /**< the same, the value being that of the next frame */
    VEHICLE_DO_DELAY, /**< what it carries is `ms` old (at most VEHICLE_DELAY_MAX_MS), but for its counter; 0 = no more */
    VEHICLE_DO_IGNORE,  /**< `on`: a command that its receiver does not obey */
    VEHICLE_DO_UNPATCH, /**< no bit is patched any more */
    /* the VCU */
    VEHICLE_DO_VCU_RAMP,        /**< `count`: percent a second at which the throttle comes down */
    VEHICLE_DO_VCU_ROLL,        /**< `on`: nothing holds the wheels, in no gear; they turn at `speed_mm_s` */
    VEHICLE_DO_VCU_ROLL_ON,     /**< the same, at the speed that they have */
    VEHICLE_DO_VCU_REFUSE_PARK, /**< `on`: gear P of the bus is ignored from walking pace on */
    VEHICLE_DO_VCU_SLOPPY,      /**< `on`: as obeys_short_frames */
    /* the AI computer */
    VEHICLE_DO_AI_DRIVE,         /**< `gear`, `throttle_permille`, `angle_ddeg` while engaged */
    VEHICLE_DO_AI_IDLE,          /**< gear N, throttle 0, angle 0 */
    VEHICLE_DO_AI_STUBBORN,      /**< `on`: sends its commands in every mode */
    VEHICLE_DO_AI_AUTOPILOT_OFF, /**< `on`: asks for autopilot off in 43Fh */
    VEHICLE_DO_AI_WEAVE,         /**< its angle swings by `angle_ddeg` to both sides, once in `ms`; 0 = no more */
    /* the EPS */
    VEHICLE_DO_EPS_STUCK, /**< `on`: the steering does not move */
    VEHICLE_DO_EPS_HUNT, /**< in angle control the angle swings by `angle_ddeg` to both sides, once in `ms`; 0 = no more */
    /* the operator */
    VEHICLE_DO_ENGAGE,
    VEHICLE_DO_DISENGAGE,
    VEHICLE_DO_BUTTON,        /**< `count` = 1 or 2, `on` = pressed */
    VEHICLE_DO_REMOTE_DRIVE,  /**< `gear`, `throttle_permille`: in manual */
    VEHICLE_DO_HAND_STEER,    /**< `angle_ddeg`: in steering assist */
    VEHICLE_DO_REMOTE_SIGNAL, /**< `on`: the VCU receives the remote controller's signal */
    VEHICLE_DO_REMOTE_POWER,  /**< `on`: the receiver has power */
    /* a rogue node: raw frames */
    VEHICLE_DO_SEND, /**< `frame` on `side`, `count` times (0 = 1, VEHICLE_FOREVER) every `ms`, the first at once */
    VEHICLE_DO_STOP_SENDING, /**< whatever rogue nodes send */
    VEHICLE_DO_COUNT
} vehicle_do_t;

/** One action; members that its kind does not name are ignored. */
typedef struct {
    vehicle_do_t what;
    vehicle_node_t node;
    agv_message_t message;
    vehicle_garbage_t garbage;
    hal_can_side_t side;
    uint32_t ms;
    uint16_t count;
    uint16_t every;
    bool on;
    uint8_t gear; /**< agv_gear_t */
    int32_t speed_mm_s;
    uint16_t throttle_permille;
    int32_t angle_ddeg;
    uint8_t keep[AGV_DLC];
    uint8_t value[AGV_DLC];
    hal_can_frame_t frame;
} vehicle_action_t;

/** What the vehicle is doing. */
typedef struct {
    uint8_t gear;   /**< agv_gear_t, engaged */
    bool autopilot; /**< mode of the VCU */
    int32_t speed_mm_s;
    uint16_t throttle_permille;
    uint8_t eps_mode; /**< agv_eps_mode_t */
    int32_t angle_ddeg;
    uint8_t alarms; /**< of the VCU, AGV_VCU_ALARM_* */
    bool running[VEHICLE_NODES];
    int32_t fastest_park_mm_s; /**< highest speed, without its sign, at which P was engaged so far */
} vehicle_view_t;

/** What the vehicle did when it last moved. Looking at it changes nothing, also not how a run goes on. */
typedef struct {
    uint8_t gear;   /**< agv_gear_t, engaged */
    bool autopilot; /**< mode of the VCU */
    bool button_1;  /**< the operator presses it */
    int32_t speed_mm_s;
    int32_t angle_ddeg; /**< of the wheels; vehicle_view_t has it as the EPS measures it */
} vehicle_state_t;

/** @name Private: layout only, so that a program can own a vehicle. @{ */
#define VEHICLE_PAST_MAX ((VEHICLE_DELAY_MAX_MS / 10u) + 1u) /* frames of the shortest cycle */

/* A number of frames, and again after a gap of so many. */
typedef struct {
    uint16_t left;
    uint16_t frames;
    uint16_t gap;
    uint16_t gap_left;
} vehicle_stretch_t;

/* What a message carried before. */
typedef struct {
    uint16_t next;
    uint16_t count;
    uint8_t data[VEHICLE_PAST_MAX][AGV_DLC];
} vehicle_past_t;

typedef struct {
    uint32_t period_ms;
    uint32_t delay_ms;
    vehicle_stretch_t muted;
    bool ignored;
    bool patched;
    uint8_t value[AGV_DLC];
    uint8_t held[AGV_DLC];                  /* bits whose value is that of the next frame */
    vehicle_stretch_t patches[AGV_DLC * 8]; /* a bit of the payload each */
    vehicle_past_t past;
} vehicle_message_t;

typedef struct {
    uint64_t start_ms;
    uint32_t lag_ms;
    uint16_t repeat;
    bool running;
    bool frozen;
    uint8_t garbage;
    uint8_t counter;
} vehicle_node_state_t;

typedef struct {
    uint64_t at_ms;
    uint64_t changed_ms; /* when the target of a change under way was set */
    int32_t speed_um_s;
    int32_t fastest_park_mm_s;
    int32_t throttle_mpermille; /* 1/1000 permille */
    uint8_t gear;
    uint8_t target;
} vehicle_dynamics_t;

/* How VCU and brakes misbehave; outlives every restart of the VCU. */
typedef struct {
    int32_t roll_um_s;
    uint16_t throttle_fall_pct_s;
    bool ramps;
    bool rolls;
    bool refuses_park;
    bool is_sloppy;
} vehicle_vcu_faults_t;

typedef struct {
    uint64_t park_until_ms;
    uint64_t off_until_ms;
    uint64_t throttle_until_ms;
    uint64_t ai_until_ms;
    uint64_t eps_until_ms;
    uint16_t throttle_permille;
    uint8_t gear;
    uint8_t ai_counter;
    uint8_t eps_counter;
    bool ai_heard;
    bool eps_heard;
    bool eps_fault;
    bool autopilot;
    bool turn_left_on;
    bool turn_right_on;
} vehicle_vcu_t;

typedef struct {
    uint64_t at_ms;
    uint64_t changed_ms;
    int32_t angle_mddeg;
    int32_t command_ddeg;
    uint8_t mode;
    uint8_t wanted;
    bool commanded;
} vehicle_eps_t;

typedef struct {
    bool engaged;
    bool moving;
    bool waits;   /* for the wheels to stand, before it commands the wanted gear */
    bool shifts;  /* and then for 0A3h to report it, before it commands a throttle */
    uint8_t gear; /* that 0A3h reports; 0: not received yet */
} vehicle_ai_t;

/* A value that swings to both sides. */
typedef struct {
    uint64_t from_ms;
    uint32_t period_ms;
    int32_t amplitude_ddeg;
} vehicle_swing_t;

/* Actions that last: operator, AI computer's orders, EPS. They outlive every restart of a node. */
typedef struct {
    int32_t hand_ddeg;
    int32_t ai_angle_ddeg;
    uint16_t remote_throttle_permille;
    uint16_t ai_throttle_permille;
    uint8_t remote_gear;
    uint8_t ai_gear;
    bool hand_steers;
    bool button_1;
    bool button_2;
    bool remote_signal_lost;
    bool remote_power_lost;
    bool ai_stubborn;
    bool ai_autopilot_off;
    bool eps_stuck;
    vehicle_swing_t ai_weave;
    vehicle_swing_t eps_hunt;
} vehicle_operator_t;

typedef struct {
    uint64_t due_ms;
    uint32_t period_ms;
    uint16_t left;
    hal_can_side_t side;
    hal_can_frame_t frame;
} vehicle_rogue_t;

typedef struct {
    uint64_t due_ms;                    /* the earliest of all that follows */
    uint64_t seldom_ms;                 /* a node starts or a rogue node sends */
    uint64_t message_ms[AGV_MSG_COUNT]; /* each message; UINT64_MAX while its node is off */
    uint32_t power_changes;             /* nodes switched on or off so far */
    vehicle_send_fn *send;
    void *send_ctx;
    uint16_t id[AGV_MSG_COUNT];
    uint32_t random;
    vehicle_message_t messages[AGV_MSG_COUNT];
    vehicle_node_state_t nodes[VEHICLE_NODES];
    vehicle_dynamics_t dynamics;
    vehicle_vcu_t vcu;
    vehicle_vcu_faults_t vcu_faults;
    vehicle_eps_t eps;
    vehicle_ai_t ai;
    vehicle_operator_t operator;
    vehicle_rogue_t rogues[VEHICLE_ROGUES_MAX];
    vehicle_config_t config;
} vehicle_t;

void vehicle_run(vehicle_t *vehicle, uint64_t now_ms);
/** @} */

/**
 * Build a vehicle that stands in manual, gear P, at time 0.
 * @param config is copied
 * @param send   gets every frame sent; not NULL
 */
void vehicle_init(vehicle_t *vehicle, const vehicle_config_t *config, vehicle_send_fn *send, void *ctx);

/** Advance the time to @p now_ms: send what is due. Call it every millisecond; never with an earlier time. */
static inline void vehicle_tick(vehicle_t *vehicle, uint64_t now_ms) {
    if (now_ms >= vehicle->due_ms) {
        vehicle_run(vehicle, now_ms);
    }
}

/** A node receives a frame. Do not call it for the node's own frames. A node that is off receives nothing. */
void vehicle_receive(vehicle_t *vehicle, vehicle_node_t node, uint64_t now_ms, const hal_can_frame_t *frame);

/**
 * Do something now; frames of it are sent by the next vehicle_tick(), the one of this millisecond included.
 * @return false: unknown node, message or value, or no room for another rogue node.
 */
bool vehicle_do(vehicle_t *vehicle, uint64_t now_ms, const vehicle_action_t *action);

/** Look at the vehicle. @p now_ms not before the last call. */
void vehicle_view(vehicle_t *vehicle, uint64_t now_ms, vehicle_view_t *view);

/** Look at the vehicle as it was when it last moved. */
void vehicle_state(const vehicle_t *vehicle, vehicle_state_t *state);

/** Whether a node has power. */
bool vehicle_is_running(const vehicle_t *vehicle, vehicle_node_t node);

/** How often a node was switched on or off so far. */
static inline uint32_t vehicle_power_changes(const vehicle_t *vehicle) {
    return vehicle->power_changes;
}

/** From now on pass what is sent to another callback. For a vehicle that was copied. */
void vehicle_set_send(vehicle_t *vehicle, vehicle_send_fn *send, void *ctx);

/** The controller side that a node is on; a rogue node is on the vehicle side. */
hal_can_side_t vehicle_side_of(const vehicle_t *vehicle, vehicle_node_t node);

/** "vcu", "eps", "ai"; "stranger" for others. */
const char *vehicle_node_name(vehicle_node_t node);

/** The node that sends a message. */
vehicle_node_t vehicle_sender_of(agv_message_t message);

/** The node that obeys a command; VEHICLE_NODES: not a command. */
vehicle_node_t vehicle_receiver_of(agv_message_t message);

#endif

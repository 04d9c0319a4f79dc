/**
 * @file scenario.h
 * A scenario: how a run begins, what happens in it, and what is expected of the supervisor. docs/scenarios.md is the
 * manual of the file format.
 *
 * This is what was read; it knows no bus and no time. scenario_check.h evaluates a run by it, scenario_testbed.h runs
 * it on the simulated bus.
 */
#ifndef HOST_SIM_SCENARIO_H
#define HOST_SIM_SCENARIO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/state.h"
#include "config/config_file.h"
#include "hal/can.h"
#include "hal/reset.h"
#include "hal_sim/sim_board.h"
#include "scenario/scenario_anchor.h"
#include "vehicle/vehicle.h"

#define SCENARIO_TEXT_MAX 96u
#define SCENARIO_SHOWS_MAX 24u
#define SCENARIO_STEPS_MAX 256u
#define SCENARIO_AGAIN_MAX 32u  /* steps with again_every_ms */
#define SCENARIO_EXPECT_MAX 64u /* of each kind */
#define SCENARIO_BOUNCE_MAX 16u /* times of a bouncing button */
#define SCENARIO_NAME_MAX 32u   /* of a step */
#define SCENARIO_DURATION_MAX_MS 86400000u
#define SCENARIO_DEFAULT_BITRATE 500000u

/** From `from` up to and with `to`; these count from the anchor. */
typedef struct {
    uint32_t from;
    uint32_t to;
    uint32_t early; /**< it begins so long before the anchor: a tolerance; `from` is 0 then */
    scenario_anchor_t after;
} scenario_window_t;

/** What can be done to the supervisor and its controllers. */
typedef enum {
    SCENARIO_RESTART,        /**< `cause`, after `ms` without power */
    SCENARIO_HANG,           /**< for `ms` it neither receives nor steps */
    SCENARIO_BUS_OFF,        /**< `side` */
    SCENARIO_TX_STALL,       /**< `side`, `on`: its frames do not leave */
    SCENARIO_TX_SWALLOW,     /**< `side`, `on`: its frames are lost, and its controller reports that they were sent */
    SCENARIO_QUEUE_FULL,     /**< `side`, `on`: it takes no frame to send */
    SCENARIO_OVERRUN,        /**< `side` */
    SCENARIO_ERROR_PASSIVE,  /**< `side`, `on` */
    SCENARIO_DELIVER,        /**< `side`, `frame`: handed to the supervisor alone */
    SCENARIO_CORRUPT_LATCH,  /**< a bit of the stored latch flips */
    SCENARIO_FLIP_BIT,       /**< bit `ms` of the supervisor's memory flips */
    SCENARIO_CORRUPT_FRAMES, /**< the next `ms` frames of any node on `side` are destroyed */
    SCENARIO_CONTACT_WORKS,  /**< of the safety output */
    SCENARIO_CONTACT_WELDED,
    SCENARIO_CONTACT_STUCK,
    SCENARIO_FEEDBACK_INVERTED, /**< `on` */
    SCENARIO_STOP_OPEN,         /**< the circuit of the emergency stop; `on` */
    SCENARIO_BUTTON,            /**< `on`: pressed */
    SCENARIO_BUTTON_BOUNCES,    /**< it changes now, and after each of the times of `bounce_ms` */
    SCENARIO_CLOCK,             /**< the first clock runs slow by `permille`; below 0: fast */
    SCENARIO_TEST_FAILS         /**< `parts` */
} scenario_do_t;

typedef struct {
    scenario_do_t what;
    hal_can_side_t side;
    hal_reset_cause_t cause;
    uint32_t ms;
    bool on;
    int16_t permille;
    uint32_t parts; /**< HAL_SELF_TEST_* */
    uint16_t bounce_ms[SCENARIO_BOUNCE_MAX];
    uint8_t bounce_count;
    hal_can_frame_t frame;
} scenario_action_t;

/** A step: what is done to the vehicle or the supervisor, and when. */
typedef struct {
    uint32_t at_ms; /**< counts from the anchor */
    scenario_anchor_t after;
    char name[SCENARIO_NAME_MAX]; /**< "": none */
    uint32_t again_every_ms;      /**< 0: once */
    uint32_t again_until_ms;      /**< after this time it is not done again */
    size_t line;
    const char *actor; /**< "ai" */
    const char *word;  /**< "stop" */
    bool of_vehicle;
    vehicle_action_t vehicle;
    scenario_action_t supervisor;
} scenario_step_t;

/** A change of state; all of them are listed, in their order. */
typedef struct {
    size_t line;
    agv_state_t to;
    agv_fault_t reason; /**< AGV_FAULT_NONE: none is expected */
    scenario_window_t at_ms;
} scenario_state_t;

/** Who sent a frame; the supervisor or a node of the vehicle. */
typedef enum { SCENARIO_FROM_ANY = -2, SCENARIO_FROM_SUPERVISOR = -1, SCENARIO_FROM_NODE = 0 } scenario_from_t;

#define SCENARIO_NO_ID UINT32_MAX

/** Frames that are expected, or that must not be. */
typedef struct {
    size_t line;
    int from; /**< scenario_from_t, or a vehicle_node_t */
    hal_can_side_t side;
    bool any_side;
    uint32_t id;           /**< SCENARIO_NO_ID: any (and `message` is AGV_MSG_NONE) */
    agv_message_t message; /**< stands for its identifier in the ID set in use */
    uint8_t mask[AGV_DLC]; /**< payload matches when (payload & mask) == value */
    uint8_t value[AGV_DLC];
    bool exact_length; /**< the frame must have `length` bytes; else any payload matches */
    uint8_t length;
    scenario_window_t at_ms;
    bool is_first; /**< the first frame with this identifier at or after first_since_ms is the one that must match */
    uint32_t first_since_ms;
    scenario_window_t count;
    uint32_t every_ms; /**< 0: not evaluated */
    uint32_t jitter_ms;
    uint32_t again_ms; /**< a frame that comes sooner than this after the last one is the same one, sent again */
    size_t again_max;  /**< how many may be sent again */
} scenario_frame_t;

typedef struct {
    size_t line;
    bool closed;
    scenario_window_t at_ms;
} scenario_output_t;

typedef struct {
    size_t line;
    int8_t code;
    bool at_some_time; /**< of the window, not during all of it */
    scenario_window_t at_ms;
} scenario_led_t;

typedef struct {
    size_t line;
    agv_fault_t fault;
    agv_fault_class_t fault_class;
    bool has_class;
    uint16_t parts; /**< HAL_SELF_TEST_*; 0: any */
    scenario_window_t raised_ms;
    bool has_end;
    bool never_ends;
    scenario_window_t ended_ms;
} scenario_fault_t;

/** A reset (accepted or refused) or a report of what is missing at start. */
typedef struct {
    size_t line;
    bool accepted;
    uint16_t missing; /**< AGV_MISSING_* */
    scenario_window_t at_ms;
} scenario_reset_t;

/** Expected state of the vehicle at some time of a window; members are evaluated if their has_ is set. */
typedef struct {
    size_t line;
    scenario_window_t at_ms;
    bool has_gear, has_mode, has_speed, has_throttle, has_eps_mode, has_angle, has_fastest_park, has_alarms;
    uint8_t gear;
    bool autopilot;
    uint8_t eps_mode;
    uint8_t alarms;
    int32_t speed_mm_s[2];
    int32_t throttle_pct[2];
    int32_t angle_deg[2];
    int32_t fastest_park_mm_s[2];
} scenario_vehicle_t;

/** A counter of the supervisor at the end. */
typedef struct {
    size_t line;
    const char *name;
    size_t offset; /**< in agv_counters_t */
    scenario_window_t value;
} scenario_counter_t;

/** A list of fixed room; `count` of them are there. */
#define SCENARIO_LIST(type)                                                                                            \
    struct {                                                                                                           \
        type items[SCENARIO_EXPECT_MAX];                                                                               \
        size_t count;                                                                                                  \
    }

typedef struct {
    SCENARIO_LIST(scenario_state_t) states;
    SCENARIO_LIST(scenario_frame_t) frames;
    SCENARIO_LIST(scenario_frame_t) never;
    SCENARIO_LIST(scenario_output_t) outputs;
    SCENARIO_LIST(scenario_led_t) leds;
    SCENARIO_LIST(scenario_fault_t) faults;
    SCENARIO_LIST(scenario_reset_t) resets;
    SCENARIO_LIST(scenario_reset_t) startups;
    SCENARIO_LIST(scenario_vehicle_t) vehicle;
    SCENARIO_LIST(scenario_counter_t) counters;
    bool no_other_faults;
    bool any_states;   /**< changes of state and of the safety output and resets are not listed, and not evaluated */
    size_t no_hazards; /**< line on which `hazards: never` stands; 0: hazards are not evaluated */
} scenario_expect_t;

typedef struct {
    char name[SCENARIO_TEXT_MAX];
    char shows[SCENARIO_SHOWS_MAX][SCENARIO_TEXT_MAX];
    size_t shows_count;
    bool fixes_topology; /**< the file names it; else the command line may choose */
    bool fixes_id_set;
    agv_config_t config;
    agv_ids_t ids;         /**< of `config`; the vehicle may have others */
    config_lines_t lines;  /**< where the settings stand, while the file is read */
    bool config_unchecked; /**< handed to the supervisor though it makes no sense */
    sim_board_t board;     /**< as it is at the start */
    vehicle_config_t vehicle;
    uint32_t bitrate;
    uint32_t clock_start_ms;
    uint16_t tick_phase_us; /**< by which the supervisor's ticks lie behind the milliseconds of the vehicle */
    uint32_t watchdog_ms;   /**< UINT32_MAX: not fitted */
    hal_reset_cause_t reset_cause;
    uint32_t duration_ms;
    scenario_step_t steps[SCENARIO_STEPS_MAX];
    size_t step_count;
    size_t waiting_count; /**< of them, those that wait for an event */
    scenario_expect_t expect;
} scenario_t;

/** What the command line sets. */
typedef struct {
    agv_config_t config; /**< what the file's own settings are laid over */
    int topology;        /**< -1: not given */
    int id_set;
} scenario_options_t;

/**
 * Read a scenario file.
 * @param scenario some 100 KiB: not for the stack
 * @param options NULL: the default configuration, and the command line sets nothing
 * @return false: it makes no sense; was reported with file and line.
 */
bool scenario_read(scenario_t *scenario, const char *file, const scenario_options_t *options);

/** The same from memory. @param name for messages, in the place of the file's */
bool scenario_read_text(scenario_t *scenario, const char *name, const char *text, const scenario_options_t *options);

/** The identifier that a frame expectation is about; SCENARIO_NO_ID = any. */
uint32_t scenario_frame_id(const scenario_t *scenario, const scenario_frame_t *frame);

#endif

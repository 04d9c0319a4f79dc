/**
 * @file hazard.h
 * Checks whether a run put the vehicle into a hazard. Its facts are the simulated vehicle, the frames on the wire, the
 * safety output and the buttons of the simulated operator. It uses nothing that the supervisor reports.
 *
 * Every limit is that of the supervisor, from the settings of the run, plus 1.5 s: a late reaction is not a hazard.
 * docs/hunt.md describes each hazard.
 */
#ifndef HOST_SIM_HAZARD_H
#define HOST_SIM_HAZARD_H

#include <stdbool.h>
#include <stdint.h>

#include "scenario/scenario.h"
#include "scenario/scenario_testbed.h"

/** What kind of hazard. */
typedef enum {
    HAZARD_NONE,
    HAZARD_NOT_STOPPING,  /**< H1 */
    HAZARD_STEERING,      /**< H2 */
    HAZARD_FALSE_COMMAND, /**< H3 */
    HAZARD_UNCONFIRMED,   /**< H4 */
    HAZARD_RESET,         /**< H5 */
    HAZARD_FALSE_NODE,    /**< H6 */
    HAZARD_FLOOD,         /**< H7 */
    HAZARD_PARK,          /**< H8 */
    HAZARD_KINDS
} hazard_kind_t;

/** The texts of a kind. */
typedef struct {
    const char *name;    /**< "H1" */
    const char *meaning; /**< one line */
    const char *safe;    /**< what a safe supervisor does instead, one line */
} hazard_info_t;

const hazard_info_t *hazard_info(hazard_kind_t kind);

enum {
    HAZARD_ROWS_MAX = 48,
    HAZARD_SCORES_MAX = 5,
    HAZARD_RECENT = 256,
    HAZARD_ANGLES = 64,
    HAZARD_ENGAGEMENTS = 3,
    HAZARD_FLOOD_SLOTS = 10
};

/** A message as it was on the wire: commands where the AI computer sends them, status on the vehicle side. */
typedef struct {
    bool has;
    bool has_valid;
    uint64_t seen_ms;    /**< last well-formed frame */
    uint64_t changed_ms; /**< its alive counter changed */
    uint64_t seen_us;
    uint64_t valid_ms; /**< last frame with a usable value */
    uint8_t data[AGV_DLC];
    uint8_t valid[AGV_DLC];
    int32_t fast; /**< gaps that were too short, less those that were not */
} hazard_message_t;

/** Values of one command that the AI side carried lately. */
typedef struct {
    uint64_t at_ms[HAZARD_RECENT];
    uint16_t value[HAZARD_RECENT];
    uint32_t next;
} hazard_recent_t;

/** The mode as 363h reports it. */
typedef struct {
    bool autopilot; /**< bit 8 in the last one */
    bool manual;    /**< bit 7 and not bit 8 */
    bool both;
    bool heard;                            /**< the supervisor received the report of manual */
    uint64_t clear_ms;                     /**< since when bit 8 is clear */
    bool engaged;                          /**< since a 363h with bit 8 alone, up to mode_frames in a row without it */
    uint32_t clear_frames;                 /**< consecutive 363h with bit 8 clear */
    uint64_t ended_ms;                     /**< end of the last engagement */
    uint64_t handback_ms;                  /**< when manual ended last */
    uint64_t manual_ms;                    /**< last 363h that reported manual */
    bool graced;                           /**< this engagement has its grace time: it is not one too many */
    uint64_t engaged_ms;                   /**< its beginning */
    uint64_t begun_ms[HAZARD_ENGAGEMENTS]; /**< beginnings of the last ones */
    uint32_t begun_count;
} hazard_mode_t;

/** A button that resets, and what became of it since the first safe command. */
typedef struct {
    bool down;
    bool pressed;
    bool released; /**< after that */
    uint64_t press_ms;
    uint32_t ups;   /**< 363h that report it as up, less those that do not */
    bool is_glitch; /**< too few of them: what follows is no press */
} hazard_button_t;

/** The supervisor's own safe commands, as the wire shows them. */
typedef struct {
    bool ready;        /**< the safety output was closed, with no safe commands */
    bool tripped;      /**< they came since */
    bool parks;        /**< the first 168h P */
    bool parked;       /**< the same, since a trip or a restart */
    bool stood;        /**< 101h has reported standstill since */
    uint64_t first_ms; /**< of the first since then */
    uint64_t
        since_ms; /**< the trip was no earlier: the transmitter may have taken nothing before, or the supervisor hung */
    uint64_t stalled_ms;      /**< it took nothing at that time, or the supervisor hung */
    uint64_t free_ms;         /**< it took frames at that time */
    uint64_t last_ms;         /**< of the last 43Fh with the whole safe payload */
    hazard_button_t button;   /**< remote button 1, as the operator really holds it */
    hazard_button_t reported; /**< the same, as 363h reports it */
    hazard_button_t pin;      /**< the push button, with its bouncing */
    bool was_closed;
    uint64_t closed_ms;    /**< the safety output was closed */
    uint32_t unasked_ms;   /**< time in which P was not commanded */
    uint32_t unparked_ms;  /**< sum of the time in which P was not confirmed */
    uint32_t engaged_ms;   /**< the same of the autopilot that is off */
    uint32_t confirmed_ms; /**< both, without a break */
} hazard_trip_t;

/** Angles that may be held: from the one to the other, and a little more. */
typedef struct {
    int32_t low_ddeg;
    int32_t high_ddeg;
} hazard_range_t;

/** The first measured angles after an event. */
typedef struct {
    hazard_range_t range;
    uint64_t since_ms; /**< when the first of them came */
    bool any;
} hazard_first_t;

/** 065h of the supervisor. */
typedef struct {
    uint64_t last_ms;
    uint16_t value;         /**< that it carried last */
    int32_t start_ddeg;     /**< where the steering really was when this angle was wrong first */
    hazard_range_t now;     /**< real and lately measured angles then */
    hazard_range_t at_trip; /**< the same at the trip */
    bool has_trip;
    uint64_t trip_ms;
    bool is_dropped; /**< since then manual was reported, or the EPS took no angle */
    uint64_t dropped_ms;
    hazard_first_t first;   /**< after the trip, or after its angle was dropped */
    hazard_first_t perhaps; /**< after its angle was perhaps dropped */
    hazard_first_t before;  /**< the same before it was perhaps dropped once more, of each time */
    bool was_deaf;          /**< in bus-off */
    uint16_t kept;          /**< the last right value */
    uint64_t kept_until_ms; /**< it may be sent again until then */
    int32_t wrong_ddeg;     /**< the commanded angle that is none of these */
    bool is_wrong;
    int32_t measured_ddeg[HAZARD_ANGLES]; /**< the last ones */
    uint64_t measured_ms[HAZARD_ANGLES];
    uint32_t measured_count;
} hazard_hold_t;

/** What the EPS and the VCU report of the EPS: consecutive frames. */
typedef struct {
    uint32_t supply_frames; /**< 167h with a fault of its supply */
    uint32_t bad_frames;    /**< with another fault, or not in angle control */
    uint32_t alarm_frames;  /**< 363h with an alarm of the EPS */
    uint32_t bad_angles;    /**< 067h with an invalid angle */
    uint32_t good_angles;
    bool is_angle_lost; /**< the supervisor must know that it is invalid */
} hazard_eps_t;

/** An evaluation. Read `kind`, `cause`, `at_ms` and `closeness`. */
typedef struct {
    hazard_kind_t kind; /**< the first hazard; HAZARD_NONE */
    const char *cause;  /**< which of its conditions */
    uint64_t at_ms;
    uint8_t closeness[HAZARD_ROWS_MAX]; /**< the most that each condition came to: sixteenths of its limit */

    const scenario_t *scenario;
    const agv_config_t *config;
    const scenario_testbed_t *testbed;
    scenario_testbed_view_t view; /**< when the evaluation last looked at it */
    bool gateway;
    bool limits_steering;
    uint64_t t_us;
    uint64_t t_ms;
    bool closed;
    uint32_t bites; /**< of the supervisor's watchdog */
    hazard_message_t messages[AGV_MSG_COUNT];
    hazard_recent_t recent[AGV_COMMAND_COUNT];
    uint16_t commanded[AGV_COMMAND_COUNT]; /**< the last value commanded to the vehicle */
    bool is_commanded[AGV_COMMAND_COUNT];  /**< in this engagement */
    uint32_t untaken;                      /**< 065h in a row that found no EPS in angle control */
    uint16_t throttle_high;                /**< 050h: the value from which it has to come down */
    uint64_t throttle_high_ms;
    uint16_t
        throttle_before; /**< the same before it came down last: a fall that is undone, without a command to rise, is none */
    uint64_t throttle_before_ms;
    uint8_t throttle_seen;      /**< the last 050h */
    uint64_t throttle_rises_ms; /**< last 075h above it; 0: none */
    hazard_mode_t mode;
    hazard_trip_t trip;
    hazard_hold_t hold;
    hazard_eps_t eps;
    int32_t contradicted_ms; /**< 101h reports standstill, and 363h a speed: budget, up to speed_implausible_ms */
    uint64_t stood_ms;       /**< 101h last reported standstill, and was not doubted */
    uint64_t moved_ms;       /**< 101h or 363h last reported no standstill */
    uint64_t bad_command_ms; /**< the last malformed AI command */
    bool has_bad_command;
    uint64_t foreign_ms;  /**< first foreign command on the vehicle side that was not answered; 0: none */
    uint64_t false_ms;    /**< first command on the vehicle side that no node sent; 0: none */
    uint64_t stalled_ms;  /**< last time its transmitter towards the vehicle was stalled or error-passive; 0: never */
    bool false_is_065h;   /**< that may be the first frame of a hold, whose others wait in a stalled transmitter */
    uint64_t throttle_ms; /**< last 075h above 0 on the vehicle side; newest one there */
    bool throttle_is_newest;
    uint64_t asked_off_ms;      /**< the AI computer has been asking for autopilot off since then; 0: it does not */
    uint64_t asked_all_ms[256]; /**< by alive counter: when its 43Fh asked for the same as the safe one; 0: never */
    uint32_t passed[HAZARD_FLOOD_SLOTS];
    uint32_t passed_at;
    uint64_t turned_ms;     /**< 101h reported no standstill at that time */
    uint32_t rolled_ms;     /**< for how long the vehicle has rolled, although it was tripped */
    int32_t still_at_ddeg;  /**< 067h: the last angle */
    int32_t moved_ddeg;     /**< 067h: way to and fro, since */
    int32_t really_at_ddeg; /**< the same of the real steering */
    int32_t really_moved_ddeg;
    uint64_t still_since_ms;
    uint16_t
        lowest_raw; /**< 065h: lowest and highest angle since it last swung by more than SUP-10 allows, at `swung_ms` */
    uint16_t highest_raw;
    uint64_t swung_ms;                                    /**< 0: never */
    uint8_t score_rows[AGV_MSG_COUNT][HAZARD_SCORES_MAX]; /**< rows that a message has a score for */
    uint8_t score_counts[AGV_MSG_COUNT];
    int32_t scores[HAZARD_ROWS_MAX];
    int32_t budgets_ms[HAZARD_ROWS_MAX];
    uint32_t limits_ms[HAZARD_ROWS_MAX];
    uint32_t thresholds[HAZARD_ROWS_MAX];
    bool off[HAZARD_ROWS_MAX]; /**< its fault only warns */
} hazard_t;

/** Begin. @param testbed must be built of @p scenario; both must outlive the evaluation */
void hazard_init(hazard_t *hazard, const scenario_t *scenario, const scenario_testbed_t *testbed);

/** The callback for frames. */
scenario_watch_t hazard_watch(hazard_t *hazard);

/** A step is about to be done: it shows the frames that are not on the wire. */
void hazard_step(hazard_t *hazard, uint64_t t_ms, const scenario_step_t *step);

/** At the end of every millisecond. */
void hazard_tick(hazard_t *hazard, uint64_t t_ms);

/** Amount of the vehicle's speed. */
int32_t hazard_speed_mm_s(const hazard_t *hazard);

/** Whether the supervisor has tripped and was not reset since, as the wire shows it. */
bool hazard_is_tripped(const hazard_t *hazard);

/** Whether the operator asked for a reset since the trip, with a button that may reset. */
bool hazard_reset_was_asked(const hazard_t *hazard);

/** @name Private: the parts. @{ */

/** Whether its controller receives: a supervisor in bus-off does not, nor one without power. */
bool hazard_is_hearing(const hazard_t *hazard);

void hazard_found(hazard_t *hazard, hazard_kind_t kind, const char *cause);
bool hazard_is_safe_now(const hazard_t *hazard, uint32_t within_ms);
int32_t hazard_angle_ddeg(const hazard_t *hazard);
int32_t hazard_measured_ddeg(const hazard_t *hazard);
void hazard_rows_init(hazard_t *hazard);
void hazard_rows_frame(hazard_t *hazard, agv_message_t message, const uint8_t data[AGV_DLC]);
void hazard_rows_engage(hazard_t *hazard);
void hazard_rows_tick(hazard_t *hazard);
void hazard_wire_status(hazard_t *hazard, agv_message_t message, const hal_can_frame_t *frame);
void hazard_commanded(hazard_t *hazard, agv_message_t message, uint16_t value);
void hazard_wire_command(hazard_t *hazard, agv_message_t message, const hal_can_frame_t *frame);
bool hazard_was_sent(const hazard_t *hazard, agv_message_t message, uint16_t value);
void hazard_passed(hazard_t *hazard, agv_message_t message, const hal_can_frame_t *frame);
void hazard_passed_tick(hazard_t *hazard);

/** Gateway: its transmitter towards the vehicle is stalled now, or was until a moment ago: what waited needs time to leave. */
bool hazard_is_stalled(const hazard_t *hazard);

void hazard_safe_frame(hazard_t *hazard, agv_message_t message, const hal_can_frame_t *frame);
void hazard_safe_tick(hazard_t *hazard);
void hazard_safe_reported(hazard_t *hazard, const uint8_t data[AGV_DLC]);
void hazard_hold_frame(hazard_t *hazard, const hal_can_frame_t *frame);
void hazard_hold_tick(hazard_t *hazard);
bool hazard_hold_is_limited(const hazard_t *hazard, uint16_t value);
void hazard_hold_measured(hazard_t *hazard, int32_t angle_ddeg);
void hazard_hold_trip(hazard_t *hazard);
void hazard_hold_drop(hazard_t *hazard);
void hazard_eps_status(hazard_t *hazard, agv_message_t message, const uint8_t data[AGV_DLC]);
bool hazard_eps_takes_no_angle(const hazard_t *hazard);

/** Whether the last 167h reports angle control. */
bool hazard_eps_in_angle_control(const hazard_t *hazard);
bool hazard_eps_perhaps_takes_none(const hazard_t *hazard);
void hazard_speed_tick(hazard_t *hazard);
bool hazard_is_said_to_stand(const hazard_t *hazard);
bool hazard_is_at_standstill(const hazard_t *hazard);
bool hazard_has_surely_stood(const hazard_t *hazard);
void hazard_park_frame(hazard_t *hazard);
void hazard_hold_anew(hazard_t *hazard);
void hazard_hold_perhaps_anew(hazard_t *hazard);
/** @} */

#endif

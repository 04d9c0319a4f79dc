/**
 * @file why_internal.h
 * The parts of a why_t, for the sources of this folder. Each part follows one thing over the run, as the requirements
 * describe it, so that the beginning of a cause is known when a fault is raised.
 */
#ifndef HOST_SIM_WHY_INTERNAL_H
#define HOST_SIM_WHY_INTERNAL_H

#include "agv/recorder.h"
#include "common/message_facts.h"
#include "why/why.h"

enum { WHY_HISTORY = 8, WHY_ENGAGEMENTS = 4, WHY_TRIPS_MAX = 1000, WHY_MISSING_BITS = 11 };

/** MOVING_WHILE_SAFE: a wheel turns for so long. No setting (FSM-12). */
enum { WHY_MOVING_MS = 200 };

/** The frames of a message. */
typedef struct {
    why_evidence_t history[WHY_HISTORY]; /**< the last ones, a ring */
    uint32_t count;                      /**< of all frames */
    uint64_t last_us;                    /**< of the last one; WHY_NEVER */
    uint64_t beat_us;                    /**< of the last one that restarted the deadline; WHY_NEVER */
    uint64_t usual_us;                   /**< the time from one of these to the next, as it mostly is; 0: not known */
    message_beat_t counter;              /**< its alive counter */
    bool repeats;                        /**< since `first_repeat` its counter did not change as it has to */
    bool steps;                          /**< since then it did change, but by a wrong step */
    why_evidence_t beat;                 /**< the frame of beat_us */
    why_evidence_t first_repeat;
    why_refused_t refused; /**< since beat_us */
} why_message_t;

/** What counts bad frames, or the time with a bad condition. */
typedef struct {
    bool bad;          /**< the condition, as of the last frame */
    uint64_t value;    /**< score: 2 a bad frame; budget: 2 a microsecond */
    uint64_t since_us; /**< budget: counted up to here */
    uint64_t bad_since_us;
    uint64_t began_us;    /**< of what is counted; valid while value is not 0 */
    uint32_t bad_frames;  /**< score: that were counted since */
    bool is_mixed;        /**< score: they did not all report the same mode */
    bool is_old;          /**< score: it was bad before that already, when it did not count */
    bool is_comparable;   /**< budget: there was something to compare with at the last frame */
    why_evidence_t good;  /**< last frame before the first bad one; t_us WHY_NEVER: none */
    why_evidence_t first; /**< first bad frame that counts; t_us WHY_NEVER: none */
} why_tracker_t;

/** A frame, and the one of its message before it. */
typedef struct {
    const why_evidence_t *frame;
    const why_evidence_t *before; /**< NULL: none */
} why_score_frames_t;

/** Progress towards a command, which clears a budget; steps back count for some time after it has done so. */
typedef struct {
    int32_t gained;
    int32_t gained_beyond;  /**< of motion beyond the limit alone; 0 while steps back do not count */
    uint64_t steps_back_us; /**< left of that time */
    uint64_t at_us;         /**< when the last step was handled */
} why_progress_t;

/** What vehicle and AI computer say, as far as budgets need it. */
typedef struct {
    bool angle_known, command_known[AGV_COMMAND_COUNT], mode_known, speed_known;
    bool vcu_speed_seen; /**< 363h reported a speed above 0 in this run of the supervisor (SUP-12) */
    uint32_t angle_raw, angle_command_raw;
    uint32_t throttle, throttle_command;
    uint32_t gear, gear_command;
    bool autopilot_off;
    uint32_t mode_bits;
    uint32_t vcu_speed;
    int32_t left_mm_s, right_mm_s;
    why_progress_t steering_progress, throttle_progress;
} why_facts_t;

/** The engagement of the autopilot. */
typedef struct {
    bool engaged;
    uint32_t off_frames;
    uint64_t began_us;                      /**< of the last one; WHY_NEVER */
    uint64_t ended_us;                      /**< of the last one; WHY_NEVER */
    uint64_t judged_us;                     /**< the grace time ends; WHY_NEVER: not engaged */
    why_evidence_t frames[WHY_ENGAGEMENTS]; /**< of the last ones, a ring */
    uint32_t count;
    uint64_t manual_us;    /**< how long manual was reported while engaged, less half of the other time */
    uint64_t at_us;        /**< of the last 363h */
    why_evidence_t manual; /**< the first of those that reported manual */
} why_engagement_t;

/** A confirmation of the safe state. */
typedef struct {
    uint64_t sum_us;   /**< for so long it was missing in all */
    uint64_t began_us; /**< valid while the sum is not 0 */
} why_missing_t;

/** Both confirmations, since the trip. */
typedef struct {
    why_missing_t off;
    why_missing_t park;
    uint64_t at_us;      /**< counted up to here */
    uint64_t missing_us; /**< one of them was missing last */
    uint64_t park_sent_us;
    bool is_park_sent;
} why_confirmation_t;

/** All that is known. */
struct why {
    agv_config_t config;
    agv_ids_t ids;
    bool is_gateway;
    bool is_recording;
    bool is_recorder;
    const agv_event_t *snapshot;   /**< of a flight recorder: the event in hand; NULL: frames are received */
    agv_event_t bad_command_event; /**< of a flight recorder: the last that raised AI_COMMAND_OUT_OF_RANGE */

    why_message_t messages[AGV_MSG_COUNT];
    why_tracker_t trackers[AGV_FAULT_COUNT];
    why_tracker_t too_fast[AGV_COMMAND_COUNT];
    agv_fault_t eps_mode; /**< EPS_MODE_*: after the last bad mode that counted */
    why_facts_t facts;
    why_engagement_t engagement;
    why_evidence_t bad_command; /**< the last one; t_us WHY_NEVER: none */
    why_evidence_t foreign;     /**< the first command of another sender, of those that follow each other */
    uint64_t foreign_last_us;
    why_evidence_t status_id; /**< a frame with the identifier of the status frame */
    why_evidence_t other_set; /**< the first frame with an identifier of the other set */
    agv_message_t other_message;
    why_evidence_t error; /**< the last error frame */
    why_confirmation_t confirmation;
    why_evidence_t safe_frame; /**< the last frame sent that could be the first safe one */

    uint8_t state;
    uint64_t state_since_us;
    uint64_t state_us[WHY_STATES];
    uint64_t now_us;
    uint64_t start_us;                     /**< of the supervisor */
    uint16_t missing;                      /* what kept it in INIT */
    uint16_t lacking;                      /* the same, in the last init_hold_ms of INIT or of the run */
    uint16_t lacking_at_end;               /* those of lacking that were still missing at its end */
    uint16_t startup_missing;              /* the same, as the supervisor said; 0: it did not */
    uint64_t missing_us[WHY_MISSING_BITS]; /* when each condition was missing last; WHY_NEVER */
    uint64_t init_due_us;                  /* when they are evaluated next */
    bool manual_was_seen;
    bool began_in_autopilot; /* the first 363h */
    bool was_tripped;        /**< in this run of the supervisor */

    why_trip_t *trips;
    size_t trip_count;
    size_t trip_room;
    size_t open_trip; /**< index of the last trip that is a change of state; trip_count: none */
    why_fault_t faults[AGV_FAULT_COUNT];
    uint64_t fault_since_us[AGV_FAULT_COUNT];
    size_t fault_order[AGV_FAULT_COUNT]; /**< in the order in which they were first raised */
    size_t fault_count;
};

/** What a message does whose alive counter has to increment, and does not. */
#define WHY_WRONG_STEPS "did not step its alive counter by 1 to 3"

/** Whether the AI computer sends it. */
static inline bool why_is_command(agv_message_t message) {
    return (uint32_t)message < AGV_COMMAND_COUNT;
}

/** The trip that is not over; NULL: none. */
const why_trip_t *why_open_trip(const why_t *why);

/** The last frames of a message. @param back 0 = the last one @return NULL: there are not so many */
const why_evidence_t *why_history(const why_message_t *message, uint32_t back);

/** The last frame of a message before a time: of frames with one stamp, none. @return NULL: none is known */
const why_evidence_t *why_before(const why_message_t *message, uint64_t t_us);

/** No evidence. */
why_evidence_t why_no_evidence(void);

/** @name Arrival and alive counters (why_life.c). @{ */
void why_life_start(why_t *why);
void why_life_frame(why_t *why, agv_message_t message, const why_evidence_t *frame);
/** When the deadline of a status message expires; 0: it is not running. */
uint64_t why_fresh_until_us(const why_t *why, agv_message_t message);
/** Count a frame of a message that does not restart its deadline. */
void why_life_refuse(why_t *why, agv_message_t message, const why_evidence_t *frame);
/** @} */

/** @name Frames that nobody but another sender sends (why_intruder.c). @{ */
void why_intruder_start(why_t *why);
void why_intruder_frame(why_t *why, const why_evidence_t *frame);
void why_intruder_command(why_t *why, agv_message_t command, const why_evidence_t *frame);
/** @} */

/** @name Bad frames, scores and budgets (why_track.c, why_budget.c). @{ */
void why_track_start(why_t *why);
void why_track_frame(why_t *why, agv_message_t message, const why_evidence_t *frame);
void why_track_engage(why_t *why);
/** Count a frame in. @param from_us bad frames before this time do not count as the beginning */
void why_score(why_tracker_t *tracker, bool bad, uint32_t frames, uint64_t from_us, const why_score_frames_t *seen);
void why_budget_frame(why_t *why, agv_message_t message, const why_evidence_t *frame);
void why_budget_command(why_t *why, agv_message_t command, const why_evidence_t *frame);
void why_budget_engage(why_t *why);
/** Count the time up to now. */
void why_budget_advance(why_t *why, uint64_t t_us);
/** The tracker that follows a fault; NULL: none. */
const why_tracker_t *why_tracker(const why_t *why, agv_fault_t fault);
/** @} */

/** The engagement (why_engage.c). */
void why_engage_start(why_t *why);
/** From when on it is judged; WHY_NEVER: it is not, also because the last 363h does not report autopilot. */
uint64_t why_judged_us(const why_t *why);
void why_engage_frame(why_t *why, const why_evidence_t *frame);
/** A change of state of a flight recorder, which has no frames: it was engaged while it was ACTIVE. */
void why_engage_state(why_t *why, const agv_event_t *event, uint64_t t_us);

/** @name The confirmations of the safe state (why_confirm.c). @{ */
/** Begin anew, at a trip. */
void why_confirm_start(why_t *why, uint64_t t_us);
void why_confirm_park_sent(why_t *why, uint64_t t_us);
/** Count the time up to now. */
void why_confirm_advance(why_t *why, uint64_t t_us);
/** Until when autopilot off, or P, is confirmed; not later than now: it is not. */
uint64_t why_off_until_us(const why_t *why);
uint64_t why_park_until_us(const why_t *why);
/** Which of the two was missing for too long. @return false: autopilot off */
bool why_confirm_waits_for_park(const why_t *why, uint64_t t_us);
/** @} */

/** @name The conditions for leaving INIT (why_init.c). @{ */
void why_init_start(why_t *why);
void why_init_check(why_t *why, uint64_t t_us);
void why_init_end(why_t *why, uint64_t t_us);
/** AGV_MISSING_* bits as the words name them: throttle only at standstill in manual, because a vehicle that drives has some. */
uint16_t why_init_words(uint32_t missing);
/** Whether both wheels report standstill. */
bool why_wheels_are_slow(const why_t *why);
/** Whether the speed of 363h is that of standstill. */
bool why_vcu_is_slow(const why_t *why);
/** @} */

/** Add a frame to the evidence, if there is room and it is not there yet. */
void why_show(why_trip_t *trip, const why_evidence_t *evidence);

/** Set the limit of a command's value, if it has one. */
void why_value_limit(why_trip_t *trip);

/** How long a condition has to last; 0: it is no budget. */
uint64_t why_budget_us(const why_t *why, agv_fault_t fault);

/** The same from an event of a flight recorder (why_recorded.c). */
void why_cause_recorded(const why_t *why, const agv_event_t *event, why_trip_t *trip);

/** Fill in what is known of a cause (why_cause.c); t_us, reason and from_earlier_run are set. */
void why_cause(const why_t *why, why_trip_t *trip);

#endif

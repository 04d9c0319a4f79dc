/**
 * @file why.h
 * Why a supervisor tripped, from the frames it received, the frames it sent and its events: for each trip the message
 * that tells, when the cause began, the limit that was exceeded, and the frames around the cause. Also how long each
 * state lasted, and when each fault was active.
 *
 * All times are microseconds since the start of the run; the calls come in the order of time.
 */
#ifndef HOST_SIM_WHY_H
#define HOST_SIM_WHY_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/faults.h"
#include "agv/protocol.h"
#include "hal/can.h"
#include "session/session.h"
#include "why/why_table.h"

#define WHY_NEVER UINT64_MAX   /**< as a time: it did not happen */
#define WHY_NO_LIMIT INT64_MIN /**< as a limit: there is none */
#define WHY_NO_ID UINT32_MAX   /**< as an identifier: there is none */
#define WHY_EVIDENCE_MAX 16u

/** A frame that shows the cause. */
typedef struct {
    uint64_t t_us; /**< WHY_NEVER: not known */
    hal_can_side_t side;
    hal_can_frame_t frame;
} why_evidence_t;

/** Frames with the identifier of a message that did not count as one. */
typedef struct {
    uint32_t count;
    why_evidence_t first;
} why_refused_t;

/** A trip, or a trip fault of the vehicle's behaviour while it was tripped (`kind` is WHY_VEHICLE). */
typedef struct {
    uint64_t t_us;
    agv_fault_t reason;
    why_kind_t kind;
    agv_message_t message; /**< that tells; AGV_MSG_NONE: none */
    uint32_t id;           /**< of that message on the wire; WHY_NO_ID */
    uint64_t cause_us;     /**< when it began, not when it was noticed; WHY_NEVER: not known */
    uint64_t last_good_us; /**< last frame before that was as it should be; WHY_NEVER */
    bool from_earlier_run; /**< latched in an earlier run of the supervisor; neither cause nor limit are known */
    bool from_engagement;  /**< cause_us is the engagement: it may have been so before, when it did not count */
    bool at_the_latest;    /**< it began at cause_us or before */
    bool was_heard;        /**< silence: it had come before; last_good_us WHY_NEVER: when is not known */
    uint64_t next_us;      /**< silence: the frame that ended it; WHY_NEVER */
    why_refused_t refused; /**< silence: what came all the same, until the trip */
    bool wrong_steps;      /**< stuck: the counter changed, but not by the steps that it has to make */
    bool is_mixed;         /**< score: the frames did not all report the same mode */
    uint32_t bad_frames;   /**< score: so many; 0: not known */
    why_evidence_t bad;    /**< the frame at cause_us; t_us WHY_NEVER: none */
    bool parked;           /**< since the trip, P was confirmed */
    bool disengaged;       /**< since the trip, it was confirmed that the autopilot is off */
    int64_t limit;         /**< that was exceeded; WHY_NO_LIMIT */
    const char *unit;      /**< of the limit: "ms", "frames", "ddeg", "counts"; NULL: no limit */
    size_t evidence_count;
    why_evidence_t evidence[WHY_EVIDENCE_MAX]; /**< in the order of time */
    uint64_t first_safe_us;                    /**< first frame of its own after the trip */
    uint64_t confirmed_us;                     /**< state SAFE */
    uint64_t stopped_us;                       /**< both wheels stand */
    bool from_recording;                       /**< a consequence of the fact that a recording cannot obey */
} why_trip_t;

/** Whether a gateway did not pass on what came. */
static inline bool why_was_withheld(const why_trip_t *trip) {
    const hal_can_frame_t *frame = &trip->refused.first.frame;
    return (trip->refused.count > 0) && (frame->flags == 0) && (frame->length == AGV_DLC);
}

/** A fault that was raised. */
typedef struct {
    agv_fault_t fault;
    agv_fault_class_t fault_class; /**< when it was raised last */
    uint64_t first_us;
    uint64_t trip_us;   /**< when it was first of the class that trips; WHY_NEVER */
    uint64_t active_us; /**< in all */
    uint32_t times;
    uint32_t left_out;   /**< further events of it that a flight recorder did not keep (INT-3) */
    bool active;         /**< at the end */
    bool in_init;        /**< in INIT only, where nothing but an unresettable fault trips */
    bool from_recording; /**< as in why_trip_t, each time */
} why_fault_t;

/** Whether a fault is one that trips, and did not, because it occurred in INIT, where only unresettable ones do. */
static inline bool why_did_not_trip(const why_fault_t *fault) {
    const bool trips = (agv_fault_flags((uint32_t)fault->fault) & AGV_FAULT_FLAG_UNRESETTABLE) != 0;
    return fault->in_init && (fault->fault_class == AGV_CLASS_TRIP) && !trips;
}

/** The five states, in the order of a run. */
enum { WHY_INIT, WHY_STANDBY, WHY_ACTIVE, WHY_TRIPPED, WHY_SAFE, WHY_STATES };

typedef struct why why_t;

/** Begin. @param config is copied @return NULL: no memory */
why_t *why_new(const agv_config_t *config);

/** Whether the supervisor sends nothing (TOP-4). */
bool why_is_shadow(const why_t *why);

/** The frames come from a recording, which does not obey the supervisor. Before the first frame. */
void why_is_recording(why_t *why);

/**
 * The events come from a flight recorder, and no frames with them. Times of causes are derived from the limits.
 */
void why_is_recorder(why_t *why);

/** A frame was received. */
void why_frame(why_t *why, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us);

/** A frame of the supervisor was sent. */
void why_sent(why_t *why, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us);

/** An event of the supervisor: a session_observer_fn; @p ctx is the why_t. */
void why_event(void *ctx, const session_event_t *event);

/** The run is over. */
void why_end(why_t *why, uint64_t t_us);

/** @name What was found; all of it stays valid until the next call that changes it. @{ */
size_t why_trip_count(const why_t *why);
const why_trip_t *why_trip(const why_t *why, size_t index);
size_t why_fault_count(const why_t *why);
const why_fault_t *why_fault(const why_t *why, size_t index);

/** How long a state lasted in all. @param index WHY_INIT .. WHY_SAFE */
uint64_t why_state_us(const why_t *why, size_t index);

/** The time outside INIT. */
uint64_t why_supervised_us(const why_t *why);

/** Whether the autopilot was ever engaged: else the commands of the AI computer were not judged. */
bool why_was_engaged(const why_t *why);

/** Whether the first 363h reported autopilot. */
bool why_began_in_autopilot(const why_t *why);

/** Whether it was in INIT for longer than a start takes: to the end, or a part of the run was not supervised. */
bool why_left_init_late(const why_t *why);

/** What of the confirmation of a trip did not come, if not all of it did: "P", "autopilot off" or both. */
const char *why_unconfirmed(const why_trip_t *trip);

/** AGV_MISSING_* bits: what kept it in INIT, until it left it or until the end. */
uint16_t why_missing(const why_t *why);
/** @} */

/** What the object says besides what was found. */
typedef struct {
    const char *log;                       /**< name of the log, of the interface or of the scenario; NULL: null */
    const char *interfaces[HAL_CAN_SIDES]; /**< names of the sides; NULL: none */
    bool goes_back;   /**< the time stamps of the log go back so far that they may hide a silence */
    json_t *messages; /**< the array of survey; the reference is taken; NULL: an empty one */
} why_names_t;

/** All of it as a JSON object. @return NULL: no memory */
json_t *why_json(const why_t *why, const why_names_t *names);

/** Release it. Nothing for NULL. */
void why_free(why_t *why);

#endif

/**
 * @file skeleton_facts.h
 * What of a log goes into a scenario: its first trip, when the autopilot was engaged before, how the vehicle was driven,
 * and whether a node was silent as a whole.
 */
#ifndef HOST_SIM_SKELETON_FACTS_H
#define HOST_SIM_SKELETON_FACTS_H

#include "agv/state.h"
#include "skeleton/skeleton.h"
#include "text/text.h"
#include "why/why.h"

/** All times are since the first frame. */
typedef struct {
    const skeleton_request_t *request;
    bool has_ended;     /**< the log was replayed to its end */
    size_t trips;       /**< how many there were */
    size_t more;        /**< trips after the first one that replay shows, too: none because a recording cannot obey */
    uint64_t states_us; /**< how long it supervised */
    why_trip_t trip;    /**< the first one */
    text_t why;         /**< as a sentence */
    agv_state_t before; /**< state before the trip */
    bool has_tripped;
    uint64_t engaged_ms; /**< when ACTIVE was entered last before the trip */
    bool is_driven;      /**< the next three were heard, and the gear is D or R */
    uint8_t gear;        /**< AGV_GEAR_*; engaged: as commanded, else as reported */
    uint16_t throttle_permille;
    int32_t angle_ddeg;
    bool node_is_silent; /**< of a trip by silence: nothing more came from the sender of the message */
} skeleton_facts_t;

/** Read the log. @return false: reported */
bool skeleton_facts_read(skeleton_facts_t *facts, const skeleton_request_t *request);

/** When the cause began, in ms. */
uint64_t skeleton_cause_ms(const skeleton_facts_t *facts);

/** When the autopilot was engaged that the trip counts from, in ms. It may trip before it is ACTIVE. */
uint64_t skeleton_engaged_ms(const skeleton_facts_t *facts);

/** Whether a silent message had come before. */
bool skeleton_was_heard(const skeleton_facts_t *facts);

/** Whether a command, or its counter, was silent before the engagement already. */
bool skeleton_is_early(const skeleton_facts_t *facts);

#endif

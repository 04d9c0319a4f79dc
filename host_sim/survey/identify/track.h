/**
 * @file track.h
 * One value of an identifier over time: when it changed, and from when to when it cannot have been otherwise.
 *
 * Small changes are left out (each field says how small), so that a track of a value that is noisy stays short.
 */
#ifndef HOST_SIM_TRACK_H
#define HOST_SIM_TRACK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "agv/protocol.h"

/** The fields by which the messages of the protocol are told apart. */
typedef enum {
    FIELD_BYTE_0,   /**< gear, throttle */
    FIELD_BYTE_1,   /**< supply of the EPS */
    FIELD_WORD_0,   /**< commanded angle, speed of the vehicle */
    FIELD_WORD_2,   /**< measured angle */
    FIELD_LONG_0,   /**< left wheel */
    FIELD_LONG_4,   /**< right wheel */
    FIELD_EPS_MODE, /**< mode of the EPS */
    FIELD_LIGHTS,   /**< turn signals that are commanded */
    FIELD_SIGNALS,  /**< turn signals that are on */
    FIELD_MODE,     /**< manual and autopilot mode */
    FIELD_COUNT
} field_t;

/** A change of a value. */
typedef struct {
    uint64_t before_us; /**< the last frame with the value before */
    uint64_t at_us;     /**< the first frame with this one */
    int32_t value;
} track_change_t;

/** All zero: nothing yet. */
typedef struct {
    track_change_t *changes; /**< the first one is the first frame */
    size_t count;
    size_t room;
    uint64_t frame_us; /**< the last frame */
    uint64_t until_us; /**< what came later is not in it */
    int32_t lowest;    /**< of all frames, also of those that are not in it */
    int32_t highest;
    bool is_full;
} track_t;

/** The fields of a message, a bit each. */
uint32_t field_of_message(uint32_t message);

/** Take a frame. */
void track_add(track_t *track, field_t field, const uint8_t data[AGV_DLC], uint64_t t_us);

/** The value at a time. @param at where to search from: begin with 0, and ask for times in their order */
int32_t track_value(const track_t *track, size_t *at, uint64_t t_us);

/** Free what it points to; NULL is allowed. */
void track_free(track_t *track);

#endif

/**
 * @file series_read.h
 * What a frame says to the series: its message, its signals as numbers, and the time since the one before.
 */
#ifndef HOST_SIM_SERIES_READ_H
#define HOST_SIM_SERIES_READ_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/protocol.h"
#include "common/message_facts.h"
#include "report/series.h"

/** The signals. The unit is that of the name. */
typedef enum {
    SERIES_WHEEL_LEFT,       /**< mm/s */
    SERIES_WHEEL_RIGHT,      /**< mm/s */
    SERIES_VCU_SPEED,        /**< mm/s */
    SERIES_THROTTLE_COMMAND, /**< permille */
    SERIES_THROTTLE_SENT,    /**< by the supervisor */
    SERIES_THROTTLE_STATUS,
    SERIES_STEERING_COMMAND, /**< 0.1 deg */
    SERIES_STEERING_SENT,    /**< by the supervisor */
    SERIES_STEERING_STATUS,
    SERIES_SIGNALS
} series_signal_t;

/** Codes and words of a reported mode. */
enum { SERIES_MODE_NEITHER, SERIES_MODE_MANUAL, SERIES_MODE_AUTOPILOT, SERIES_MODE_BOTH };

/** Which identifier is which message, and who must have sent it. */
typedef struct {
    agv_config_t config;
    agv_ids_t ids;
    uint8_t message_of[AGV_ID_MAX + 1]; /**< AGV_MSG_NONE: none */
} series_reader_t;

/** Time since the last frame of each message. */
typedef struct {
    uint64_t last_us[AGV_MSG_COUNT];
    message_beat_t counters[AGV_MSG_COUNT];
    bool heard[AGV_MSG_COUNT];
} series_ages_t;

/** Up to two signals of a frame. */
typedef struct {
    uint8_t count;
    uint8_t signal[2]; /**< series_signal_t */
    int32_t value[2];
} series_values_t;

void series_reader_init(series_reader_t *reader, const agv_config_t *config);

/**
 * The message that a frame counts as; AGV_MSG_NONE: none. Of the supervisor's own frames, those to the vehicle; of the
 * others, those that the supervisor takes: well-formed, and a command only from the side of the AI computer.
 */
agv_message_t series_message(const series_reader_t *reader, const series_frame_t *frame);

/** Its signals. @return those that are valid */
series_values_t series_values(agv_message_t message, const series_frame_t *frame);

/**
 * Count a frame of a message in.
 * @param gap_us time since the one before (of a heartbeat: since the last with another counter); 0 for the first
 * @return whether it renews the message: false for an old counter, and for a command out of range
 */
bool series_ages_frame(const series_reader_t *reader, series_ages_t *ages, agv_message_t message,
                       const series_frame_t *frame, uint64_t *gap_us);

#endif

#include "report/series_read.h"

#include <string.h>

#include "agv/codec.h"

enum { MM_S_PER_1000_M_PER_H = 278 };

void series_reader_init(series_reader_t *reader, const agv_config_t *config) {
    reader->config = *config;
    agv_config_ids(config, &reader->ids);
    memset(reader->message_of, (int)AGV_MSG_NONE, sizeof reader->message_of);
    for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
        reader->message_of[reader->ids.of[message] & AGV_ID_MAX] = (uint8_t)message;
    }
}

agv_message_t series_message(const series_reader_t *reader, const series_frame_t *frame) {
    if ((frame->flags != 0) || (frame->length != AGV_DLC) || (frame->id > AGV_ID_MAX)) {
        return AGV_MSG_NONE;
    }
    const agv_message_t message = (agv_message_t)reader->message_of[frame->id];
    const bool is_command = (uint32_t)message < AGV_COMMAND_COUNT;
    const bool is_gateway = reader->config.topology == AGV_TOPOLOGY_GATEWAY;
    const hal_can_side_t from = (is_command && is_gateway && !frame->sent) ? HAL_CAN_AI : HAL_CAN_VEHICLE;
    if ((frame->side != (uint8_t)from) || (frame->sent && !is_command)) {
        return AGV_MSG_NONE;
    }
    return message;
}

static void add(series_values_t *values, series_signal_t signal, int32_t value) {
    values->signal[values->count] = (uint8_t)signal;
    values->value[values->count] = value;
    values->count++;
}

static void add_wheels(series_values_t *values, const series_frame_t *frame) {
    agv_wheel_speed_t wheels;
    if (agv_unpack_wheel_speed(&wheels, frame->data)) {
        add(values, SERIES_WHEEL_LEFT, wheels.left_mm_s);
        add(values, SERIES_WHEEL_RIGHT, wheels.right_mm_s);
    }
}

static void add_angle(series_values_t *values, series_signal_t signal, const uint8_t *bytes) {
    const uint32_t raw = agv_angle_read(bytes);
    if (raw <= AGV_ANGLE_RAW_MAX) {
        add(values, signal, (int32_t)raw - AGV_ANGLE_RAW_CENTRE);
    }
}

static void add_throttle(series_values_t *values, series_signal_t signal, uint8_t counts) {
    if (counts <= AGV_THROTTLE_MAX_COUNTS) {
        add(values, signal, (int32_t)(counts * AGV_THROTTLE_PERMILLE_PER_COUNT));
    }
}

series_values_t series_values(agv_message_t message, const series_frame_t *frame) {
    series_values_t values = {.count = 0};
    agv_vehicle_status_t status;
    switch (message) {
    case AGV_MSG_THROTTLE_COMMAND:
        add_throttle(&values, frame->sent ? SERIES_THROTTLE_SENT : SERIES_THROTTLE_COMMAND, frame->data[0]);
        break;
    case AGV_MSG_THROTTLE_STATUS:
        add_throttle(&values, SERIES_THROTTLE_STATUS, frame->data[0]);
        break;
    case AGV_MSG_STEERING_COMMAND:
        add_angle(&values, frame->sent ? SERIES_STEERING_SENT : SERIES_STEERING_COMMAND, frame->data);
        break;
    case AGV_MSG_STEERING_STATUS:
        add_angle(&values, SERIES_STEERING_STATUS, &frame->data[2]);
        break;
    case AGV_MSG_VEHICLE_STATUS:
        if (agv_unpack_vehicle_status(&status, frame->data)) {
            add(&values, SERIES_VCU_SPEED, (int32_t)(status.speed_m_per_h * MM_S_PER_1000_M_PER_H / 1000));
        }
        break;
    case AGV_MSG_WHEEL_SPEED:
        add_wheels(&values, frame);
        break;
    default:
        break;
    }
    return values;
}

/** Whether a frame renews its message. */
static bool renews(const series_reader_t *reader, series_ages_t *ages, agv_message_t message,
                   const series_frame_t *frame) {
    const uint8_t at = message_counter_at(message);
    if (at == MESSAGE_NO_COUNTER) {
        return ((uint32_t)message >= AGV_COMMAND_COUNT) || agv_value_is_valid((uint32_t)message, frame->data);
    }
    return message_beats(&ages->counters[message], &reader->config, message, frame->data[at]);
}

bool series_ages_frame(const series_reader_t *reader, series_ages_t *ages, agv_message_t message,
                       const series_frame_t *frame, uint64_t *gap_us) {
    const bool is_new = renews(reader, ages, message, frame);
    *gap_us = ages->heard[message] ? frame->t_us - ages->last_us[message] : 0;
    if (is_new) {
        ages->last_us[message] = frame->t_us;
        ages->heard[message] = true;
    }
    return is_new;
}

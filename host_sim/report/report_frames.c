#include "report/report_frames.h"

#include <inttypes.h>
#include <stdio.h>

#include "common/message_facts.h"
#include "hal/can.h"
#include "logs/candump_line.h"
#include "text/units.h"
#include "traffic/signals.h"

enum { NEAR_US = 60000, AFTER_US = 120000, DATA_SIZE = 32, CYCLES_BEFORE = 5 };

/** The frames that are shown. */
typedef struct {
    agv_ids_t ids;
    uint32_t status_id;
    uint32_t telling[2]; /* messages that tell of this fault: shown from the cause to the trip */
    uint64_t cause_us;
    uint64_t trip_us;
    uint64_t before_us; /* how long before the cause its message is shown */
} choice_t;

static void choose(choice_t *choice, const agv_config_t *config, const why_trip_t *trip) {
    agv_config_ids(config, &choice->ids);
    choice->status_id = config->status_frame_id;
    choice->telling[0] = (uint32_t)trip->message;
    choice->telling[1] =
        (trip->kind == WHY_BUDGET) ? (uint32_t)why_compared_with(trip->reason) : (uint32_t)AGV_MSG_NONE;
    choice->trip_us = trip->t_us;
    choice->cause_us = (trip->cause_us < trip->t_us) ? trip->cause_us : trip->t_us;
    const uint64_t cycle_us = agv_message_cycle_ms((uint32_t)trip->message) * (uint64_t)US_PER_MS;
    choice->before_us = (cycle_us * CYCLES_BEFORE > NEAR_US) ? cycle_us * CYCLES_BEFORE : (uint64_t)NEAR_US;
}

static bool tells(const choice_t *choice, const series_frame_t *frame, uint32_t message) {
    return !frame->sent && (message != AGV_MSG_NONE) &&
           ((message == choice->telling[0]) || (message == choice->telling[1]));
}

static bool is_near(uint64_t t_us, uint64_t centre_us, uint64_t after_us) {
    return (t_us + (uint64_t)NEAR_US >= centre_us) && (t_us <= centre_us + after_us);
}

static bool is_shown(const choice_t *choice, const series_frame_t *frame, uint32_t message) {
    if (tells(choice, frame, message)) {
        return (frame->t_us + choice->before_us >= choice->cause_us) && (frame->t_us <= choice->trip_us + AFTER_US);
    }
    return is_near(frame->t_us, choice->cause_us, NEAR_US / 2) || is_near(frame->t_us, choice->trip_us, AFTER_US / 2);
}

static const char *data_text(const series_frame_t *frame, char text[DATA_SIZE]) {
    const size_t count = (frame->length < sizeof frame->data) ? frame->length : sizeof frame->data;
    size_t used = 0;
    text[0] = '\0';
    for (size_t i = 0; i < count; i++) {
        used += (size_t)snprintf(&text[used], DATA_SIZE - used, "%s%02X", (i > 0) ? " " : "", frame->data[i]);
    }
    return text;
}

static uint32_t message_of(const choice_t *choice, const series_frame_t *frame) {
    if ((frame->flags & (HAL_CAN_EXTENDED | HAL_CAN_ERROR)) != 0) {
        return UINT32_MAX;
    }
    const uint32_t message = agv_ids_find(&choice->ids, frame->id);
    if (message != AGV_MSG_NONE) {
        return message;
    }
    return (frame->id == choice->status_id) ? SIGNALS_STATUS_FRAME : UINT32_MAX;
}

static json_t *frame_json(const choice_t *choice, const series_frame_t *frame) {
    const uint32_t message = message_of(choice, frame);
    const bool has_signals = (frame->flags == 0) && (frame->length == AGV_DLC) && (message <= SIGNALS_STATUS_FRAME);
    char id[CANDUMP_ID_SIZE];
    char data[DATA_SIZE];
    char signals[SIGNALS_TEXT_SIZE];
    const char *name = (message <= SIGNALS_STATUS_FRAME) ? signals_message_name(message) : NULL;
    return json_pack("[I,i,b,s,s,s,s,b]", (json_int_t)frame->t_us, (int)frame->side, (int)frame->sent,
                     candump_id_text(id, frame->id, frame->flags), data_text(frame, data), (name != NULL) ? name : "",
                     has_signals ? signals_print(signals, sizeof signals, message, frame->data)
                                 : message_form(frame->flags),
                     (int)tells(choice, frame, message));
}

void report_frames_add(json_t *trip_object, const agv_config_t *config, const why_trip_t *trip,
                       const series_t *series) {
    size_t count = 0;
    const series_frame_t *frames = series_frames(series, trip->t_us, &count);
    json_t *array = json_array();
    size_t left_out = 0;
    choice_t choice;
    choose(&choice, config, trip);
    for (size_t i = 0; i < count; i++) {
        if (!is_shown(&choice, &frames[i], message_of(&choice, &frames[i]))) {
            continue;
        }
        if (json_array_size(array) < REPORT_FRAMES_MAX) {
            (void)json_array_append_new(array, frame_json(&choice, &frames[i]));
        } else {
            left_out++;
        }
    }
    (void)json_object_set_new(trip_object, "frames", array);
    (void)json_object_set_new(trip_object, "frames_left_out", json_integer((json_int_t)left_out));
}

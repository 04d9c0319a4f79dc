#include <inttypes.h>
#include <stdio.h>

#include "agv/names.h"
#include "common/json_build.h"
#include "logs/candump_line.h"
#include "text/units.h"
#include "why/why.h"

enum { ID_SIZE = 12, DATA_SIZE = 17 };

static json_t *time_or_null(uint64_t t_us) {
    return (t_us != WHY_NEVER) ? json_integer((json_int_t)(t_us / US_PER_MS)) : json_null();
}

static json_t *id_or_null(uint32_t id) {
    char text[ID_SIZE];
    (void)snprintf(text, sizeof text, "%03" PRIX32, id);
    return (id != WHY_NO_ID) ? json_string(text) : json_null();
}

static json_t *data_of(const hal_can_frame_t *frame) {
    char text[DATA_SIZE] = "";
    for (size_t i = 0; (i < frame->length) && (i < sizeof frame->data); i++) {
        (void)snprintf(&text[2 * i], 3, "%02X", frame->data[i]);
    }
    return json_string(text);
}

static json_t *evidence_json(const why_trip_t *trip, const why_names_t *names) {
    json_t *list = json_array();
    for (size_t i = 0; i < trip->evidence_count; i++) {
        const why_evidence_t *evidence = &trip->evidence[i];
        char id[CANDUMP_ID_SIZE];
        json_t *object = json_object();
        json_put(object, "t_ms", (evidence->t_us != WHY_NEVER) ? json_real(ms_of_us(evidence->t_us)) : json_null());
        json_put(object, "if", json_text(names->interfaces[evidence->side]));
        json_put(object, "id", json_string(candump_id_text(id, evidence->frame.id, evidence->frame.flags)));
        json_put(object, "data", data_of(&evidence->frame));
        json_add(list, object);
    }
    return list;
}

static json_t *trip_of(const why_trip_t *trip, const why_names_t *names) {
    json_t *object = json_object();
    json_put(object, "t_ms", time_or_null(trip->t_us));
    json_put(object, "reason", json_text(agv_fault_name(trip->reason)));
    json_put(object, "kind", json_string(why_kind_name(trip->kind)));
    json_put(object, "message", json_text(agv_message_name(trip->message)));
    json_put(object, "id", id_or_null(trip->id));
    json_put(object, "cause_ms", time_or_null(trip->cause_us));
    json_put(object, "last_good_ms", time_or_null(trip->last_good_us));
    json_put(object, "limit", (trip->limit != WHY_NO_LIMIT) ? json_integer((json_int_t)trip->limit) : json_null());
    json_put(object, "unit", (trip->limit != WHY_NO_LIMIT) ? json_text(trip->unit) : json_null());
    json_put(object, "evidence", evidence_json(trip, names));
    json_put(object, "first_safe_ms", time_or_null(trip->first_safe_us));
    json_put(object, "confirmed_ms", time_or_null(trip->confirmed_us));
    json_put(object, "stopped_ms", time_or_null(trip->stopped_us));
    json_put(object, "from_recording", json_boolean(trip->from_recording));
    return object;
}

/** The words of what kept it in INIT to the end or for long, and of what else was not supervised. */
static json_t *not_supervised(const why_t *why, const why_names_t *names) {
    json_t *words = json_array();
    const bool is_late = why_left_init_late(why);
    const uint16_t missing = is_late ? why_missing(why) : 0;
    if (is_late && (missing == 0)) {
        json_add(words, json_string("init"));
    }
    if (names->goes_back) {
        json_add(words, json_string("time_stamps"));
    }
    for (uint8_t bit = 0; agv_missing_name(bit) != NULL; bit++) {
        if (((missing >> bit) & 1) != 0) {
            json_add(words, json_string(agv_missing_name(bit)));
        }
    }
    return words;
}

json_t *why_json(const why_t *why, const why_names_t *names) {
    json_t *object = json_object();
    json_t *trips = json_array();
    for (size_t i = 0; i < why_trip_count(why); i++) {
        json_add(trips, trip_of(why_trip(why, i), names));
    }
    json_put(object, "log", json_text(names->log));
    json_put(object, "supervised_ms", time_or_null(why_supervised_us(why)));
    json_put(object, "not_supervised", not_supervised(why, names));
    json_put(object, "trips", trips);
    json_put(object, "messages", (names->messages != NULL) ? names->messages : json_array());
    return object;
}

#include "report/report_page.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "common/json_build.h"
#include "report/page_parts.h"
#include "report/report_frames.h"
#include "report/report_settings.h"
#include "report/sentence.h"
#include "text/civil.h"
#include "text/units.h"

static json_t *time_or_null(uint64_t t_us) {
    return (t_us != WHY_NEVER) ? json_uint(t_us) : json_null();
}

static json_t *clock_json(uint64_t clock_us) {
    char text[CIVIL_LOCAL_SIZE];
    return (clock_us != 0) ? json_string(civil_local(text, clock_us)) : json_null();
}

static json_t *trip_json(const report_page_t *page, const why_t *why, const series_t *series, size_t index) {
    const why_trip_t *trip = why_trip(why, index);
    sentence_t sentence;
    sentence_trip(&sentence, page, trip, series_output_opened_us(series, trip->t_us));
    json_t *object = json_object();
    json_put(object, "t_us", json_uint(sentence_trip_us(trip)));
    json_put(object, "reason", json_text(agv_fault_name(trip->reason)));
    json_put(object, "kind", json_string(why_kind_name(trip->kind)));
    json_put(object, "message", json_text(agv_message_name(trip->message)));
    json_put(object, "cause_us", time_or_null(trip->cause_us));
    json_put(object, "last_good_us", time_or_null(trip->last_good_us));
    json_put(object, "first_safe_us", time_or_null(trip->first_safe_us));
    json_put(object, "confirmed_us", time_or_null(trip->confirmed_us));
    json_put(object, "stopped_us", time_or_null(trip->stopped_us));
    json_put(object, "limit", (trip->limit != WHY_NO_LIMIT) ? json_integer((json_int_t)trip->limit) : json_null());
    json_put(object, "unit", json_text(trip->unit));
    json_put(object, "from_recording", json_boolean(trip->from_recording));
    json_put(object, "unconfirmed", json_string(why_unconfirmed(trip)));
    json_put(object, "headline", json_string(sentence.headline));
    json_put(object, "cause", json_string(sentence.cause));
    json_put(object, "action", json_string(sentence.action));
    json_put(object, "outcome", json_string(sentence.outcome));
    report_frames_add(object, page->config, trip, series);
    return object;
}

static json_t *trips_json(const report_page_t *page, const why_t *why, const series_t *series) {
    json_t *trips = json_array();
    for (size_t i = 0; i < why_trip_count(why); i++) {
        json_add(trips, trip_json(page, why, series, i));
    }
    return trips;
}

static json_t *found_faults_json(const why_t *why) {
    json_t *faults = json_array();
    for (size_t i = 0; i < why_fault_count(why); i++) {
        const why_fault_t *fault = why_fault(why, i);
        json_t *object = json_object();
        json_put(object, "name", json_text(agv_fault_name(fault->fault)));
        json_put(object, "phrase", json_string(sentence_phrase(fault->fault)));
        json_put(object, "class", json_text(agv_class_name(fault->fault_class)));
        json_put(object, "first_us", json_uint(fault->first_us));
        json_put(object, "active_us", json_uint(fault->active_us));
        json_put(object, "times", json_uint(fault->times));
        json_put(object, "active", json_boolean(fault->active));
        json_put(object, "from_recording", json_boolean(fault->from_recording));
        json_put(object, "no_trip", json_boolean(why_did_not_trip(fault)));
        json_add(faults, object);
    }
    return faults;
}

static json_t *states_json(const why_t *why) {
    json_t *states = json_array();
    for (size_t i = 0; i < WHY_STATES; i++) {
        json_add(states, json_uint(why_state_us(why, i)));
    }
    return states;
}

static json_t *about_json(const report_page_t *page) {
    json_t *about = json_object();
    json_t *interfaces = json_array();
    char checksum[16];
    (void)snprintf(checksum, sizeof checksum, "%08" PRIX32, agv_config_checksum(page->config));
    for (size_t side = 0; side < HAL_CAN_SIDES; side++) {
        json_add(interfaces, json_text(page->interfaces[side]));
    }
    json_put(about, "name", json_text(page->name));
    json_put(about, "interfaces", interfaces);
    json_put(about, "clock", clock_json(page->clock_us));
    json_put(about, "clock_us", json_uint(page->clock_us % US_PER_MS));
    json_put(about, "recording", json_boolean(page->is_recording));
    json_put(about, "gateway", json_boolean(page->config->topology == AGV_TOPOLOGY_GATEWAY));
    json_put(about, "shadow", json_boolean(page->config->shadow == AGV_SHADOW_ON));
    json_put(about, "checksum", json_string(checksum));
    json_put(about, "version", json_string(HOST_SIM_VERSION));
    return about;
}

static json_t *sentence_json(const sentence_t *sentence) {
    json_t *object = json_object();
    json_put(object, "headline", json_string(sentence->headline));
    json_put(object, "cause", json_string(sentence->cause));
    json_put(object, "action", json_string(sentence->action));
    json_put(object, "outcome", json_string(sentence->outcome));
    return object;
}

static json_t *page_json(const report_page_t *page, const why_t *why, const series_t *series,
                         const sentence_t *sentence) {
    json_t *object = json_object();
    json_put(object, "about", about_json(page));
    json_put(object, "sentence", sentence_json(sentence));
    json_put(object, "partial", json_boolean(page->is_partial));
    json_put(object, "engaged", json_boolean(why_was_engaged(why)));
    json_put(object, "supervised_us", json_uint(why_supervised_us(why)));
    json_put(object, "states", states_json(why));
    json_put(object, "trips", trips_json(page, why, series));
    json_put(object, "faults", found_faults_json(why));
    json_put(object, "settings", report_settings_json(page->config));
    json_put(object, "messages", (page->messages != NULL) ? json_deep_copy(page->messages) : json_null());
    json_put(object, "series", series_json(series));
    return object;
}

static void put(output_t *output, const char *text) {
    (void)output_write(output, text, strlen(text));
}

/** Text between tags. */
static void put_text(output_t *output, const char *text) {
    for (; *text != '\0'; text++) {
        switch (*text) {
        case '&':
            put(output, "&amp;");
            break;
        case '<':
            put(output, "&lt;");
            break;
        case '>':
            put(output, "&gt;");
            break;
        default:
            (void)output_write(output, text, 1);
            break;
        }
    }
}

static void put_paragraph(output_t *output, const char *id, const char *text) {
    put(output, "<p id=\"");
    put(output, id);
    put(output, "\">");
    put_text(output, text);
    put(output, "</p>\n");
}

/** The first words, which a browser without scripts shows as well. */
static void put_words(output_t *output, const sentence_t *sentence, const json_t *remarks) {
    put(output, "<h1 id=\"headline\">");
    put_text(output, sentence->headline);
    put(output, "</h1>\n");
    put_paragraph(output, "cause", sentence->cause);
    put_paragraph(output, "action", sentence->action);
    put_paragraph(output, "outcome", sentence->outcome);
    for (size_t i = 0; i < json_array_size(remarks); i++) {
        const json_t *remark = json_array_get(remarks, i);
        const bool is_hint = json_is_true(json_object_get(remark, "hint"));
        put(output, is_hint ? "<p class=\"remark hint\">Hint: " : "<p class=\"remark\">Not supervised: ");
        put_text(output, json_string_value(json_object_get(remark, "text")));
        put(output, ".</p>\n");
    }
}

/** A piece of JSON inside a script element: a `<` could end the element. It stands in strings alone. */
static int put_json(const char *bytes, size_t size, void *ctx) {
    output_t *output = ctx;
    size_t begin = 0;
    for (size_t i = 0; i < size; i++) {
        if (bytes[i] == '<') {
            (void)output_write(output, &bytes[begin], i - begin);
            put(output, "\\u003c");
            begin = i + 1;
        }
    }
    return output_write(output, &bytes[begin], size - begin) ? 0 : -1;
}

static void put_data(output_t *output, const json_t *data) {
    if ((json_dump_callback(data, put_json, output, JSON_COMPACT) != 0) && (output->error == 0)) {
        output->error = ENOMEM;
    }
}

/** What stands in the place of "@NAME@" in the frame of the page. */
static void put_part(output_t *output, char part, const report_page_t *page, const sentence_t *sentence,
                     const json_t *data) {
    switch (part) {
    case 'T':
        put_text(output, sentence->headline);
        break;
    case 'C':
        put(output, page_styles);
        break;
    case 'S':
        put_words(output, sentence, page->remarks);
        break;
    case 'D':
        put_data(output, data);
        break;
    default:
        put(output, page_modules);
        break;
    }
}

void report_page_write(output_t *output, const report_page_t *page, const why_t *why, const series_t *series) {
    sentence_t sentence;
    if (why_trip_count(why) > 0) {
        const why_trip_t *first = why_trip(why, 0);
        sentence_trip(&sentence, page, first, series_output_opened_us(series, first->t_us));
    } else {
        sentence_no_trip(&sentence, why, series_end_us(series));
    }
    json_t *data = page_json(page, why, series, &sentence);
    const char *at = page_frame;
    for (const char *mark = strchr(at, '@'); mark != NULL; mark = strchr(at, '@')) {
        (void)output_write(output, at, (size_t)(mark - at));
        put_part(output, mark[1], page, &sentence, data);
        at = strchr(&mark[1], '@') + 1;
    }
    put(output, at);
    json_decref(data);
}

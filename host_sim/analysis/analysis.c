#include "analysis/analysis.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/trace.h"
#include "common/json_build.h"
#include "common/report.h"
#include "io/output_json.h"
#include "report/report_page.h"
#include "report/series.h"
#include "text/units.h"
#include "traffic/traffic.h"

enum { NAME_SIZE = 32, DIGITS = 15 };

struct analysis {
    analysis_request_t request;
    agv_config_t config;
    char names[HAL_CAN_SIDES][NAME_SIZE];
    uint64_t first_us; /**< time of day; 0: none */
    why_t *why;
    traffic_t *traffic; /**< NULL: neither --why nor --report */
    series_t *series;   /**< NULL: no --report */
    json_t *remarks;    /**< of the page; NULL: none */
    bool is_partial;    /**< a part of the run was not supervised */
    bool goes_back;     /**< because the time stamps go back */
    uint64_t last_us;   /**< of the last frame; in the end, of the end */
    trace_t trace;
    output_t files[ANALYSIS_FILES];
};

bool analysis_paths_any(const analysis_paths_t *files) {
    for (size_t i = 0; i < ANALYSIS_FILES; i++) {
        if (files->paths[i] != NULL) {
            return true;
        }
    }
    return false;
}

bool analysis_paths_use_stdout(const analysis_paths_t *files) {
    for (size_t i = 0; i < ANALYSIS_FILES; i++) {
        if (output_is_stdout(files->paths[i])) {
            return true;
        }
    }
    return false;
}

static bool is_asked_for(const analysis_t *analysis, analysis_file_t file) {
    return analysis->request.files.paths[file] != NULL;
}

/** Make the parts that are needed. @return false: no memory */
static bool make_parts(analysis_t *analysis) {
    const agv_config_t *config = &analysis->config;
    const bool page = is_asked_for(analysis, ANALYSIS_REPORT);
    analysis->why = why_new(config);
    if (is_asked_for(analysis, ANALYSIS_WHY) || page) {
        analysis->traffic = traffic_new(config);
    }
    if (page) {
        analysis->series = series_new(config);
    }
    const bool lacks_traffic = (is_asked_for(analysis, ANALYSIS_WHY) || page) && (analysis->traffic == NULL);
    return (analysis->why != NULL) && !lacks_traffic && (!page || (analysis->series != NULL));
}

analysis_t *analysis_new(const analysis_request_t *request) {
    analysis_t *analysis = calloc(1, sizeof *analysis);
    bool good = analysis != NULL;
    if (good) {
        analysis->request = *request;
        analysis->config = *request->config;
        good = make_parts(analysis);
    }
    if (!good) {
        analysis_free(analysis);
        (void)report("out of memory");
        return NULL;
    }
    if (request->is_recording) {
        why_is_recording(analysis->why);
    }
    if (request->is_recorder) {
        why_is_recorder(analysis->why);
    }
    return analysis;
}

bool analysis_open(analysis_t *analysis) {
    for (size_t i = 0; i < ANALYSIS_FILES; i++) {
        const char *path = analysis->request.files.paths[i];
        if ((path != NULL) && !output_open(&analysis->files[i], path)) {
            return false;
        }
    }
    if (is_asked_for(analysis, ANALYSIS_TRACE)) {
        trace_begin(&analysis->trace, &analysis->files[ANALYSIS_TRACE], &analysis->config);
    }
    return true;
}

void analysis_name_side(analysis_t *analysis, hal_can_side_t side, const char *name, size_t length) {
    if (analysis->names[side][0] == '\0') {
        const size_t count = (length < NAME_SIZE) ? length : (size_t)NAME_SIZE - 1;
        memcpy(analysis->names[side], name, count);
    }
}

void analysis_set_clock(analysis_t *analysis, uint64_t first_us) {
    analysis->first_us = first_us;
}

void analysis_frame(analysis_t *analysis, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    analysis->last_us = t_us;
    why_frame(analysis->why, side, frame, t_us);
    if (analysis->traffic != NULL) {
        traffic_frame(analysis->traffic, side, frame, t_us);
    }
    if (analysis->series != NULL) {
        series_frame(analysis->series, side, frame, t_us);
    }
    if (analysis->files[ANALYSIS_TRACE].is_open) {
        trace_frame(&analysis->trace, side, frame, false, t_us);
    }
}

void analysis_sent(analysis_t *analysis, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    analysis->last_us = t_us;
    why_sent(analysis->why, side, frame, t_us);
    if (analysis->series != NULL) {
        series_sent(analysis->series, side, frame, t_us);
    }
    if (analysis->files[ANALYSIS_TRACE].is_open) {
        trace_frame(&analysis->trace, side, frame, true, t_us);
    }
}

void analysis_event(void *ctx, const session_event_t *event) {
    analysis_t *analysis = ctx;
    why_event(analysis->why, event);
    const bool starts = !event->is_led && (event->recorded.kind == AGV_EVENT_STATE) && (event->recorded.a == 0);
    if (starts && (analysis->traffic != NULL)) {
        traffic_start(analysis->traffic, event->t_ms * US_PER_MS);
    }
    if (analysis->series != NULL) {
        series_event(analysis->series, event);
    }
    if (analysis->files[ANALYSIS_TRACE].is_open) {
        trace_event(&analysis->trace, event);
    }
}

static const char *name_of(const analysis_t *analysis, int side) {
    return (analysis->names[side][0] != '\0') ? analysis->names[side] : NULL;
}

/** The object of --why. @param messages the array of survey; the reference is taken */
static json_t *make_why(const analysis_t *analysis, json_t *messages) {
    why_names_t names = {.log = analysis->request.log, .goes_back = analysis->goes_back, .messages = messages};
    for (int side = 0; side < HAL_CAN_SIDES; side++) {
        names.interfaces[side] = name_of(analysis, side);
    }
    return why_json(analysis->why, &names);
}

/** The page of --report. */
static void write_report(analysis_t *analysis, const json_t *messages) {
    report_page_t page = {.name = analysis->request.log,
                          .clock_us = analysis->first_us,
                          .is_recording = analysis->request.is_recording,
                          .config = &analysis->config,
                          .messages = messages,
                          .remarks = analysis->remarks,
                          .is_partial = analysis->is_partial};
    for (int side = 0; side < HAL_CAN_SIDES; side++) {
        page.interfaces[side] = name_of(analysis, side);
    }
    report_page_write(&analysis->files[ANALYSIS_REPORT], &page, analysis->why, analysis->series);
}

void analysis_end(analysis_t *analysis, uint64_t t_us) {
    const uint64_t end_us =
        (t_us > analysis->last_us) ? t_us : analysis->last_us; /* a clock in ms is behind the frames */
    analysis->last_us = end_us;
    why_end(analysis->why, end_us);
    if (analysis->traffic != NULL) {
        traffic_end(analysis->traffic, end_us);
    }
    if (analysis->series != NULL) {
        series_end(analysis->series, end_us);
    }
}

void analysis_remark(analysis_t *analysis, analysis_remark_t kind, const char *text) {
    if (analysis->remarks == NULL) {
        analysis->remarks = json_array();
    }
    const bool is_hint = kind == ANALYSIS_HINT;
    json_add(analysis->remarks, json_pack("{s:b, s:s}", "hint", is_hint, "text", text));
    analysis->is_partial = analysis->is_partial || !is_hint;
    analysis->goes_back = analysis->goes_back || (kind == ANALYSIS_GOES_BACK);
}

void analysis_write(analysis_t *analysis) {
    json_t *messages = (analysis->traffic != NULL) ? traffic_messages_json(analysis->traffic) : NULL;
    if (analysis->files[ANALYSIS_REPORT].is_open) {
        write_report(analysis, messages);
    }
    if (analysis->files[ANALYSIS_WHY].is_open) {
        output_json(&analysis->files[ANALYSIS_WHY], make_why(analysis, json_incref(messages)),
                    JSON_INDENT(1) | JSON_REAL_PRECISION(DIGITS));
    }
    if (analysis->files[ANALYSIS_TRACE].is_open) {
        trace_end(&analysis->trace, analysis->last_us);
    }
    json_decref(messages);
}

bool analysis_flush(analysis_t *analysis) {
    return output_flush_all(analysis->files, ANALYSIS_FILES);
}

bool analysis_commit(analysis_t *analysis) {
    return output_commit_all(analysis->files, ANALYSIS_FILES);
}

const why_t *analysis_why(const analysis_t *analysis) {
    return analysis->why;
}

bool analysis_works(const analysis_t *analysis) {
    bool good = true;
    for (size_t i = 0; i < ANALYSIS_FILES; i++) {
        good = good && (analysis->files[i].error == 0);
    }
    return good;
}

void analysis_free(analysis_t *analysis) {
    if (analysis == NULL) {
        return;
    }
    for (size_t i = 0; i < ANALYSIS_FILES; i++) {
        output_discard(&analysis->files[i]);
    }
    why_free(analysis->why);
    traffic_free(analysis->traffic);
    series_free(analysis->series);
    json_decref(analysis->remarks);
    free(analysis);
}

#include "analysis/analysis.h"

#include <errno.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "common/report.h"
#include "report/report_page.h"
#include "report/series.h"

enum { NAME_SIZE = 32 };

struct analysis {
    analysis_request_t request;
    char names[HAL_CAN_SIDES][NAME_SIZE];
    uint64_t first_us; /**< time of day; 0: none */
    why_t *why;
    series_t *series; /**< NULL: no report was asked for */
    output_t files[ANALYSIS_FILES];
};

analysis_t *analysis_new(const analysis_request_t *request) {
    analysis_t *analysis = calloc(1u, sizeof *analysis);
    if (analysis != NULL) {
        analysis->request = *request;
        analysis->why = why_new(request->config);
        analysis->series = (request->paths[ANALYSIS_REPORT] != NULL) ? series_new(request->config) : NULL;
    }
    if ((analysis == NULL) || (analysis->why == NULL) ||
        ((request->paths[ANALYSIS_REPORT] != NULL) && (analysis->series == NULL))) {
        analysis_free(analysis);
        (void)report("out of memory");
        return NULL;
    }
    if (request->is_recording) {
        why_is_recording(analysis->why);
    }
    return analysis;
}

bool analysis_open(analysis_t *analysis) {
    for (size_t i = 0u; i < (size_t)ANALYSIS_FILES; i++) {
        const char *path = analysis->request.paths[i];
        if ((path != NULL) && !output_open(&analysis->files[i], path)) {
            return false;
        }
    }
    return true;
}

void analysis_name_side(analysis_t *analysis, hal_can_side_t side, const char *name, size_t length) {
    if (analysis->names[side][0] == '\0') {
        const size_t count = (length < (size_t)NAME_SIZE) ? length : (size_t)NAME_SIZE - 1u;
        memcpy(analysis->names[side], name, count);
    }
}

void analysis_set_clock(analysis_t *analysis, uint64_t first_us) {
    analysis->first_us = first_us;
}

void analysis_frame(analysis_t *analysis, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    why_frame(analysis->why, side, frame, t_us);
    if (analysis->series != NULL) {
        series_frame(analysis->series, side, frame, t_us);
    }
}

void analysis_sent(analysis_t *analysis, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    why_sent(analysis->why, side, frame, t_us);
    if (analysis->series != NULL) {
        series_sent(analysis->series, side, frame, t_us);
    }
}

void analysis_event(void *ctx, const session_event_t *event) {
    analysis_t *analysis = ctx;
    why_event(analysis->why, event);
    if (analysis->series != NULL) {
        series_event(analysis->series, event);
    }
}

/** The object of --why. */
static json_t *make_why(const analysis_t *analysis) {
    why_names_t names = {.log = analysis->request.log};
    for (int side = 0; side < (int)HAL_CAN_SIDES; side++) {
        names.interfaces[side] = (analysis->names[side][0] != '\0') ? analysis->names[side] : NULL;
    }
    return why_json(analysis->why, &names);
}

static void write_json(output_t *output, json_t *object) {
    char *text = (object != NULL) ? json_dumps(object, JSON_INDENT(1)) : NULL;
    if (text == NULL) {
        output->error = (output->error == 0) ? ENOMEM : output->error;
        return;
    }
    (void)output_write(output, text, strlen(text));
    (void)output_write(output, "\n", 1u);
    free(text);
}

/** The page of --report. */
static void write_report(analysis_t *analysis) {
    report_page_t page = {.name = analysis->request.log,
                          .clock_us = analysis->first_us,
                          .is_recording = analysis->request.is_recording,
                          .config = analysis->request.config};
    for (int side = 0; side < (int)HAL_CAN_SIDES; side++) {
        page.interfaces[side] = (analysis->names[side][0] != '\0') ? analysis->names[side] : NULL;
    }
    report_page_write(&analysis->files[ANALYSIS_REPORT], &page, analysis->why, analysis->series);
}

void analysis_end(analysis_t *analysis, uint64_t t_us) {
    why_end(analysis->why, t_us);
    if (analysis->files[ANALYSIS_WHY].is_open) {
        json_t *why = make_why(analysis);
        write_json(&analysis->files[ANALYSIS_WHY], why);
        json_decref(why);
    }
    if (analysis->series != NULL) {
        series_end(analysis->series, t_us);
        write_report(analysis);
    }
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

bool analysis_uses_stdout(const analysis_t *analysis) {
    for (size_t i = 0u; i < (size_t)ANALYSIS_FILES; i++) {
        if (output_is_stdout(analysis->request.paths[i])) {
            return true;
        }
    }
    return false;
}

void analysis_free(analysis_t *analysis) {
    if (analysis == NULL) {
        return;
    }
    for (size_t i = 0u; i < (size_t)ANALYSIS_FILES; i++) {
        output_discard(&analysis->files[i]);
    }
    why_free(analysis->why);
    series_free(analysis->series);
    free(analysis);
}

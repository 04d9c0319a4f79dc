#include "recorder/recorder_run.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "agv/state.h"
#include "common/interrupt.h"
#include "io/events.h"
#include "io/output.h"
#include "recorder/recorder_file.h"
#include "text/text.h"
#include "text/units.h"
#include "text/words.h"
#include "ui/timeline.h"
#include "ui/why_text.h"

/** The command as it runs. */
typedef struct {
    const recorder_request_t *request;
    recorder_events_t events;
    uint8_t run;
    size_t first; /**< of the run, among the events */
    size_t count; /**< of the run */
    uint64_t end_ms;
    analysis_t *analysis;
    timeline_t timeline;
    output_t lines; /**< of --events */
} work_t;

/** Whether an event is a trip, and not a start that continues the trip of the run before. */
static bool is_trip(const recorder_events_t *events, size_t i) {
    const agv_event_t *event = &events->events[i];
    const bool continues = (event->a == 0) && (i > 0) && (events->events[i - 1].first_reason == event->c);
    return (event->kind == AGV_EVENT_STATE) && (event->b == AGV_STATE_TRIPPED) && (event->c < AGV_FAULT_COUNT) &&
           !continues;
}

/** The run to tell of. @return false: there is none; was reported */
static bool choose_run(work_t *work) {
    const recorder_events_t *events = &work->events;
    bool found = false;
    work->run = events->events[events->count - 1].run;
    for (size_t i = 0; i < events->count; i++) {
        const agv_event_t *event = &events->events[i];
        if (work->request->run == RECORDER_RUN_NEWEST) {
            work->run = is_trip(events, i) ? event->run : work->run;
            found = true;
        } else if (event->run == (uint8_t)work->request->run) {
            work->run = event->run;
            found = true;
        } else {
            /* another run */
        }
    }
    return found ||
           report("--run: %s has no event of run %" PRIu64, report_input_name(work->request->path), work->request->run);
}

/** Run numbers wrap: the events of the last run with this number follow each other. */
static void find_run(work_t *work) {
    const recorder_events_t *events = &work->events;
    size_t end = events->count;
    while ((end > 0) && (events->events[end - 1].run != work->run)) {
        end--;
    }
    size_t first = end;
    while ((first > 0) && (events->events[first - 1].run == work->run)) {
        first--;
    }
    work->first = first;
    work->count = end - first;
}

/** "of run 0", "of runs 0, 1" */
static void print_runs(const work_t *work) {
    const recorder_events_t *events = &work->events;
    const bool is_one = events->events[0].run == events->events[events->count - 1].run;
    (void)printf(" of run%s", is_one ? "" : "s");
    for (size_t i = 0; i < events->count; i++) {
        if ((i == 0) || (events->events[i].run != events->events[i - 1].run)) {
            (void)printf("%s %u", (i == 0) ? "" : ",", events->events[i].run);
        }
    }
}

/** Version and configuration of the device, and whether the events are read with this configuration. */
static void print_device(const work_t *work) {
    static const char word[] = "configuration ";
    const char *named = strstr(work->events.device, word);
    const uint32_t checksum = agv_config_checksum(&work->request->config);
    if (work->events.device[0] != '\0') {
        (void)printf("device      %s\n", work->events.device);
    }
    if ((named != NULL) && (strtoul(&named[strlen(word)], NULL, 16) != checksum)) {
        (void)printf("            read with configuration %08" PRIx32 ": --config should name the device's own one\n",
                     checksum);
    }
}

static void print_head(const work_t *work) {
    const agv_event_t *first = &work->events.events[work->first];
    text_t name;
    (void)printf("%s: %zu event%s", text_one_line(&name, report_input_name(work->request->path)), work->events.count,
                 words_plural(work->events.count));
    if (work->events.damaged > 0) {
        (void)printf(" (%zu more %s damaged)", work->events.damaged, (work->events.damaged == 1) ? "is" : "are");
    }
    print_runs(work);
    (void)printf("\n");
    print_device(work);
    (void)printf("run %u       %zu event%s, %" PRIu32 ".%03" PRIu32 " s to %" PRIu64 ".%03" PRIu64
                 " s of its clock%s\n\n",
                 work->run, work->count, words_plural(work->count), first->time_ms / MS_PER_S,
                 first->time_ms % MS_PER_S, work->end_ms / MS_PER_S, work->end_ms % MS_PER_S,
                 ((first->kind == AGV_EVENT_STATE) && (first->a == 0)) ? "" : "; its start was overwritten");
}

/** Feed the events, at the times of the device's clock. */
static void feed(work_t *work, bool with_timeline) {
    uint32_t last_ms = work->events.events[work->first].time_ms;
    uint64_t t_ms = last_ms;
    for (size_t i = 0; i < work->count; i++) {
        const agv_event_t *event = &work->events.events[work->first + i];
        const uint32_t elapsed_ms = event->time_ms - last_ms;
        t_ms += (elapsed_ms < UINT32_MAX / 2) ? elapsed_ms : 0;
        last_ms = event->time_ms;
        const session_event_t told = {.t_ms = t_ms, .recorded = *event};
        if (with_timeline) {
            timeline_snapshot(&work->timeline, event);
            timeline_event(&work->timeline, &told);
            continue;
        }
        analysis_event(work->analysis, &told);
        if (work->lines.is_open) {
            events_write(&work->lines, &told);
        }
    }
    work->end_ms = t_ms;
}

static bool has_text(const recorder_request_t *request) {
    return !output_is_stdout(request->events) && !analysis_paths_use_stdout(&request->analysis);
}

static void print_text(work_t *work) {
    const why_text_t shown = {.why = analysis_why(work->analysis), .never = "never", .is_recorder = true};
    print_head(work);
    timeline_init_run(&work->timeline, &work->request->config);
    feed(work, true);
    (void)printf("\n");
    why_text_trips(&shown);
    why_text_faults(shown.why);
}

static bool analyse(work_t *work) {
    const recorder_request_t *request = work->request;
    const analysis_request_t analysed = {.config = &request->config,
                                         .log = report_input_name(request->path),
                                         .files = request->analysis,
                                         .is_recorder = true};
    work->analysis = analysis_new(&analysed);
    if ((work->analysis == NULL) || !analysis_open(work->analysis) ||
        ((request->events != NULL) && !output_open(&work->lines, request->events))) {
        return false;
    }
    feed(work, false);
    analysis_end(work->analysis, work->end_ms * US_PER_MS);
    analysis_write(work->analysis);
    return output_flush_all(&work->lines, 1) && analysis_commit(work->analysis) && output_commit(&work->lines);
}

status_t recorder_run(const recorder_request_t *request) {
    work_t *work = calloc(1, sizeof *work);
    if (work == NULL) {
        (void)report("out of memory");
        return STATUS_UNUSABLE;
    }
    work->request = request;
    bool good = recorder_file_read(request->path, &work->events) && choose_run(work);
    if (good) {
        find_run(work);
        good = analyse(work);
    }
    if (good && has_text(request)) {
        print_text(work);
    }
    output_discard(&work->lines);
    analysis_free(work->analysis);
    recorder_events_free(&work->events);
    free(work);
    interrupt_release();
    return good ? STATUS_OK : STATUS_UNUSABLE;
}

#include "live/live.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "analysis/analysis.h"
#include "common/interrupt.h"
#include "common/missing.h"
#include "config/config_text.h"
#include "hal_linux/linux_can.h"
#include "hal_linux/linux_loop.h"
#include "io/events.h"
#include "live/live_files.h"
#include "live/live_output.h"
#include "live/live_status.h"
#include "live/node.h"
#include "logs/sent_log.h"
#include "monitor/companion/monitor_companion.h"
#include "text/text.h"
#include "text/units.h"
#include "ui/summary.h"
#include "ui/why_text.h"

/** The files that are written. */
enum { OUT, EVENTS, OUTPUTS };

/** A run. Some 1 MiB: on the heap. */
typedef struct {
    const live_request_t *request;
    node_t *node;
    linux_loop_t loop;
    bool loop_is_open;
    live_files_t files;
    uint64_t opened_us;  /**< when the node was opened, by the time of day */
    bool tripped;        /**< at any time */
    uint16_t missing;    /**< AGV_MISSING_* bits: what INIT waited for last */
    bool stdout_is_free; /**< no output goes there */
    bool is_terminal;    /**< standard output is one, and free for the status line */
    live_status_t status;
    monitor_companion_t screen;
    live_output_t outputs[OUTPUTS];
    sent_log_t sent;
    analysis_t *analysis; /**< NULL: not asked for */
    uint64_t analysed_us; /**< time of the last frame: both sides have clocks of their own */
} live_t;

static void on_event(void *ctx, const session_event_t *event) {
    live_t *live = ctx;
    const bool is_state = !event->is_led && (event->recorded.kind == AGV_EVENT_STATE);
    live->tripped = live->tripped || (is_state && agv_state_is_latched((agv_state_t)event->recorded.b));
    if (!event->is_led && (event->recorded.kind == AGV_EVENT_STARTUP)) {
        live->missing = event->recorded.missing;
    }
    monitor_companion_event(&live->screen, event);
    if (live_output_has_room(&live->outputs[EVENTS])) {
        events_write(&live->outputs[EVENTS].lines, event);
    }
    if (live->analysis != NULL) {
        analysis_event(live->analysis, event);
    }
}

/** Times of frames never go back. */
static uint64_t analysed_us(live_t *live, uint64_t at_us) {
    live->analysed_us = (at_us > live->analysed_us) ? at_us : live->analysed_us;
    return live->analysed_us;
}

static void on_received(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t at_us) {
    live_t *live = ctx;
    if (live->analysis != NULL) {
        analysis_frame(live->analysis, side, frame, analysed_us(live, at_us));
    }
}

static void on_sent(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t at_us) {
    live_t *live = ctx;
    if (live_output_has_room(&live->outputs[OUT])) {
        sent_log_add(&live->sent, side, frame, live->opened_us + at_us);
    }
    if (live->analysis != NULL) {
        analysis_sent(live->analysis, side, frame, analysed_us(live, at_us));
    }
}

static bool open_outputs(live_t *live) {
    const live_request_t *request = live->request;
    const char *const paths[OUTPUTS] = {[OUT] = request->out, [EVENTS] = request->events};
    bool stdout_is_free = !analysis_paths_use_stdout(&request->analysis);
    for (size_t i = 0; i < OUTPUTS; i++) {
        if ((paths[i] != NULL) && !live_output_open(&live->outputs[i], paths[i])) {
            return false;
        }
        stdout_is_free = stdout_is_free && !output_is_stdout(paths[i]);
    }
    live->stdout_is_free = stdout_is_free;
    live->is_terminal = stdout_is_free && (live->screen.child == 0) && (isatty(STDOUT_FILENO) == 1);
    live->sent.output = &live->outputs[OUT].lines;
    for (int side = 0; side < HAL_CAN_SIDES; side++) {
        const char *interface = request->bus.interfaces[side];
        if (interface != NULL) {
            sent_log_heard(&live->sent, (hal_can_side_t)side, interface, strlen(interface));
        }
    }
    return true;
}

/** Start the screen, which is a process of its own: before anything is opened. @return false: reported */
static bool open_screen(live_t *live) {
    const live_request_t *request = live->request;
    const monitor_companion_config_t config = {
        .title = "run",
        .config = &request->config,
        .interfaces = {[HAL_CAN_VEHICLE] = request->bus.interfaces[HAL_CAN_VEHICLE],
                       [HAL_CAN_AI] = request->bus.interfaces[HAL_CAN_AI]},
        .has_supervisor = true,
    };
    const bool is_wanted = request->screen && !output_is_stdout(request->out) && !output_is_stdout(request->events) &&
                           !analysis_paths_use_stdout(&request->analysis);
    return !is_wanted || monitor_companion_fork(&live->screen, &config);
}

/** The files of the analysis, which are written at the end. @return false: reported */
static bool open_analysis(live_t *live) {
    const live_request_t *request = live->request;
    const analysis_request_t analysed = {
        .config = &request->config, .log = request->bus.interfaces[HAL_CAN_VEHICLE], .files = request->analysis};
    if (!analysis_paths_any(&request->analysis)) {
        return true;
    }
    live->analysis = analysis_new(&analysed);
    if ((live->analysis == NULL) || !analysis_open(live->analysis)) {
        return false;
    }
    for (int side = 0; side < HAL_CAN_SIDES; side++) {
        const char *name = request->bus.interfaces[side];
        if (name != NULL) {
            analysis_name_side(live->analysis, (hal_can_side_t)side, name, strlen(name));
        }
    }
    return true;
}

/** Everything that can fail comes before the supervisor starts. @return false: reported. */
static bool prepare(live_t *live) {
    const live_request_t *request = live->request;
    const node_config_t node = {
        .config = &request->config,
        .interfaces = {[HAL_CAN_VEHICLE] = request->bus.interfaces[HAL_CAN_VEHICLE],
                       [HAL_CAN_AI] = request->bus.interfaces[HAL_CAN_AI]},
        .on_event = on_event,
        .on_sent = on_sent,
        .on_received = on_received,
        .ctx = live,
    };
    char error[LINUX_LOOP_ERROR_SIZE];
    if (request->realtime && !linux_loop_realtime(error)) {
        return report("%s", error);
    }
    live->node = node_open(&node);
    if ((live->node == NULL) || !open_outputs(live) || !open_analysis(live)) {
        return false;
    }
    live->opened_us = time_of_day_us() - node_now_us(live->node);
    if (live->analysis != NULL) {
        analysis_set_clock(live->analysis, live->opened_us);
    }
    live->loop_is_open = linux_loop_open(&live->loop);
    if (!live->loop_is_open || !linux_loop_align(&live->loop, node_now_us(live->node))) {
        return report("cannot create the tick timer: %s", strerror(errno));
    }
    if (!live_files_follow(&live->files, &live->loop, live->node)) {
        return false;
    }
    config_note_deviations(&request->config);
    return live_output_begin(&live->outputs[OUT]) && live_output_begin(&live->outputs[EVENTS]);
}

/** Files and status line are written after the supervisor's step. */
static void write_out(live_t *live, uint64_t now_ms) {
    for (size_t i = 0; i < OUTPUTS; i++) {
        live_output_pass(&live->outputs[i]);
    }
    monitor_companion_tell(&live->screen, node_session(live->node), now_ms);
    if (live->is_terminal) {
        live_status_show(&live->status, node_session(live->node), now_ms);
    }
}

/** Run until a signal comes, or a tick at the end of the time or later. A signal ends it before another call of the core. */
static bool run(live_t *live) {
    const uint64_t end_ms =
        (live->request->bus.for_ms == INTERFACE_UNTIL_SIGNAL) ? UINT64_MAX : live->request->bus.for_ms;
    uint64_t now_ms = 0;
    bool good = true;
    bool is_over = false;
    monitor_companion_show(&live->screen);
    node_start(live->node);
    while (good && !is_over) {
        write_out(live, now_ms);
        const uint32_t what = linux_loop_wait(&live->loop);
        now_ms = node_now_us(live->node) / US_PER_MS;
        if (((what & LINUX_LOOP_SIGNAL) != 0) || interrupt_pending()) {
            break;
        }
        if ((what & LINUX_LOOP_TICK) == 0) {
            node_receive(live->node);
        } else if (node_tick(live->node)) {
            good = live_files_follow(&live->files, &live->loop, live->node);
        }
        is_over = ((what & LINUX_LOOP_TICK) != 0) && (now_ms >= end_ms);
    }
    return good;
}

static void print_not_supervised(const live_t *live) {
    static const char label[] = "NOT SUPERVISED: ";
    char words[MISSING_TEXT_SIZE];
    text_t text = {.used = 0};
    text_add(&text, "never left INIT");
    if (live->missing != 0) {
        text_add(&text, ", missing: %s", missing_text(live->missing, words));
    } else {
        text_add(&text, "; the run ended before startup_timeout_ms: --why names what was missing");
    }
    why_text_line(label, (int)strlen(label), text.bytes);
}

static void print_summary(const live_t *live, const events_summary_t *summary) {
    const char *ai = live->request->bus.interfaces[HAL_CAN_AI];
    char more[LINUX_CAN_NAME_MAX + sizeof ", "] = "";
    if (ai != NULL) {
        (void)snprintf(more, sizeof more, ", %s", ai);
    }
    summary_print_time(summary, live->request->bus.interfaces[HAL_CAN_VEHICLE], more);
    if (summary->supervised_ms == 0) {
        print_not_supervised(live);
    }
    summary_print_frames(summary, live->request->config.shadow == AGV_SHADOW_ON);
    (void)printf("warnings: %" PRIu32 "\n", summary->counters.warnings);
    summary_print_state(summary);
}

/** The supervisor has ended: write what comes last. @return false: reported. */
static bool conclude(live_t *live, const events_summary_t *summary) {
    const live_request_t *request = live->request;
    if (request->events != NULL) {
        events_write_summary(&live->outputs[EVENTS].lines, summary);
    }
    live_status_end(&live->status);
    bool good = true;
    for (size_t i = 0; i < OUTPUTS; i++) {
        good = live_output_end(&live->outputs[i]) && good;
    }
    if (live->analysis != NULL) {
        analysis_end(live->analysis, summary->t_ms * US_PER_MS);
        analysis_write(live->analysis);
        good = analysis_commit(live->analysis) && good;
    }
    if (good && live->stdout_is_free) {
        print_summary(live, summary);
    }
    return good;
}

/** The run from the first frame to the last. */
static status_t run_prepared(live_t *live) {
    events_summary_t summary;
    bool good = run(live);
    node_finish(live->node);
    events_summarise(node_session(live->node), &summary);
    node_close(live->node); /* nothing leaves from here on */
    live->node = NULL;
    monitor_companion_end(&live->screen);
    good = conclude(live, &summary) && good;
    if (!good) {
        return STATUS_UNUSABLE;
    }
    const bool is_met = !live->tripped && (summary.supervised_ms > 0);
    return (!is_met && live->request->fail_on_trip) ? STATUS_UNMET : STATUS_OK;
}

status_t live_run(const live_request_t *request) {
    live_t *live = calloc(1, sizeof *live);
    if (live == NULL) {
        (void)report("out of memory");
        return STATUS_UNUSABLE;
    }
    live->request = request;
    live_files_none(&live->files);
    const status_t status = (open_screen(live) && prepare(live)) ? run_prepared(live) : STATUS_UNUSABLE;
    monitor_companion_end(&live->screen);
    node_close(live->node);
    if (live->loop_is_open) {
        linux_loop_close(&live->loop);
    }
    for (size_t i = 0; i < OUTPUTS; i++) {
        output_discard(&live->outputs[i].lines);
    }
    if (live->analysis != NULL) {
        analysis_free(live->analysis);
        interrupt_release();
    }
    free(live);
    return status;
}

#include "monitor/inputs/monitor_run.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/interrupt.h"
#include "config/config_text.h"
#include "logs/log_sides.h"
#include "monitor/inputs/monitor_can.h"
#include "monitor/inputs/monitor_file.h"
#include "monitor/inputs/monitor_record.h"
#include "monitor/monitor_lines.h"
#include "monitor/monitor_screen.h"
#include "monitor/monitor_ui.h"
#include "text/units.h"

#define SPEED_MAX 1024.0
#define SPEED_MIN (1.0 / 64.0)

/** A run. Some 1 MiB: on the heap. */
typedef struct {
    const monitor_request_t *request;
    monitor_t *monitor;
    bool has_screen;
    bool failed;
    double speed;
    double log_us;      /* how far the log has come */
    uint64_t passed_ms; /* time of the last pass */
    monitor_can_t bus;
    monitor_file_t file;
    monitor_record_t record;
    monitor_ui_t ui;
} run_t;

static bool begin_record(run_t *run, const char *path) {
    if (!monitor_record_begin(&run->record, path)) {
        return (errno == EEXIST) ? report("%s: exists already, and is not replaced", run->record.name)
                                 : report("%s: %s", run->record.name, strerror(errno));
    }
    return true;
}

static bool is_recording(const run_t *run) {
    return run->record.fd >= 0;
}

static void toggle_recording(run_t *run) {
    if (is_recording(run)) {
        run->failed = !monitor_record_close(&run->record) || run->failed;
    } else if (!monitor_record_begin(&run->record, NULL)) {
        monitor_note(run->monitor, MONITOR_WARN, "record", strerror(errno));
    }
    run->ui.page.recording = is_recording(run) ? run->record.name : NULL;
}

/** Pass on what has come. @return false: the log has ended */
static bool pass(run_t *run, uint64_t now_ms) {
    const uint64_t since_ms = now_ms - run->passed_ms;
    run->passed_ms = now_ms;
    if (run->request->log == NULL) {
        monitor_can_pass(&run->bus, run->monitor, &run->record);
        if (is_recording(run) && !monitor_record_flush(&run->record)) {
            run->failed = true;
            (void)monitor_record_close(&run->record);
            run->ui.page.recording = NULL;
        }
        return true;
    }
    if (run->has_screen && monitor_ui_is_paused(&run->ui)) {
        return true;
    }
    run->log_us += (double)(since_ms * (uint64_t)US_PER_MS) * run->speed;
    const bool at_once = run->speed <= MONITOR_SPEED_ANY;
    return monitor_file_pass(&run->file, run->monitor, at_once ? MONITOR_FILE_ALL : (uint64_t)run->log_us);
}

static void obey(run_t *run) {
    monitor_wish_t *wish = &run->ui.wish;
    if (wish->toggles_recording) {
        wish->toggles_recording = false;
        toggle_recording(run);
    }
    for (; wish->faster > 0; wish->faster--) {
        run->speed = (run->speed * 2.0 <= SPEED_MAX) ? run->speed * 2.0 : run->speed;
    }
    for (; wish->faster < 0; wish->faster++) {
        run->speed = (run->speed / 2.0 >= SPEED_MIN) ? run->speed / 2.0 : run->speed;
    }
    run->ui.page.speed = run->speed;
}

/** One round. @return false: that was the last one */
static bool go_round(run_t *run, uint64_t begin_ms) {
    const uint64_t now_ms = monotonic_ms() - begin_ms;
    const uint64_t for_ms = run->request->bus.for_ms;
    const bool goes_on = pass(run, now_ms);
    if (!run->has_screen) {
        return monitor_lines_flush() && goes_on && ((for_ms == INTERFACE_UNTIL_SIGNAL) || (now_ms < for_ms));
    }
    run->ui.page.has_ended = !goes_on;
    monitor_ui_keys(&run->ui);
    obey(run);
    monitor_ui_draw(&run->ui, now_ms);
    return !run->ui.wish.quits && !run->file.failed && ((for_ms == INTERFACE_UNTIL_SIGNAL) || (now_ms < for_ms));
}

static void go(run_t *run) {
    const uint64_t begin_ms = monotonic_ms();
    bool goes_on = true;
    while (goes_on && !interrupt_pending()) {
        goes_on = go_round(run, begin_ms);
        const bool at_once = (run->request->log != NULL) && !run->has_screen && (run->speed <= MONITOR_SPEED_ANY);
        if (goes_on && !at_once) {
            goes_on = monitor_ui_wait(NULL, 0, run->has_screen);
        }
    }
}

static bool open_input(run_t *run) {
    const monitor_request_t *request = run->request;
    if (request->log != NULL) {
        return monitor_file_open(&run->file, request->log, request->ai_interface, request->skip_bad_lines);
    }
    return monitor_can_open(&run->bus, request->bus.interfaces);
}

static bool make_monitor(run_t *run) {
    const monitor_request_t *request = run->request;
    const bool is_log = request->log != NULL;
    const monitor_config_t config = {
        .config = &request->config,
        .interfaces = {[HAL_CAN_VEHICLE] = is_log ? run->file.interface : request->bus.interfaces[HAL_CAN_VEHICLE],
                       [HAL_CAN_AI] = is_log ? request->ai_interface : request->bus.interfaces[HAL_CAN_AI]},
        .is_gateway = request->config.topology == AGV_TOPOLOGY_GATEWAY,
        .shadow = request->shadow,
        .on_entry = run->has_screen ? NULL : monitor_lines_print,
    };
    run->monitor = monitor_new(&config);
    return run->monitor != NULL;
}

static bool open_screen(run_t *run) {
    const monitor_request_t *request = run->request;
    const monitor_page_t page = {
        .title = "monitor",
        .input = (request->log != NULL) ? run->file.log.name : NULL,
        .is_log = request->log != NULL,
        .speed = run->speed,
        .recording = is_recording(run) ? run->record.name : NULL,
    };
    return !run->has_screen || monitor_ui_open(&run->ui, run->monitor, &page);
}

static bool run_all(run_t *run) {
    if (!open_input(run)) { /* may wait for a writer: a signal ends the program there */
        return false;
    }
    interrupt_hold();
    if (!make_monitor(run) || ((run->request->record != NULL) && !begin_record(run, run->request->record))) {
        return false;
    }
    config_note_deviations(&run->request->config); /* before the screen, which would be drawn over it */
    if (!open_screen(run)) {
        return false;
    }
    go(run);
    if (run->has_screen) {
        monitor_ui_close(&run->ui);
    }
    run->failed = !monitor_record_close(&run->record) || run->failed;
    if (run->request->log != NULL) {
        monitor_file_remark(&run->file);
    }
    if ((run->request->log != NULL) && run->file.is_read &&
        !log_sides_check_heard(run->request->ai_interface, run->file.ai_was_heard, run->file.interface)) {
        return false;
    }
    return !run->failed && !run->file.failed;
}

status_t monitor_run(const monitor_request_t *request) {
    run_t *run = calloc(1, sizeof *run);
    if (run == NULL) {
        (void)report("out of memory");
        return STATUS_UNUSABLE;
    }
    run->request = request;
    run->speed = request->speed;
    run->has_screen = monitor_screen_possible();
    monitor_record_init(&run->record);
    const bool good = run_all(run);
    monitor_can_close(&run->bus);
    if (request->log != NULL) {
        monitor_file_close(&run->file);
    }
    monitor_free(run->monitor);
    free(run);
    return good ? STATUS_OK : STATUS_UNUSABLE;
}

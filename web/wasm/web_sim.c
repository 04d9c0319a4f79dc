/* The run: create, configure, step, inject, and what one looks at in every picture. */
#include "web_sim.h"

#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "common/report.h"
#include "config/config_file.h"
#include "io/events.h"
#include "io/yaml_file.h"
#include "memory_output.h"
#include "scenario/parse/scenario_parse.h"
#include "scenario/run/scenario_analysis.h"
#include "text/units.h"
#include "web_run.h"

enum { SETTINGS_NOT_GIVEN = -1, NAME_SIZE = 120 };

static web_run_t web;
static char run_name[NAME_SIZE];

const web_run_t *web_run(void) {
    return &web;
}

void *web_alloc(size_t size) {
    return malloc(size);
}

void web_free(void *memory) {
    free(memory);
}

/* --- create and configure --- */

/** The settings of the page. */
typedef struct {
    agv_config_t config;
    config_lines_t lines;
} settings_t;

static bool read_settings(settings_t *settings, const char *text) {
    yaml_document_t document;
    (void)memset(settings, 0, sizeof *settings);
    settings->lines.path = "settings";
    agv_config_defaults(&settings->config);
    if (text[0] == '\0') {
        return true;
    }
    if (!yaml_text_load(settings->lines.path, text, &document)) {
        return false;
    }
    const yaml_node_t *root = yaml_document_get_root_node(&document);
    const bool good = (root == NULL) || config_read_mapping(&document, root, &settings->config, &settings->lines);
    yaml_document_delete(&document);
    return good;
}

static int given(const settings_t *settings, uint16_t setting) {
    return (settings->lines.settings[setting] != 0u) ? (int)agv_config_get(&settings->config, setting)
                                                     : SETTINGS_NOT_GIVEN;
}

/** What the page sets counts more than what the file sets. */
static void lay_over(agv_config_t *config, const settings_t *settings) {
    for (uint16_t i = 0u; i < (uint16_t)AGV_SETTING_COUNT; i++) {
        if (settings->lines.settings[i] != 0u) {
            (void)agv_config_set(config, i, agv_config_get(&settings->config, i));
        }
    }
    for (uint32_t i = 0u; i < (uint32_t)AGV_FAULT_COUNT; i++) {
        if (settings->lines.classes[i] != 0u) {
            agv_fault_set_put(&config->trips, i, agv_config_is_trip(&settings->config, i));
        }
    }
}

static bool read_scenario(scenario_t *scenario, const char *name, const char *text, const settings_t *settings) {
    const scenario_options_t options = {.config = settings->config,
                                        .topology = given(settings, AGV_SETTING_topology),
                                        .id_set = given(settings, AGV_SETTING_id_set)};
    if (!scenario_read_text(scenario, name, text, &options)) {
        return false;
    }
    const bool vehicle_has_ids = memcmp(&scenario->vehicle.ids, &scenario->ids, sizeof scenario->ids) != 0;
    lay_over(&scenario->config, settings);
    agv_config_ids(&scenario->config, &scenario->ids);
    if (!vehicle_has_ids) {
        scenario->vehicle.ids = scenario->ids;
    }
    return scenario->config_unchecked || config_check(&scenario->config, &settings->lines);
}

static void on_event(void *ctx, const session_event_t *event) {
    (void)ctx;
    web.event_count++;
    events_write(&web.events, event);
}

static void on_frame(void *ctx, uint64_t t_us, hal_can_side_t side, int from, const hal_can_frame_t *frame) {
    (void)ctx;
    const bool may_be = ((frame->flags & HAL_CAN_EXTENDED) == 0u) && (frame->id <= AGV_ID_MAX);
    const agv_message_t message = may_be ? scenario_testbed_message(&web.run.testbed, frame->id) : AGV_MSG_NONE;
    web_bus_frame(&web.bus, message, t_us, side, from, frame);
}

static bool open_report(void) {
    const analysis_request_t request = {
        .config = &web.run.scenario.config, .log = run_name, .files = {.paths = {[ANALYSIS_REPORT] = WEB_REPORT}}};
    web.analysis = analysis_new(&request);
    return (web.analysis != NULL) && analysis_open(web.analysis);
}

static bool begin(void) {
    scenario_watch_t watches[2] = {{.on_event = on_event, .on_frame = on_frame}};
    size_t count = 1u;
    if (web.analysis != NULL) {
        watches[count] = scenario_analysis_watch(web.analysis);
        count++;
    }
    web_bus_init(&web.bus, &web.run.scenario.config, web.run.scenario.bitrate);
    return output_open(&web.events, WEB_EVENTS) && scenario_run_start(&web.run, watches, count, NULL);
}

int32_t web_create(const char *name, const char *scenario, const char *settings_text, int32_t with_report) {
    static settings_t settings;
    analysis_free(web.analysis);
    output_discard(&web.events);
    (void)memset(&web, 0, sizeof web);
    (void)strncpy(run_name, name, sizeof run_name - 1u);
    web.is_there = read_settings(&settings, settings_text) &&
                   read_scenario(&web.run.scenario, run_name, scenario, &settings) &&
                   ((with_report == 0) || open_report()) && begin();
    return web.is_there ? 1 : 0;
}

/* --- inject --- */

/** Put a step behind all that are due at its time or before. */
static bool insert(const scenario_step_t *step) {
    if (web.injected_count == WEB_STEPS_MAX) {
        return report("more than %u steps", WEB_STEPS_MAX);
    }
    size_t at = web.injected_count;
    for (; (at > 0u) && (web.injected[at - 1u].at_ms > step->at_ms); at--) {
        web.injected[at] = web.injected[at - 1u];
    }
    web.injected[at] = *step;
    web.injected_count++;
    return true;
}

static bool check_time(const scenario_step_t *step) {
    if (web.has_ended || (step->at_ms < web.next_ms)) {
        return report("%u ms has passed", (unsigned)step->at_ms);
    }
    return (step->again_every_ms == 0u) || report("again_every_ms is for scenario files");
}

int32_t web_inject(const char *text) {
    yaml_document_t document;
    scenario_step_t step;
    scenario_t *scenario = &web.run.scenario;
    if (!web.is_there) {
        (void)report("there is no run");
        return 0;
    }
    if (!yaml_text_load("step", text, &document)) {
        return 0;
    }
    const yaml_reader_t reader = {.file = "step", .document = &document};
    const yaml_node_t *root = yaml_document_get_root_node(&document);
    const bool good = ((root != NULL) || report("a step is missing")) &&
                      scenario_parse_step(&reader, root, &scenario->config, &step) &&
                      scenario_parse_board_fits(&reader, root, scenario, &step) && check_time(&step) && insert(&step);
    yaml_document_delete(&document);
    return good ? 1 : 0;
}

/* --- step --- */

static void write_summary(void) {
    events_summary_t summary;
    events_summarise(scenario_testbed_session(&web.run.testbed), &summary);
    events_write_summary(&web.events, &summary);
    web.event_count++;
}

static void finish(void) {
    (void)scenario_run_end(&web.run);
    write_summary();
    web.has_ended = true;
}

static void do_injected(void) {
    while ((web.next_injected < web.injected_count) && (web.injected[web.next_injected].at_ms <= web.next_ms)) {
        scenario_run_do(&web.run, web.next_ms, &web.injected[web.next_injected]);
        web.next_injected++;
    }
}

uint32_t web_step(uint32_t ms) {
    uint32_t played = 0u;
    while (web.is_there && !web.has_ended && (played < ms)) {
        do_injected();
        (void)scenario_run_ms(&web.run, web.next_ms);
        played++;
        if (web.next_ms == web.run.scenario.duration_ms) {
            finish();
        }
        web.next_ms++;
    }
    return played;
}

/* --- read --- */

static int32_t state_index(agv_state_t state) {
    static const agv_state_t states[] = {AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_STATE_ACTIVE, AGV_STATE_TRIPPED,
                                         AGV_STATE_SAFE};
    for (int32_t i = 0; i < (int32_t)(sizeof states / sizeof states[0]); i++) {
        if (states[i] == state) {
            return i;
        }
    }
    return WEB_NONE;
}

static void view_supervisor(web_view_t *view) {
    const agv_supervisor_t *supervisor = &scenario_testbed_session(&web.run.testbed)->supervisor;
    const agv_fault_t reason = agv_supervisor_first_reason(supervisor);
    const hal_t *port = scenario_testbed_port(&web.run.testbed);
    scenario_testbed_view_t seen;
    scenario_testbed_view(&web.run.testbed, &seen);
    view->state = state_index(agv_supervisor_state(supervisor));
    view->reason = (reason != AGV_FAULT_NONE) ? (int32_t)reason : WEB_NONE;
    view->is_halted = seen.is_halted ? 1 : 0;
    view->output_closed = seen.output_closed ? 1 : 0;
    view->contact_closed = port->contact_closed ? 1 : 0;
    view->stop_open = port->board.stop_is_open ? 1 : 0;
    view->led_on = port->led.on ? 1 : 0;
    view->led_code = (int32_t)agv_supervisor_led_code(supervisor);
    view->button_1 = seen.vehicle.button_1 ? 1 : 0;
}

static void view_vehicle(web_view_t *view) {
    vehicle_view_t vehicle;
    scenario_testbed_vehicle(&web.run.testbed, &vehicle);
    view->gear = vehicle.gear;
    view->autopilot = vehicle.autopilot ? 1 : 0;
    view->speed_mm_s = vehicle.speed_mm_s;
    view->throttle_permille = vehicle.throttle_permille;
    view->eps_mode = vehicle.eps_mode;
    view->angle_ddeg = vehicle.angle_ddeg;
    view->alarms = vehicle.alarms;
    for (int node = 0; node < (int)VEHICLE_NODES; node++) {
        view->running[node] = vehicle.running[node] ? 1 : 0;
    }
}

const web_view_t *web_view(void) {
    static web_view_t view;
    (void)memset(&view, 0, sizeof view);
    view.t_ms = (int32_t)web.next_ms - 1;
    if (web.is_there) {
        view.duration_ms = (int32_t)web.run.scenario.duration_ms;
        view.has_ended = web.has_ended ? 1 : 0;
        view.event_count = web.event_count;
        view.failure_count = (int32_t)web.run.check.failure_count;
        view_supervisor(&view);
        view_vehicle(&view);
        web_bus_view(&web.bus, (uint64_t)web.next_ms * (uint64_t)US_PER_MS, &view);
    }
    return &view;
}

const char *web_events(void) {
    static char *lines;
    const char *text = memory_output_text(WEB_EVENTS);
    free(lines);
    lines = strdup((text != NULL) ? text : "");
    (void)output_open(&web.events, WEB_EVENTS);
    return lines;
}

const char *web_report(void) {
    if (!web.is_there || (web.analysis == NULL)) {
        return NULL;
    }
    analysis_end(web.analysis, scenario_testbed_session(&web.run.testbed)->t_ms * (uint64_t)US_PER_MS);
    analysis_write(web.analysis);
    web.is_there = false;
    return memory_output_text(WEB_REPORT);
}

#include "session/session.h"

#include <string.h>

enum { COMPARE_EVERY_MS = 100, TELL_AFTER_MS = 1000 };

static const agv_version_t version = {
    .major = HOST_SIM_VERSION_MAJOR, .minor = HOST_SIM_VERSION_MINOR, .patch = HOST_SIM_VERSION_PATCH};

void session_init(session_t *session, hal_t *hal) {
    (void)memset(session, 0, sizeof *session);
    session->ports.hal = hal;
    session->ports.recorder = &session->recorder;
    session->ports.version = &version;
}

bool session_observe(session_t *session, session_observer_fn *fn, void *ctx) {
    bool fits = session->observer_count < SESSION_OBSERVERS_MAX;
    if (fits) {
        session->observers[session->observer_count].fn = fn;
        session->observers[session->observer_count].ctx = ctx;
        session->observer_count++;
    }
    return fits;
}

static void notify(const session_t *session, const session_event_t *event) {
    for (size_t i = 0u; i < session->observer_count; i++) {
        session->observers[i].fn(session->observers[i].ctx, event);
    }
}

static void notify_output(const session_t *session, bool closed) {
    const session_event_t event = {.t_ms = session->t_ms,
                                   .recorded = {.kind = AGV_EVENT_OUTPUT, .a = closed ? 1u : 0u}};
    notify(session, &event);
}

static void notify_led(session_t *session) {
    session->led_code = agv_supervisor_led_code(&session->supervisor);
    const session_event_t event = {.t_ms = session->t_ms, .is_led = true, .led_code = session->led_code};
    notify(session, &event);
}

static void note_fault(session_t *session, const agv_event_t *recorded) {
    if ((recorded->kind == (uint8_t)AGV_EVENT_FAULT) && (recorded->a < (uint8_t)AGV_FAULT_COUNT)) {
        session->faults[recorded->a] =
            (session_fault_t){.t_ms = session->t_ms, .is_active = recorded->c != 0u, .fault_class = recorded->b};
    }
}

/** The event of a fault that the recorder left out. */
static void notify_left_out(session_t *session, uint32_t fault, bool is_active) {
    const agv_supervisor_t *supervisor = &session->supervisor;
    const agv_fault_set_t trips = agv_supervisor_active_trips(supervisor);
    const uint32_t now = agv_fault_is_in(&trips, fault) ? AGV_CLASS_TRIP : AGV_CLASS_WARN;
    const session_event_t event = {.t_ms = session->t_ms,
                                   .recorded = {.kind = AGV_EVENT_FAULT,
                                                .a = (uint8_t)fault,
                                                .b = is_active ? (uint8_t)now : session->faults[fault].fault_class,
                                                .c = is_active ? 1u : 0u,
                                                .state = (uint8_t)agv_supervisor_state(supervisor),
                                                .first_reason = (uint8_t)agv_supervisor_first_reason(supervisor)}};
    note_fault(session, &event.recorded);
    notify(session, &event);
}

static void tell_left_out(session_t *session, uint64_t after_ms) {
    const agv_fault_set_t active = agv_supervisor_active_faults(&session->supervisor);
    for (uint32_t fault = 0u; fault < (uint32_t)AGV_FAULT_COUNT; fault++) {
        const session_fault_t *told = &session->faults[fault];
        const bool is_active = agv_fault_is_in(&active, fault);
        if ((session->recorder.rates[fault].left_out != 0u) && (is_active != told->is_active) &&
            (session->t_ms - told->t_ms >= after_ms)) {
            notify_left_out(session, fault, is_active);
        }
    }
}

static void notify_recorded(session_t *session, bool with_output) {
    uint32_t end = agv_recorder_next_sequence(&session->recorder);
    for (; session->next != end; session->next++) {
        session_event_t event = {.t_ms = session->t_ms, .is_led = false};
        if (agv_recorder_get(&session->recorder, session->next, &event.recorded) &&
            (with_output || (event.recorded.kind != (uint8_t)AGV_EVENT_OUTPUT))) {
            note_fault(session, &event.recorded);
            notify(session, &event);
        }
    }
}

static inline bool has_news(const session_t *session) {
    return agv_recorder_next_sequence(&session->recorder) != session->next;
}

/** Find the first event of the run that has just begun: its events carry the same run number as the newest one. */
static uint32_t first_of_run(const agv_recorder_t *recorder) {
    uint32_t end = agv_recorder_next_sequence(recorder);
    uint32_t first = end;
    agv_event_t newest;
    agv_event_t event;
    if (agv_recorder_get(recorder, end - 1u, &newest)) {
        while ((end - first < AGV_RECORDER_EVENTS) && agv_recorder_get(recorder, first - 1u, &event) &&
               (event.run == newest.run)) {
            first--;
        }
    }
    return first;
}

void session_start(session_t *session, const agv_config_t *config, uint64_t t_ms, uint32_t clock_ms) {
    session->t_ms = t_ms;
    session->ticked_ms = t_ms;
    agv_supervisor_start(&session->supervisor, &session->ports, config, clock_ms);
    session->next = first_of_run(&session->recorder);
    (void)memset(session->faults, 0, sizeof session->faults);
    notify_recorded(session, false);
    notify_output(session, agv_supervisor_output_closed(&session->supervisor));
    notify_led(session);
}

void session_frame(session_t *session, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_ms) {
    session->t_ms = t_ms;
    agv_supervisor_frame(&session->supervisor, &session->ports, side, frame);
    if (has_news(session)) {
        notify_recorded(session, true);
    }
}

void session_tick_behind(session_t *session, uint64_t t_ms, uint32_t clock_ms) {
    if (agv_supervisor_state(&session->supervisor) != AGV_STATE_INIT) {
        session->supervised_ms += t_ms - session->ticked_ms;
    }
    session->ticked_ms = t_ms;
    session->t_ms = t_ms;
    agv_supervisor_tick(&session->supervisor, &session->ports, clock_ms);
    if (has_news(session)) {
        notify_recorded(session, true);
    }
    if (agv_supervisor_led_code(&session->supervisor) != session->led_code) {
        notify_led(session); /* a fault in a frame changes it in the next tick */
    }
    if ((t_ms % COMPARE_EVERY_MS) == 0u) {
        tell_left_out(session, TELL_AFTER_MS);
    }
}

void session_tick(session_t *session, uint64_t t_ms, uint32_t clock_ms) {
    agv_supervisor_receive_alive(&session->supervisor);
    session_tick_behind(session, t_ms, clock_ms);
}

void session_end(session_t *session) {
    tell_left_out(session, 0u);
}

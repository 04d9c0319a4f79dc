#include "session/session.h"

#include <string.h>

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
    for (size_t i = 0; i < session->observer_count; i++) {
        session->observers[i].fn(session->observers[i].ctx, event);
    }
}

static void notify_output(const session_t *session, bool closed) {
    const session_event_t event = {.t_ms = session->t_ms, .recorded = {.kind = AGV_EVENT_OUTPUT, .a = closed ? 1 : 0}};
    notify(session, &event);
}

static void notify_led(session_t *session) {
    session->led_code = agv_supervisor_led_code(&session->supervisor);
    const session_event_t event = {.t_ms = session->t_ms, .is_led = true, .led_code = session->led_code};
    notify(session, &event);
}

/** The event of a fault that the recorder left out. */
static void notify_left_out(const session_t *session, uint32_t fault, bool is_active, bool is_trip) {
    const agv_supervisor_t *supervisor = &session->supervisor;
    const session_event_t event = {.t_ms = session->t_ms,
                                   .is_left_out = true,
                                   .recorded = {.kind = AGV_EVENT_FAULT,
                                                .a = (uint8_t)fault,
                                                .b = (uint8_t)(is_trip ? AGV_CLASS_TRIP : AGV_CLASS_WARN),
                                                .c = is_active ? 1 : 0,
                                                .state = (uint8_t)agv_supervisor_state(supervisor),
                                                .first_reason = (uint8_t)agv_supervisor_first_reason(supervisor)}};
    notify(session, &event);
}

static inline bool is_same(const agv_fault_set_t *a, const agv_fault_set_t *b) {
    return memcmp(a, b, sizeof *a) == 0;
}

/** The recorder keeps at most 4 events of a fault in a second, and counts the others. */
static void tell_left_out(session_t *session) {
    session_faults_t *before = &session->faults;
    const agv_fault_set_t active = agv_supervisor_active_faults(&session->supervisor);
    const agv_fault_set_t trips = agv_supervisor_active_trips(&session->supervisor);
    if (is_same(&active, &before->active) && is_same(&trips, &before->trips)) {
        return;
    }
    for (uint32_t fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        const uint16_t left_out = session->recorder.rates[fault].left_out;
        if ((left_out != 0) && (left_out != before->left_out[fault])) {
            const bool is_active = agv_fault_is_in(&active, fault);
            notify_left_out(session, fault, is_active, agv_fault_is_in(is_active ? &trips : &before->trips, fault));
        }
        before->left_out[fault] = left_out;
    }
    before->active = active;
    before->trips = trips;
}

static void notify_recorded(session_t *session, bool with_output) {
    uint32_t end = agv_recorder_next_sequence(&session->recorder);
    for (; session->next != end; session->next++) {
        session_event_t event = {.t_ms = session->t_ms, .stopped_ms = session->stopped_ms};
        if (agv_recorder_get(&session->recorder, session->next, &event.recorded) &&
            (with_output || (event.recorded.kind != AGV_EVENT_OUTPUT))) {
            notify(session, &event);
        }
    }
}

/** Tell what a call of the supervisor has changed. A fault that was left out comes before what follows from it. */
static void tell_news(session_t *session) {
    tell_left_out(session);
    if (agv_recorder_next_sequence(&session->recorder) != session->next) {
        notify_recorded(session, true);
    }
}

/** Find the first event of the run that has just begun: its events carry the same run number as the newest one. */
static uint32_t first_of_run(const agv_recorder_t *recorder) {
    uint32_t end = agv_recorder_next_sequence(recorder);
    uint32_t first = end;
    agv_event_t newest;
    agv_event_t event;
    if (agv_recorder_get(recorder, end - 1, &newest)) {
        while ((end - first < AGV_RECORDER_EVENTS) && agv_recorder_get(recorder, first - 1, &event) &&
               (event.run == newest.run)) {
            first--;
        }
    }
    return first;
}

/** A call begins: up to here the state was as it is. */
static void advance(session_t *session, uint64_t t_ms) {
    const bool supervised = agv_supervisor_state(&session->supervisor) != AGV_STATE_INIT;
    if (t_ms > session->counted_ms) {
        session->supervised_ms += supervised ? (t_ms - session->counted_ms) : 0;
        session->counted_ms = t_ms;
    }
    session->t_ms = t_ms;
}

agv_counters_t session_counters(const session_t *session) {
    const agv_counters_t *last = agv_supervisor_counters(&session->supervisor);
    agv_counters_t sum = session->before;
    for (size_t i = 0; i < AGV_REJECTED_KINDS; i++) {
        sum.rejected[i] += last->rejected[i];
    }
    sum.received += last->received;
    sum.dropped += last->dropped;
    sum.sent += last->sent;
    sum.shadowed += last->shadowed;
    sum.gate_refused += last->gate_refused;
    sum.skipped_slots += last->skipped_slots;
    sum.limited += last->limited;
    sum.warnings += last->warnings;
    return sum;
}

void session_stop(session_t *session, uint64_t t_ms) {
    if (session->runs) {
        advance(session, t_ms);
        session->stopped_ms = t_ms;
        session->runs = false;
    }
}

void session_start(session_t *session, const agv_config_t *config, uint64_t t_ms, uint32_t clock_ms) {
    session_stop(session, t_ms);
    session->before = session_counters(session);
    session->runs = true;
    session->t_ms = t_ms;
    session->counted_ms = t_ms;
    agv_supervisor_start(&session->supervisor, &session->ports, config, clock_ms);
    session->next = first_of_run(&session->recorder);
    (void)memset(&session->faults, 0, sizeof session->faults);
    notify_recorded(session, false);
    notify_output(session, agv_supervisor_output_closed(&session->supervisor));
    notify_led(session);
}

void session_frame(session_t *session, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_ms) {
    advance(session, t_ms);
    agv_supervisor_frame(&session->supervisor, &session->ports, side, frame);
    tell_news(session);
}

void session_tick_behind(session_t *session, uint64_t t_ms, uint32_t clock_ms) {
    advance(session, t_ms);
    agv_supervisor_tick(&session->supervisor, &session->ports, clock_ms);
    tell_news(session);
    if (agv_supervisor_led_code(&session->supervisor) != session->led_code) {
        notify_led(session); /* a fault in a frame changes it in the next tick */
    }
}

void session_tick(session_t *session, uint64_t t_ms, uint32_t clock_ms) {
    agv_supervisor_receive_alive(&session->supervisor);
    session_tick_behind(session, t_ms, clock_ms);
}

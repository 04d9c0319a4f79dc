/* Expectations of a counterexample's scenario file: what was observed before, and what the broken rule demands. */
#include <string.h>

#include "agv/names.h"
#include "agv/recorder.h"
#include "model.h"
#include "trace.h"

enum { EVENTS_MAX = 400, MISSING_BITS = 10 };

typedef struct {
    uint32_t t_ms;
    agv_event_t event;
} seen_t;

typedef struct {
    uint32_t t_ms;
    bool closed;
} output_t;

static seen_t seen[EVENTS_MAX];
static unsigned seen_count;
static output_t outputs[EVENTS_MAX];
static unsigned output_count;
static uint32_t next_sequence;
static uint32_t broken_ms;
static bool is_broken;

/* Observations of the last millisecond that the broken rule forbids. */
static bool drops_events; /* events */
static bool drops_output;

static bool rule_begins_with(const char *beginning) {
    return strncmp(model_broken(), beginning, strlen(beginning)) == 0;
}

/* ---- Observations ---- */

static bool output_was_closed(void) {
    return (output_count > 0u) && outputs[output_count - 1u].closed;
}

/* A missing trip, although the supervisor was tripped until a reset in this call. */
static bool latch_was_released(void) {
    uint8_t state = 0;
    for (unsigned i = 0; i < seen_count; i++) {
        state = (seen[i].event.kind == (uint8_t)AGV_EVENT_STATE) ? seen[i].event.b : state;
    }
    return rule_begins_with("SUP-") && agv_state_is_latched((agv_state_t)state);
}

static void judge(uint32_t t_ms) {
    is_broken = model_broken()[0] != '\0';
    broken_ms = t_ms;
    drops_events = is_broken && (latch_was_released() || rule_begins_with("FSM-3") || rule_begins_with("FSM-7") ||
                                 rule_begins_with("INT-5") || rule_begins_with("back to INIT") ||
                                 (rule_begins_with("FSM-5") && !rule_begins_with("FSM-5: the first reason was")));
    drops_output = is_broken && (drops_events || rule_begins_with("FSM-4: the safety output has closed") ||
                                 rule_begins_with("FSM-4: the safety output is closed in INIT") ||
                                 rule_begins_with("FSM-4: the safety output is closed after a start"));
}

static void note_events(uint32_t t_ms) {
    const agv_recorder_t *recorder = &testbed.recorder;
    for (; next_sequence != agv_recorder_next_sequence(recorder); next_sequence++) {
        seen_t *s = &seen[seen_count];
        s->t_ms = t_ms;
        if (!drops_events && (seen_count < (unsigned)EVENTS_MAX) &&
            agv_recorder_get(recorder, next_sequence, &s->event) && (s->event.kind != (uint8_t)AGV_EVENT_FAULT) &&
            (s->event.kind != (uint8_t)AGV_EVENT_OUTPUT)) {
            seen_count++;
        }
    }
}

static void note_output(uint32_t t_ms) {
    const bool closed = testbed.hal.safety_output.on;
    if ((closed != output_was_closed()) && !drops_output && (output_count < (unsigned)EVENTS_MAX)) {
        outputs[output_count] = (output_t){t_ms, closed};
        output_count++;
    }
}

void trace_expect_ms(uint32_t t_ms) {
    if (is_broken) {
        return;
    }
    judge(t_ms);
    note_events(t_ms);
    note_output(t_ms);
}

void trace_expect_begin(void) {
    seen_count = 0;
    output_count = 0;
    is_broken = false;
    drops_events = false;
    drops_output = false;
    next_sequence = agv_recorder_next_sequence(&testbed.recorder);
    seen[0].t_ms = 0;
    seen[0].event = (agv_event_t){.kind = AGV_EVENT_STATE, .b = AGV_STATE_INIT, .c = AGV_FAULT_NONE};
    seen_count = 1;
}

void trace_expect_restarted(void) {
    next_sequence = 0; /* the recorder was empty when it started */
}

/* ---- Expectations ---- */

static const char *trip_reason(void) {
    const defect_row_t *row = &DEFECT_ROWS[model.defect];
    unsigned vcu_ms = 0;
    unsigned eps_ms = 0;
    if ((sscanf(model_broken(), "SUP-2: the heartbeat of the VCU is %u ms old, of the EPS %u ms", &vcu_ms, &eps_ms) ==
         2) &&
        (eps_ms > vcu_ms) && (row->frozen_fault != NULL)) {
        return row->frozen_fault;
    }
    return (row->fault != NULL) ? row->fault : "VCU_HEARTBEAT_LOST";
}

/* FSM-5: the status frame reports the first reason (TOP-3). */
static bool first_reason_was(char name[64]) {
    return sscanf(model_broken(), "FSM-5: the first reason was %63s and is", name) == 1;
}

bool trace_expect_needs_status(void) {
    char name[64];
    return first_reason_was(name) && (testbed.config.status_frame_id == 0u);
}

static uint32_t status_period_ms(void) {
    return trace_expect_needs_status() ? (uint32_t)TRACE_STATUS_MS : testbed.config.status_frame_period_ms;
}

uint32_t trace_expect_duration_ms(void) {
    char name[64];
    return broken_ms + (first_reason_was(name) ? (status_period_ms() + 1u)
                                               : ((latch_was_released() || rule_begins_with("FSM-3")) ? 0u : 1u));
}

static void write_at(FILE *file, uint32_t t_ms) {
    if (t_ms == 0u) {
        (void)fprintf(file, "at_ms: 0}\n");
    } else {
        (void)fprintf(file, "at_ms: [%u, %u]}\n", (unsigned)t_ms - 1u, (unsigned)t_ms + 1u);
    }
}

static void write_state(FILE *file, agv_state_t to, const char *reason, uint32_t t_ms) {
    (void)fprintf(file, "    - {to: %s, ", agv_state_name(to));
    if (reason != NULL) {
        (void)fprintf(file, "reason: %s, ", reason);
    }
    write_at(file, t_ms);
}

static void write_start(FILE *file) {
    if (rule_begins_with("FSM-7: after reset cause 0")) {
        write_state(file, AGV_STATE_INIT, NULL, broken_ms);
    } else if (rule_begins_with("FSM-7")) {
        /* the first reason before the restart */
        const char *was = "SUPERVISOR_RESET";
        for (unsigned i = 0; i < seen_count; i++) {
            const agv_event_t *event = &seen[i].event;
            const bool latches = (event->b == (uint8_t)AGV_STATE_TRIPPED) || (event->b == (uint8_t)AGV_STATE_SAFE);
            if (event->kind != (uint8_t)AGV_EVENT_STATE) {
                continue;
            }
            was = latches ? was : "SUPERVISOR_RESET";
            was = (latches && (agv_fault_name(event->c) != NULL)) ? agv_fault_name(event->c) : was;
        }
        write_state(file, AGV_STATE_TRIPPED, was, broken_ms);
    } else {
        /* not a rule of the start */
    }
}

static void write_states(FILE *file) {
    (void)fprintf(file, "  states:\n");
    for (unsigned i = 0; i < seen_count; i++) {
        if (seen[i].event.kind == (uint8_t)AGV_EVENT_STATE) {
            write_state(file, (agv_state_t)seen[i].event.b, agv_fault_name((agv_fault_t)seen[i].event.c), seen[i].t_ms);
        }
    }
    write_start(file);
    if (!latch_was_released() &&
        (rule_begins_with("SUP-2") || rule_begins_with("SUP-3") || rule_begins_with("SUP-4"))) {
        write_state(file, AGV_STATE_TRIPPED, trip_reason(), broken_ms);
    }
}

/* A frame that the supervisor must send, by its number among the safe commands. */
static void write_frame(FILE *file, unsigned command, uint32_t from_ms) {
    static const char *const BYTES[] = {"00 00 00 00 70 00 00 ..", "08 00 00 00 00 00 00 00", "00 00 00 00 00 00 00 00",
                                        ".. .. 00 00 00 00 00 00"};
    (void)fprintf(file, "    - {message: %s, side: vehicle, bytes: \"%s\", at_ms: [%u, %u]}\n",
                  agv_message_name((agv_message_t)command), BYTES[command % (unsigned)TRAFFIC_COMMANDS],
                  (unsigned)from_ms, (unsigned)broken_ms + 1u);
}

static void write_first_reason(FILE *file, const char *name) {
    const unsigned id = trace_expect_needs_status() ? (unsigned)TRACE_STATUS_ID : testbed.config.status_frame_id;
    (void)fprintf(
        file, "  frames:\n    - {id: %03Xh, side: vehicle, bytes: \".. %02X .. .. .. .. .. ..\", at_ms: [%u, %u]}\n",
        id, (unsigned)agv_fault_from_name(name), (unsigned)broken_ms + 1u,
        (unsigned)(broken_ms + status_period_ms() + 1u));
}

/* The later of two times of the rules, in the time of the file. */
static uint32_t since(uint64_t a_ms, uint64_t b_ms) {
    const uint64_t later_ms = (a_ms > b_ms) ? a_ms : b_ms;
    return (later_ms > model.root_ms) ? (uint32_t)(later_ms - model.root_ms) : 0u;
}

static void write_frames(FILE *file) {
    unsigned command = 0;
    char name[64];
    if (first_reason_was(name)) {
        write_first_reason(file, name);
    } else if (rule_begins_with("FSM-2")) {
        (void)fprintf(file, "  frames:\n");
        for (command = 0; command <= (unsigned)M_THROTTLE; command++) {
            if ((command != (unsigned)M_GEAR) || testbed.rules.park_at_once) {
                write_frame(file, command, broken_ms);
            }
        }
    } else if (sscanf(model_broken(), "TIM-1: safe command %u", &command) == 1) {
        (void)fprintf(file, "  frames:\n");
        write_frame(file, command, since(testbed.rules.sent_ms[command], testbed.rules.commanding_ms) + 1u);
    } else if (sscanf(model_broken(), "TOP-1: another sender's command was not overridden (command %u", &command) ==
               1) {
        (void)fprintf(file, "  frames:\n");
        write_frame(file, command, since(testbed.rules.answer_owed_ms[command], 0));
    } else {
        /* a rule on frames forbids a frame, or has no expectation */
    }
}

static void write_never(FILE *file) {
    const hal_can_frame_t *frame = &model_last_frame;
    if (!rule_begins_with("FSM-6") && !rule_begins_with("TOP-2") && !rule_begins_with("TOP-4") &&
        !rule_begins_with("INT-4: ")) {
        return;
    }
    if (rule_begins_with("INT-4: the gate")) {
        (void)fprintf(file, "  counters_at_end: {gate_refused: 0}\n");
        return;
    }
    (void)fprintf(file, "  never:\n    - {from: supervisor, id: %03Xh, side: %s, bytes: \"", (unsigned)frame->id,
                  (model_last_side == HAL_CAN_VEHICLE) ? "vehicle" : "ai");
    for (unsigned i = 0; i < frame->length; i++) {
        (void)fprintf(file, "%s%02X", (i > 0u) ? " " : "", frame->data[i]);
    }
    (void)fprintf(file, "\", at_ms: [%u, %u]}\n", (unsigned)broken_ms, (unsigned)broken_ms + 1u);
}

static void write_output(FILE *file) {
    bool closed = false;
    (void)fprintf(file, "  safety_output:");
    for (unsigned i = 0; i < output_count; i++) {
        closed = outputs[i].closed;
        (void)fprintf(file, "%s    - {closed: %s, ", (i == 0u) ? "\n" : "", closed ? "true" : "false");
        write_at(file, outputs[i].t_ms);
    }
    if (closed && !drops_output && rule_begins_with("FSM-4: the safety output is closed")) {
        (void)fprintf(file, "    - {closed: false, ");
        write_at(file, broken_ms);
    }
    (void)fprintf(file, "%s", (output_count == 0u) ? " []\n" : "");
}

static void write_missing(FILE *file, const seen_t *s) {
    const char *between = "";
    /* a press that must not count: the button is missing, too */
    const bool wrong_press =
        rule_begins_with("FSM-3: the latch was left without the button") && (s->event.kind == (uint8_t)AGV_EVENT_RESET);
    const uint32_t missing = s->event.missing | (wrong_press ? AGV_MISSING_BUTTON : 0u);
    for (uint8_t bit = 0; bit < (uint8_t)MISSING_BITS; bit++) {
        if ((missing & (1u << bit)) != 0u) {
            (void)fprintf(file, "%s%s", between, agv_missing_name(bit));
            between = ", ";
        }
    }
    (void)fprintf(file, "], ");
    write_at(file, s->t_ms);
}

/* A press of 1 s to 5 s in vain is answered at its release (FSM-3). */
static bool is_refused(void) {
    const uint64_t held_ms = testbed.now_ms - testbed.rules.pressed_ms;
    return (latch_was_released() || rule_begins_with("FSM-3: the latch was left w")) && (held_ms >= 1000u) &&
           (held_ms <= 5000u);
}

static const char *refused_for(void) {
    static const char *const WORDS[][2] = {{"SAFE", "state"},
                                           {"the button", "button"},
                                           {"manual", "manual"},
                                           {"standstill", "standstill"},
                                           {"throttle", "throttle"},
                                           {"a trip", "trip_cause"},
                                           {"a fault bit", "trip_cause"},
                                           {"a VCU", "vcu_heartbeat, eps_heartbeat"}};
    for (unsigned i = 0; i < sizeof WORDS / sizeof WORDS[0]; i++) {
        if (strstr(model_broken(), WORDS[i][0]) != NULL) {
            return WORDS[i][1];
        }
    }
    return "";
}

static void write_answer(FILE *file, const seen_t *s) {
    if (s->event.kind == (uint8_t)AGV_EVENT_STARTUP) {
        (void)fprintf(file, "    - {missing: [");
        write_missing(file, s);
    } else if (s->event.a != 0u) {
        (void)fprintf(file, "    - {accepted: true, ");
        write_at(file, s->t_ms);
    } else {
        (void)fprintf(file, "    - {accepted: false, why: [");
        write_missing(file, s);
    }
}

static void write_answers(FILE *file, agv_event_kind_t kind, const char *list) {
    bool any = false;
    for (unsigned i = 0; i < seen_count; i++) {
        if (seen[i].event.kind == (uint8_t)kind) {
            (void)fprintf(file, "%s", any ? "" : list);
            any = true;
            write_answer(file, &seen[i]);
        }
    }
    if ((kind == AGV_EVENT_RESET) && is_refused()) {
        (void)fprintf(file, "%s    - {accepted: false, why: [%s], ", any ? "" : list, refused_for());
        write_at(file, broken_ms);
    }
}

void trace_expect_write(FILE *file) {
    (void)fprintf(file, "expect:\n");
    write_states(file);
    write_frames(file);
    write_never(file);
    write_output(file);
    write_answers(file, AGV_EVENT_RESET, "  resets:\n");
    write_answers(file, AGV_EVENT_STARTUP, "  startup:\n");
}

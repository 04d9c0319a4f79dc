#include "trace.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "agv/names.h"
#include "model.h"

enum { TEXT_MAX = 1 << 17, STEPS_MAX = 256 };

static char text[TEXT_MAX]; /* the steps so far */
static size_t used;
static unsigned steps;
static uint32_t at_ms; /* the current millisecond */
static const char *symbol;
static bool complete; /* false: the file has inputs that are only comments */

/* State of the vehicle in the file so far. */
static traffic_message_t logged[TRAFFIC_MESSAGES];
static model_t logged_model;
static bool logged_full[HAL_CAN_SIDES];
static uint16_t logged_overruns;

static const char *const NODES[] = {"vcu", "eps", "ai"};
enum { VCU, EPS, AI };

__attribute__((format(printf, 1, 2))) static void add(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(&text[used], (size_t)TEXT_MAX - used, format, arguments);
    va_end(arguments);
    if ((length < 0) || (used + (size_t)length >= (size_t)TEXT_MAX)) {
        (void)fprintf(stderr, "the trace is too long\n");
        abort();
    }
    used += (size_t)length;
}

/* Begin a step of the file; its parameters follow. */
static void step(const char *actor, const char *what) {
    if (symbol != NULL) {
        add("  # %s\n", symbol);
        symbol = NULL;
    }
    steps++;
    add("  - {at_ms: %u, %s: %s", (unsigned)at_ms, actor, what);
}

static void plain_step(const char *actor, const char *what) {
    step(actor, what);
    add("}\n");
}

static void cannot_express(const char *what) {
    complete = false;
    add("  # NOT IN THIS FILE, at %u ms: %s\n", (unsigned)at_ms, what);
}

static void add_bytes(const uint8_t *data, unsigned length, int skip) {
    add(", bytes: \"");
    for (unsigned i = 0; i < length; i++) {
        if ((int)i == skip) {
            add("%s..", (i > 0u) ? " " : "");
        } else {
            add("%s%02X", (i > 0u) ? " " : "", data[i]);
        }
    }
    add("\"");
}

static unsigned node_of(unsigned message) {
    if (message < (unsigned)TRAFFIC_COMMANDS) {
        return AI;
    }
    return ((message >= (unsigned)M_STEERING_STATUS) && (message <= (unsigned)M_POSITION)) ? EPS : VCU;
}

/* ---- The vehicle ---- */

static void set_bytes(unsigned m) {
    step(NODES[node_of(m)], "set_bytes");
    add(", message: %s", agv_message_name((agv_message_t)m));
    add_bytes(testbed.traffic[m].data, 8, TRAFFIC[m].counter_at);
    add("}\n");
    memcpy(logged[m].data, testbed.traffic[m].data, sizeof logged[m].data);
}

static bool same_bytes(unsigned m) {
    for (int i = 0; i < 8; i++) {
        if ((i != TRAFFIC[m].counter_at) && (logged[m].data[i] != testbed.traffic[m].data[i])) {
            return false;
        }
    }
    return true;
}

static void log_message(unsigned m) {
    if (!same_bytes(m)) {
        set_bytes(m);
    }
    if (logged[m].muted != testbed.traffic[m].muted) {
        step(NODES[node_of(m)], testbed.traffic[m].muted ? "mute" : "unmute");
        add(", message: %s}\n", agv_message_name((agv_message_t)m));
        logged[m].muted = testbed.traffic[m].muted;
    }
    if (logged[m].frozen != testbed.traffic[m].frozen) {
        plain_step(NODES[node_of(m)], testbed.traffic[m].frozen ? "freeze_counter" : "run_counter");
        logged[m].frozen = testbed.traffic[m].frozen;
    }
}

/* Short frames. In a file their end also ends all bytes that were set. */
static void log_length(unsigned m) {
    const unsigned node = node_of(m);
    if (logged[m].length == testbed.traffic[m].length) {
        return;
    }
    logged[m].length = testbed.traffic[m].length;
    if (logged[m].length != 8u) {
        step(NODES[node], "garbage");
        add(", kind: wrong_length}\n");
        return;
    }
    plain_step(NODES[node], "recover");
    for (unsigned i = 0; i < (unsigned)TRAFFIC_MESSAGES; i++) {
        if (node_of(i) == node) {
            set_bytes(i);
        }
    }
}

/* Defects that are not a property of a message. */
static void log_defect(void) {
    const uint8_t was = logged_model.defect;
    const uint8_t is = model.defect;
    if (was == is) {
        return;
    }
    if ((is == (uint8_t)DEFECT_AI_BABBLES) || (was == (uint8_t)DEFECT_AI_BABBLES)) {
        step("ai", "send_every");
        add(", message: gear_command, every_ms: %u}\n", (is == (uint8_t)DEFECT_AI_BABBLES) ? 5u : 100u);
    }
    if (is == (uint8_t)DEFECT_FOREIGN) {
        step("bus", "send");
        add(", message: gear_command, side: vehicle, bytes: \"01 00 00 00 00 00 00 00\", every_ms: 20}\n");
    }
    if (was == (uint8_t)DEFECT_FOREIGN) {
        plain_step("bus", "stop_sending");
    }
    if (is == (uint8_t)DEFECT_RECEIVE_DEAD) {
        cannot_express("the receive path no longer checks in");
    }
}

static void log_vehicle(void) {
    log_length(M_VEHICLE);
    log_length(M_SIGNALS);
    for (unsigned m = 0; m < (unsigned)TRAFFIC_MESSAGES; m++) {
        log_message(m);
    }
    log_defect();
}

/* ---- The supervisor and its controllers ---- */

static void log_bus(void) {
    const uint8_t was = logged_model.bus;
    if (was == model.bus) {
        return;
    }
    switch (model.bus) {
    case BUS_PASSIVE:
        plain_step("supervisor", "error_passive");
        break;
    case BUS_OFF:
        plain_step("supervisor", "bus_off");
        break;
    case BUS_DEAD:
        plain_step("supervisor", "bus_off");
        cannot_express("the controller does not recover on request");
        break;
    default:
        if (was == (uint8_t)BUS_PASSIVE) {
            plain_step("supervisor", "error_active");
        }
        break;
    }
}

static void log_queue(hal_can_side_t side) {
    const bool full = testbed.hal.can[side].full;
    if (logged_full[side] != full) {
        step("supervisor", full ? "fill_queue" : "free_queue");
        add(", side: %s}\n", (side == HAL_CAN_VEHICLE) ? "vehicle" : "ai");
        logged_full[side] = full;
    }
}

static void log_controllers(void) {
    const uint16_t overruns = testbed.hal.can[HAL_CAN_VEHICLE].status.overrun_count;
    log_bus();
    log_queue(HAL_CAN_VEHICLE);
    log_queue(HAL_CAN_AI);
    if (logged_model.stalled != model.stalled) {
        plain_step("supervisor", model.stalled ? "stall_tx" : "free_tx");
    }
    if (!logged_model.ai_off && model.ai_off) {
        step("supervisor", "bus_off");
        add(", side: ai}\n");
        cannot_express("the controller recovers only later in the trace");
    }
    if (logged_overruns != overruns) {
        plain_step("supervisor", "overrun");
    }
    if (!logged_model.bad_latch && model.bad_latch) {
        plain_step("supervisor", "corrupt_latch");
    }
    logged_overruns = overruns;
}

static void before(uint32_t ms) {
    at_ms = ms;
    log_vehicle();
    log_controllers();
    logged_model = model;
}

static void after(void) {
    logged_model = model; /* a change that a controller made by itself is not a step */
    trace_expect_ms(model_now_ms());
}

static const char *kind_of(uint8_t flags) {
    switch (flags) {
    case HAL_CAN_EXTENDED:
        return "extended";
    case HAL_CAN_REMOTE:
        return "remote";
    case HAL_CAN_FD:
        return "fd";
    case HAL_CAN_ERROR:
        return "error";
    default:
        return "data";
    }
}

static void delivered(hal_can_side_t side, const hal_can_frame_t *frame) {
    step("bus", "deliver");
    add(", id: %Xh, kind: %s, side: %s", (unsigned)frame->id, kind_of(frame->flags),
        (side == HAL_CAN_VEHICLE) ? "vehicle" : "ai");
    add_bytes(frame->data, frame->length, -1);
    add("}\n");
}

static void write_late_frame(unsigned message) {
    const bool ai =
        (message < (unsigned)TRAFFIC_COMMANDS) && (testbed.config.topology == (uint16_t)AGV_TOPOLOGY_GATEWAY);
    step("bus", "deliver");
    add(", message: %s, kind: data, side: %s", agv_message_name((agv_message_t)message), ai ? "ai" : "vehicle");
    add_bytes(testbed.traffic[message].data, 8, -1);
    add("}\n");
}

static void restarted(hal_reset_cause_t cause) {
    static const char *const CAUSES[] = {"power-on", "watchdog", "brown-out", "lock-up", "software", "unknown"};
    step("supervisor", "restart");
    add(", cause: %s}\n", CAUSES[cause]);
    logged_overruns = 0;
    trace_expect_restarted();
}

static void without_ticks(uint32_t ms, bool frames_come) {
    if (frames_come) {
        step("supervisor", "hang");
        add(", for_ms: %u}\n", (unsigned)ms);
    } else {
        cannot_express("eleven days pass without a tick and without a frame");
    }
}

static const model_listener_t TRACE_WRITER = {before, after, delivered, write_late_frame, restarted, without_ticks};

void trace_begin(void) {
    used = 0;
    steps = 0;
    symbol = NULL;
    complete = true;
    at_ms = 0;
    model_listener = &TRACE_WRITER;
    memcpy(logged, testbed.traffic, sizeof logged);
    logged_model = model;
    memset(logged_full, 0, sizeof logged_full);
    logged_overruns = testbed.hal.can[HAL_CAN_VEHICLE].status.overrun_count;
    for (unsigned m = 0; m < (unsigned)TRAFFIC_MESSAGES; m++) {
        set_bytes(m);
    }
    trace_expect_begin();
}

void trace_says(const char *comment) {
    symbol = comment;
}

/* ---- The file ---- */

static void write_word(FILE *file, const char *words, unsigned index) {
    for (unsigned i = 0; i < index; i++) {
        words = strchr(words, '|') + 1;
    }
    (void)fprintf(file, "%.*s", (int)strcspn(words, "|"), words);
}

static void write_config(FILE *file) {
    const agv_config_t *config = &testbed.config;
    const char *between = "config: {";
    (void)fprintf(file, "topology: %s\nid_set: %s\n",
                  (config->topology == (uint16_t)AGV_TOPOLOGY_GATEWAY) ? "gateway" : "shared",
                  (config->id_set == (uint16_t)AGV_ID_SET_TABLE) ? "table" : "heading");
#define AGV_CHOICE(name, words, last, weakens, scope, meaning)                                                         \
    if ((AGV_SETTING_##name > AGV_SETTING_id_set) && (config->name != 0u)) {                                           \
        (void)fprintf(file, "%s" #name ": ", between);                                                                 \
        write_word(file, words, config->name);                                                                         \
        between = ", ";                                                                                                \
    }
#define AGV_SETTING(name, preset, lowest, highest, unit, weakens, scope, meaning)                                      \
    if (config->name != (preset)) {                                                                                    \
        (void)fprintf(file, "%s" #name ": %u", between, config->name);                                                 \
        between = ", ";                                                                                                \
    }
#include "agv/config_settings.def"
#undef AGV_CHOICE
#undef AGV_SETTING
    if (trace_expect_needs_status()) {
        (void)fprintf(file, "%sstatus_frame_id: %u, status_frame_period_ms: %u", between, (unsigned)TRACE_STATUS_ID,
                      (unsigned)TRACE_STATUS_MS);
        between = ", ";
    }
    if (between[0] == ',') {
        (void)fprintf(file, "}\n");
    }
}

static void write_phases(FILE *file) {
    (void)fprintf(file, "vehicle:\n  phases_ms: {");
    for (unsigned m = 0; m < (unsigned)TRAFFIC_MESSAGES; m++) {
        (void)fprintf(file, "%s%s: %u", (m > 0u) ? ", " : "", agv_message_name((agv_message_t)m), MODEL_PHASE_MS[m]);
    }
    (void)fprintf(file, "}\n");
}

void trace_write(FILE *file) {
    const char *broken = model_broken();
    model_listener = NULL;
    (void)fprintf(file, "# Found by the explorer, at %u ms: %s\n", (unsigned)model_now_ms(), broken);
    if (!complete || (steps > (unsigned)STEPS_MAX)) {
        (void)fprintf(file, "# This file alone does not show the broken rule: %s.\n",
                      complete ? "there are more steps than a scenario may have" : "see NOT IN THIS FILE below");
    }
    (void)fprintf(file, "name: \"%.*s: found by the explorer\"\nshows: [%.*s]\n", (int)strcspn(broken, ":"), broken,
                  (int)strcspn(broken, ":"), broken);
    write_config(file);
    (void)fprintf(file, "bitrate: 1000000\nclock_start_ms: %u\nhardware_watchdog: none\n",
                  (unsigned)model_variant->clock_ms);
    write_phases(file);
    (void)fprintf(file, "duration_ms: %u\nsteps:\n%s", (unsigned)trace_expect_duration_ms(), text);
    trace_expect_write(file);
}

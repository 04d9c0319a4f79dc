#include "model.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Messages of 10 ms share no millisecond with each other, nor with those of 25 ms, because little is delayed on a real
 * bus. */
static const uint8_t PHASE_MS[TRAFFIC_MESSAGES] = {
    [M_SIGNALS] = 21,   [M_GEAR] = 45,       [M_THROTTLE] = 76,       [M_STEERING] = 8,
    [M_VEHICLE] = 1,    [M_GEAR_STATUS] = 2, [M_THROTTLE_STATUS] = 4, [M_STEERING_STATUS] = 5,
    [M_EPS_STATUS] = 6, [M_POSITION] = 9,    [M_WHEELS] = 0,
};

enum { RECOVERY_MS = 2, BABBLE_MS = 5, FOREIGN_MS = 20, WHEEL_MM_S = 200 };
/* Latest trip: at any time; after four engagements; while engaged; after the grace time and a budget of 1 s. */
enum { ALWAYS_MS = 250, FLAPPING_MS = 2500, ENGAGED_MS = 1200, FOLLOWED_MS = 1800 };
enum { BOTH_MS = 150, NEITHER_MS = 700, STOP_MS = 5200, SEEN_MS = 300 };

const model_variant_t MODEL_VARIANT[MODEL_VARIANTS] = {
    {"shared bus", 0, 0, false},
    {"shared bus, table, the clock wraps", 1, 0u - 2500u, true},
    {"shared bus, park at standstill, AI lost trips, status frame, the clock passes its middle", 2, 0x80000000u - 4000,
     true},
    {"gateway, the clock wraps", 3, 0u - 4000u, true},
    {"gateway, table, all pass in manual, frozen heartbeat, ceiling", 4, 0, false},
    {"gateway, park at standstill, slew, status frame, the clock wraps", 5, 0u - 1500u, true},
    {"shadow", 6, 0, false},
};

model_t model;
const model_variant_t *model_variant;

static sim_hal_sink_fn *judge_sent;

static void on_sent(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame) {
    model.frames++;
    if (model.stalled && (side == HAL_CAN_VEHICLE) && (testbed.hal.can[side].status.tx_pending_ms == 0)) {
        model.taken_ms = testbed.now_ms;
        testbed.hal.can[side].status.tx_pending_ms = 1;
    }
    judge_sent(ctx, side, frame);
}

static void go_on(void) {
    /* model_broken() is checked after each symbol */
}

/* ---- Start, save, restore ---- */

void model_root(const model_variant_t *variant) {
    model_variant = variant;
    testbed_on_broken = go_on;
    testbed_load(variant->testbed, 0);
    if (testbed.hal.sink != on_sent) {
        judge_sent = testbed.hal.sink;
        testbed.hal.sink = on_sent;
    }
    memset(&model, 0, sizeof model);
    model.root_ms = testbed.now_ms;
    model.mode = MODEL_MANUAL;
    model.gear = MODEL_P;
    model.recover_requests = testbed.hal.can[HAL_CAN_VEHICLE].recover_requests;
    testbed.offset_ms = variant->clock_ms - (uint32_t)testbed.now_ms;
    sim_hal_set_now_ms(&testbed.hal, variant->clock_ms);
    for (unsigned m = 0; m < TRAFFIC_MESSAGES; m++) {
        testbed.traffic[m].counter = 0;
    }
    model_apply_defect();
    testbed_restart(HAL_RESET_POWER_ON);
}

void model_save(model_saved_t *saved) {
    testbed_save(&saved->testbed);
    saved->model = model;
}

void model_restore(const model_saved_t *saved) {
    testbed_restore(&saved->testbed);
    model = saved->model;
    testbed.receive_path_dead = model.defect == DEFECT_RECEIVE_DEAD;
}

uint32_t model_now_ms(void) {
    return (uint32_t)(testbed.now_ms - model.root_ms);
}

bool model_wrapped(void) {
    const uint32_t middle = (model_variant->clock_ms < 0x80000000u) ? 0x80000000u : 0;
    return model_variant->wraps && (model_now_ms() >= middle - model_variant->clock_ms);
}

/* ---- Checks besides rules.h ---- */

__attribute__((format(printf, 1, 2))) static void broken(const char *format, ...) {
    va_list arguments;
    if (testbed.rules.broken[0] == '\0') {
        va_start(arguments, format);
        (void)vsnprintf(testbed.rules.broken, sizeof testbed.rules.broken, format, arguments);
        va_end(arguments);
    }
}

/* Whether the defect has lasted long enough for a trip. The limits are from the protocol, not the supervisor's own. */
static bool must_trip(void) {
    const uint64_t defect_ms = testbed.now_ms - model.defect_ms;
    const uint64_t engaged_ms = (model.mode == MODEL_ENGAGED) ? (testbed.now_ms - model.mode_ms) : 0;
    const uint64_t both_ms = (defect_ms < engaged_ms) ? defect_ms : engaged_ms;
    switch (DEFECT_ROWS[model.defect].trips) {
    case TRIPS_ALWAYS:
        return defect_ms > ALWAYS_MS;
    case TRIPS_FLAPPING:
        return defect_ms > FLAPPING_MS;
    case TRIPS_ENGAGED:
        return both_ms > ENGAGED_MS;
    case TRIPS_FOLLOWED:
        return both_ms > FOLLOWED_MS;
    default:
        return false;
    }
}

/* A lasting defect must trip and prevent a reset (except one of the AI computer). */
static void judge_defect(bool was_latched) {
    const agv_state_t state = agv_supervisor_state(&testbed.supervisor);
    if (agv_state_commands_safe(state) || !must_trip()) {
        return;
    }
    if (was_latched) {
        broken("FSM-3: the latch was left with a trip cause: %s", DEFECT_ROWS[model.defect].name);
    } else {
        broken("SUP-4: %s for %u ms without a trip", DEFECT_ROWS[model.defect].name,
               (unsigned)(testbed.now_ms - model.defect_ms));
    }
}

/* SUP-9: both mode bits, or neither while the wheels turn. */
static void judge_mode(void) {
    const uint64_t mode_ms = testbed.now_ms - model.mode_ms;
    const uint64_t wheels_ms = testbed.now_ms - model.wheels_ms;
    if (agv_state_commands_safe(agv_supervisor_state(&testbed.supervisor)) || (model.defect == DEFECT_MODE_FLAPS)) {
        return;
    }
    if ((model.mode == MODEL_BOTH) && (mode_ms > BOTH_MS)) {
        broken("SUP-9: both modes for %u ms without a trip", (unsigned)mode_ms);
    }
    if ((model.mode == MODEL_NEITHER) && model.wheels_turn && (mode_ms > NEITHER_MS) && (wheels_ms > NEITHER_MS)) {
        broken("SUP-9: neither mode for %u ms while moving, without a trip", (unsigned)mode_ms);
    }
}

/* FSM-12: the output must open when the vehicle does not stop, or moves again. */
static void judge_stop(void) {
    const uint64_t wheels_ms = testbed.now_ms - model.wheels_ms;
    const uint64_t latched_ms = testbed.now_ms - model.latched_ms;
    const bool seen = model_flows(M_WHEELS) && (testbed.now_ms - model.defect_ms > SEEN_MS) && (wheels_ms > SEEN_MS) &&
                      (latched_ms > SEEN_MS);
    if (!agv_state_is_latched(agv_supervisor_state(&testbed.supervisor))) {
        model.latched_ms = testbed.now_ms;
        model.stood = false;
        return;
    }
    model.stood = model.stood || (seen && !model.wheels_turn);
    if (!agv_supervisor_output_closed(&testbed.supervisor) || !model.wheels_turn) {
        return;
    }
    if ((latched_ms > STOP_MS) && (wheels_ms > latched_ms + (uint64_t)SEEN_MS)) {
        broken("FSM-12: the wheels turn %u ms after the trip, and the safety output is closed", (unsigned)latched_ms);
    }
    if (model.stood && seen) {
        broken("FSM-12: the wheels turn again for %u ms, and the safety output is closed", (unsigned)wheels_ms);
    }
}

static void judge(bool was_latched) {
    const uint32_t counted = agv_supervisor_counters(&testbed.supervisor)->sent;
    if (counted != model.frames) {
        broken("INT-4: %u frames were sent, the gate allowed %u", (unsigned)model.frames, (unsigned)counted);
    }
    judge_defect(was_latched);
    judge_mode();
    judge_stop();
}

const char *model_broken(void) {
    return testbed.rules.broken;
}

/* ---- Traffic ---- */

void model_apply_defect(void) {
    traffic_heal(testbed.traffic);
    traffic_mode(testbed.traffic, model.mode);
    traffic_button(testbed.traffic, model.button);
    traffic_gear(testbed.traffic, model.gear);
    const int32_t mm_s = model.wheels_turn ? WHEEL_MM_S : 0;
    traffic_wheels(testbed.traffic, mm_s, mm_s);
    traffic_ai_drives(testbed.traffic);
    defect_apply((defect_t)model.defect);
}

static bool is_off(hal_can_side_t side) {
    return testbed.hal.can[side].status.state == HAL_CAN_BUS_OFF;
}

bool model_flows(unsigned message) {
    const traffic_message_t *m = &testbed.traffic[message];
    return !m->muted && (m->length == 8) && !is_off(testbed.traffic[message].side);
}

/* A controller in bus-off receives nothing. */
static void send(unsigned message) {
    if (!is_off(testbed.traffic[message].side)) {
        testbed_send(message);
    }
}

static bool is_due(unsigned message, uint32_t t_ms) {
    if ((message == M_GEAR) && (model.defect == DEFECT_AI_BABBLES)) {
        return t_ms % BABBLE_MS == 0;
    }
    return t_ms % TRAFFIC[message].cycle_ms == PHASE_MS[message];
}

static void send_due(void) {
    const uint32_t t_ms = model_now_ms();
    for (unsigned m = 0; m < TRAFFIC_MESSAGES; m++) {
        if (!testbed.traffic[m].muted && is_due(m, t_ms)) {
            send(m);
        }
    }
    if ((model.defect == DEFECT_FOREIGN) && ((testbed.now_ms - model.foreign_ms) % FOREIGN_MS == 0) &&
        !is_off(HAL_CAN_VEHICLE)) {
        testbed_frame(HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x168, .length = 8, .data = {MODEL_D}}, 0);
    }
}

/* ---- Milliseconds ---- */

static void follow_controller(void) {
    sim_hal_can_t *can = &testbed.hal.can[HAL_CAN_VEHICLE];
    if (model.recover_in_ms != 0) {
        model.recover_in_ms--;
        if ((model.recover_in_ms == 0) && (model.bus == BUS_OFF)) {
            model_set_bus(BUS_FINE);
        }
    }
    if ((model.bus == BUS_OFF) && (can->recover_requests != model.recover_requests)) {
        model.recover_in_ms = RECOVERY_MS;
    }
    model.recover_requests = can->recover_requests;
}

/* The age of the oldest frame that is not sent, in full milliseconds, at least 1 (hal/can.h). */
static void age_pending(void) {
    sim_hal_can_t *can = &testbed.hal.can[HAL_CAN_VEHICLE];
    if (model.stalled && (can->status.tx_pending_ms != 0) && (testbed.now_ms > model.taken_ms)) {
        can->status.tx_pending_ms = (uint32_t)(testbed.now_ms - model.taken_ms);
    }
}

/* The rest of a millisecond after the changes of the model: tick, frames, checks. */
static void finish_ms(void) {
    const bool was_latched = agv_state_is_latched(agv_supervisor_state(&testbed.supervisor));
    age_pending();
    testbed_jump(0);
    send_due();
    follow_controller();
    judge(was_latched);
    if (model.defect == DEFECT_MODE_FLAPS) {
        model_apply_defect(); /* the next 363h may have another mode */
    }
}

void model_run(uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        testbed.now_ms++;
        finish_ms();
    }
}

void model_run_past(unsigned message) {
    for (unsigned i = 0; i < TRAFFIC[message].cycle_ms; i++) {
        model_run(1);
        if (is_due(message, model_now_ms())) {
            return;
        }
    }
}

void model_deliver(hal_can_side_t side, const hal_can_frame_t *frames, unsigned count) {
    testbed.now_ms++;
    for (unsigned i = 0; i < count; i++) {
        testbed_frame(side, frames[i], 0);
    }
    finish_ms();
}

static bool may_send_late_frame(unsigned message) {
    const traffic_message_t *m = &testbed.traffic[message];
    return (m->muted || m->frozen) && !is_off(testbed.traffic[message].side);
}

bool model_can_speak(void) {
    bool can = false;
    for (unsigned m = 0; m < TRAFFIC_MESSAGES; m++) {
        can = can || may_send_late_frame(m);
    }
    return can;
}

void model_speak(void) {
    testbed.now_ms++;
    for (unsigned m = 0; m < TRAFFIC_MESSAGES; m++) {
        const traffic_message_t kept = testbed.traffic[m];
        if (may_send_late_frame(m)) {
            testbed.traffic[m].frozen = false;
            testbed.traffic[m].counter = (uint8_t)(kept.counter + 100);
            send(m);
            testbed.traffic[m].frozen = kept.frozen;
            testbed.traffic[m].muted = kept.muted;
        }
    }
    finish_ms();
}

/* A start reads the whole recorder, which has no effect on decisions. It is emptied to save time. */
static void empty_recorder(void) {
    for (unsigned i = 0; i < AGV_RECORDER_EVENTS; i++) {
        testbed.recorder.events[i].kind = 0;
    }
}

/* rules.h does not handle a damaged latch: then the first reason may be lost, but nothing else (FSM-7). */
static void judge_damaged(bool power_on) {
    static const char LOST[] = "FSM-7: after a reset the first reason is SUPERVISOR_RESET";
    if (!power_on && (strcmp(testbed.rules.broken, LOST) == 0)) {
        testbed.rules.broken[0] = '\0';
    }
}

void model_restart(hal_reset_cause_t cause) {
    empty_recorder();
    testbed.now_ms++;
    sim_hal_set_now_ms(&testbed.hal, (uint32_t)testbed.now_ms + testbed.offset_ms);
    model.frames = 0;
    model.bus = BUS_FINE;
    model.ai_off = false;
    model.stalled = false;
    model.recover_in_ms = 0;
    testbed_restart(cause);
    if (model.bad_latch) {
        judge_damaged(cause == HAL_RESET_POWER_ON);
    }
    model.bad_latch = false;
    model.latched_ms = testbed.now_ms;
    model.stood = false;
    finish_ms();
}

void model_late(uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        testbed.now_ms++;
        send_due();
    }
    model_run(1);
}

void model_sleep(uint32_t ms) {
    testbed.now_ms += ms;
    model.wheels_ms = testbed.now_ms; /* no frames of them were received before */
    finish_ms();
}

void model_set_bus(model_bus_t bus) {
    static const hal_can_state_t STATES[] = {HAL_CAN_ERROR_ACTIVE, HAL_CAN_ERROR_PASSIVE, HAL_CAN_BUS_OFF,
                                             HAL_CAN_BUS_OFF};
    model.bus = (uint8_t)bus;
    testbed_disturb(HAL_CAN_VEHICLE, 0, (uint8_t)STATES[bus]);
}

void model_set_ai_off(bool off) {
    model.ai_off = off;
    testbed_disturb(HAL_CAN_AI, 0, off ? (uint8_t)HAL_CAN_BUS_OFF : (uint8_t)HAL_CAN_ERROR_ACTIVE);
}

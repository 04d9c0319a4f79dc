#include "stage.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Two of 10 ms share no millisecond with each other, nor with those of 25 ms: little delays anything on a real bus. */
const uint8_t STAGE_PHASE_MS[TRAFFIC_MESSAGES] = {
    [M_SIGNALS] = 21,   [M_GEAR] = 45,       [M_THROTTLE] = 76,       [M_STEERING] = 8,
    [M_VEHICLE] = 1,    [M_GEAR_STATUS] = 2, [M_THROTTLE_STATUS] = 4, [M_STEERING_STATUS] = 5,
    [M_EPS_STATUS] = 6, [M_POSITION] = 9,    [M_WHEELS] = 0,
};

enum { WRAP = 0, MIDDLE = 0x7FFFFFFF };
enum { RECOVERY_MS = 2, BABBLE_MS = 5, FOREIGN_MS = 20, WHEEL_MM_S = 200 };
/* Until it has tripped: at any time; after four engagements; while engaged; a budget of 1 s after the grace time. */
enum { ALWAYS_MS = 250, FLAPPING_MS = 2500, ENGAGED_MS = 1200, FOLLOWED_MS = 1800 };
enum { BOTH_MS = 150, NEITHER_MS = 700, STOP_MS = 5200, SEEN_MS = 300 };

const stage_variant_t STAGE_VARIANT[STAGE_VARIANTS] = {
    {"shared bus", 0, 0, false},
    {"shared bus, table, the clock wraps", 1, 0u - 2500u, true},
    {"shared bus, park at standstill, AI lost trips, status frame, the clock passes its middle", 2, 0x80000000u - 4000u,
     true},
    {"gateway, the clock wraps", 3, 0u - 4000u, true},
    {"gateway, table, all pass in manual, frozen heartbeat, ceiling", 4, 0, false},
    {"gateway, park at standstill, slew, status frame, the clock wraps", 5, 0u - 1500u, true},
    {"shadow", 6, 0, false},
};

stage_t stage;
const stage_variant_t *stage_variant;
hal_can_frame_t stage_last_frame;
hal_can_side_t stage_last_side;
const stage_teller_t *stage_teller;

static sim_hal_sink_fn *judge_sent;

static void on_sent(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame) {
    if (world.rules.broken[0] == '\0') {
        stage_last_frame = *frame;
        stage_last_side = side;
    }
    stage.frames++;
    if (stage.stalled && (side == HAL_CAN_VEHICLE) && (world.hal.can[side].status.tx_pending_ms == 0u)) {
        stage.taken_ms = world.now_ms;
        world.hal.can[side].status.tx_pending_ms = 1;
    }
    judge_sent(ctx, side, frame);
}

static void go_on(void) {
    /* what is broken is asked for after each symbol */
}

/* ---- Beginning, saving ---- */

void stage_root(const stage_variant_t *variant) {
    stage_variant = variant;
    world_on_broken = go_on;
    world_load(variant->world, 0);
    if (world.hal.sink != on_sent) {
        judge_sent = world.hal.sink;
        world.hal.sink = on_sent;
    }
    memset(&stage, 0, sizeof stage);
    stage.root_ms = world.now_ms;
    stage.mode = STAGE_MANUAL;
    stage.gear = STAGE_P;
    stage.recover_requests = world.hal.can[HAL_CAN_VEHICLE].recover_requests;
    world.offset_ms = variant->clock_ms - (uint32_t)world.now_ms;
    sim_hal_set_now_ms(&world.hal, variant->clock_ms);
    for (unsigned m = 0; m < (unsigned)TRAFFIC_MESSAGES; m++) {
        world.traffic[m].counter = 0;
    }
    stage_dress();
    world_restart(HAL_RESET_POWER_ON);
}

void stage_save(stage_saved_t *saved) {
    moment_save();
    saved->world = moment;
    saved->stage = stage;
}

void stage_restore(const stage_saved_t *saved) {
    moment = saved->world;
    moment_restore();
    stage = saved->stage;
    world.receive_path_dead = stage.illness == (uint8_t)ILL_RECEIVE_DEAD;
}

uint32_t stage_now_ms(void) {
    return (uint32_t)(world.now_ms - stage.root_ms);
}

bool stage_wrapped(void) {
    const uint32_t middle = (stage_variant->clock_ms < 0x80000000u) ? 0x80000000u : 0u;
    return stage_variant->wraps && (stage_now_ms() >= middle - stage_variant->clock_ms);
}

/* ---- What is judged beside the rules ---- */

__attribute__((format(printf, 1, 2))) static void broken(const char *format, ...) {
    va_list arguments;
    if (world.rules.broken[0] == '\0') {
        va_start(arguments, format);
        (void)vsnprintf(world.rules.broken, sizeof world.rules.broken, format, arguments);
        va_end(arguments);
    }
}

/* How long the vehicle has been ill in a way that has to trip, by the protocol and not by the supervisor's own times. */
static bool must_trip(void) {
    const uint64_t ill_ms = world.now_ms - stage.ill_ms;
    const uint64_t engaged_ms = (stage.mode == (uint8_t)STAGE_ENGAGED) ? (world.now_ms - stage.mode_ms) : 0u;
    const uint64_t both_ms = (ill_ms < engaged_ms) ? ill_ms : engaged_ms;
    switch (ILLNESS[stage.illness].trips) {
    case TRIPS_ALWAYS:
        return ill_ms > (uint64_t)ALWAYS_MS;
    case TRIPS_FLAPPING:
        return ill_ms > (uint64_t)FLAPPING_MS;
    case TRIPS_ENGAGED:
        return both_ms > (uint64_t)ENGAGED_MS;
    case TRIPS_FOLLOWED:
        return both_ms > (uint64_t)FOLLOWED_MS;
    default:
        return false;
    }
}

/* Whatever the counts and deadlines are, in the end it trips, and no reset is accepted (but for an AI computer). */
static void judge_illness(bool was_latched) {
    const agv_state_t state = agv_supervisor_state(&world.supervisor);
    if (agv_state_commands_safe(state) || !must_trip()) {
        return;
    }
    if (was_latched) {
        broken("FSM-3: the latch was left with a trip cause: %s", ILLNESS[stage.illness].name);
    } else {
        broken("SUP-4: %s for %u ms, and it has not tripped", ILLNESS[stage.illness].name,
               (unsigned)(world.now_ms - stage.ill_ms));
    }
}

/* SUP-9: both mode bits, or neither while the wheels turn. */
static void judge_mode(void) {
    const uint64_t mode_ms = world.now_ms - stage.mode_ms;
    const uint64_t wheels_ms = world.now_ms - stage.wheels_ms;
    if (agv_state_commands_safe(agv_supervisor_state(&world.supervisor)) ||
        (stage.illness == (uint8_t)ILL_MODE_FLAPS)) {
        return;
    }
    if ((stage.mode == (uint8_t)STAGE_BOTH) && (mode_ms > (uint64_t)BOTH_MS)) {
        broken("SUP-9: both modes for %u ms, and it has not tripped", (unsigned)mode_ms);
    }
    if ((stage.mode == (uint8_t)STAGE_NEITHER) && stage.wheels_turn && (mode_ms > (uint64_t)NEITHER_MS) &&
        (wheels_ms > (uint64_t)NEITHER_MS)) {
        broken("SUP-9: neither mode for %u ms on the move, and it has not tripped", (unsigned)mode_ms);
    }
}

/* FSM-12: a vehicle that does not stop, and one that moves again. */
static void judge_stop(void) {
    const uint64_t wheels_ms = world.now_ms - stage.wheels_ms;
    const uint64_t latched_ms = world.now_ms - stage.latched_ms;
    const bool seen = stage_flows(M_WHEELS) && (world.now_ms - stage.ill_ms > (uint64_t)SEEN_MS) &&
                      (wheels_ms > (uint64_t)SEEN_MS) && (latched_ms > (uint64_t)SEEN_MS);
    if (!agv_state_is_latched(agv_supervisor_state(&world.supervisor))) {
        stage.latched_ms = world.now_ms;
        stage.stood = false;
        return;
    }
    stage.stood = stage.stood || (seen && !stage.wheels_turn);
    if (!agv_supervisor_output_closed(&world.supervisor) || !stage.wheels_turn) {
        return;
    }
    if ((latched_ms > (uint64_t)STOP_MS) && (wheels_ms > latched_ms + (uint64_t)SEEN_MS)) {
        broken("FSM-12: the wheels turn %u ms after the trip, and the safety output is closed", (unsigned)latched_ms);
    }
    if (stage.stood && seen) {
        broken("FSM-12: the wheels turn again for %u ms, and the safety output is closed", (unsigned)wheels_ms);
    }
}

static void judge(bool was_latched) {
    const uint32_t counted = agv_supervisor_counters(&world.supervisor)->sent;
    if (counted != stage.frames) {
        broken("INT-4: %u frames have left, the gate let out %u", (unsigned)stage.frames, (unsigned)counted);
    }
    judge_illness(was_latched);
    judge_mode();
    judge_stop();
}

const char *stage_broken(void) {
    return world.rules.broken;
}

/* ---- Traffic ---- */

void stage_dress(void) {
    world_heal();
    world_mode(stage.mode);
    world_button(stage.button);
    world_gear(stage.gear);
    world_wheels(stage.wheels_turn ? (uint8_t)WHEEL_MM_S : 0u);
    world_ai_drives();
    illness_dress((illness_t)stage.illness);
}

static bool is_off(hal_can_side_t side) {
    return world.hal.can[side].status.state == HAL_CAN_BUS_OFF;
}

bool stage_flows(unsigned message) {
    const traffic_message_t *m = &world.traffic[message];
    return !m->muted && (m->length == 8u) && !is_off(world.traffic[message].side);
}

/* A controller in bus-off hears nothing. */
static void send(unsigned message) {
    if (!is_off(world.traffic[message].side)) {
        world_send(message);
    }
}

static bool is_due(unsigned message, uint32_t t_ms) {
    if ((message == (unsigned)M_GEAR) && (stage.illness == (uint8_t)ILL_AI_BABBLES)) {
        return t_ms % (uint32_t)BABBLE_MS == 0u;
    }
    return t_ms % TRAFFIC[message].cycle_ms == STAGE_PHASE_MS[message];
}

static void send_due(void) {
    const uint32_t t_ms = stage_now_ms();
    for (unsigned m = 0; m < (unsigned)TRAFFIC_MESSAGES; m++) {
        if (!world.traffic[m].muted && is_due(m, t_ms)) {
            send(m);
        }
    }
    if ((stage.illness == (uint8_t)ILL_FOREIGN) && ((world.now_ms - stage.foreign_ms) % (uint64_t)FOREIGN_MS == 0u) &&
        !is_off(HAL_CAN_VEHICLE)) {
        world_frame(HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x168, .length = 8, .data = {STAGE_D}}, 0);
    }
}

/* ---- Milliseconds ---- */

static void follow_controller(void) {
    sim_hal_can_t *can = &world.hal.can[HAL_CAN_VEHICLE];
    if (stage.recover_in_ms != 0u) {
        stage.recover_in_ms--;
        if ((stage.recover_in_ms == 0u) && (stage.bus == (uint8_t)BUS_OFF)) {
            stage_set_bus(BUS_FINE);
        }
    }
    if ((stage.bus == (uint8_t)BUS_OFF) && (can->recover_requests != stage.recover_requests)) {
        stage.recover_in_ms = RECOVERY_MS;
    }
    stage.recover_requests = can->recover_requests;
}

/* What does not leave has waited for full milliseconds, at least 1 (hal/can.h). */
static void age_pending(void) {
    sim_hal_can_t *can = &world.hal.can[HAL_CAN_VEHICLE];
    if (stage.stalled && (can->status.tx_pending_ms != 0u) && (world.now_ms > stage.taken_ms)) {
        can->status.tx_pending_ms = (uint32_t)(world.now_ms - stage.taken_ms);
    }
}

static void before(void) {
    if (stage_teller != NULL) {
        stage_teller->before(stage_now_ms() + 1u);
    }
}

static void after(bool was_latched) {
    judge(was_latched);
    if (stage_teller != NULL) {
        stage_teller->after();
    }
}

/* The rest of a millisecond whose actions are done. */
static void finish_ms(void) {
    const bool was_latched = agv_state_is_latched(agv_supervisor_state(&world.supervisor));
    age_pending();
    world_jump(0);
    send_due();
    follow_controller();
    after(was_latched);
    if (stage.illness == (uint8_t)ILL_MODE_FLAPS) {
        stage_dress(); /* the next 363h may have another mode */
    }
}

void stage_run(uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        before();
        world.now_ms++;
        finish_ms();
    }
}

void stage_run_past(unsigned message) {
    for (unsigned i = 0; i < TRAFFIC[message].cycle_ms; i++) {
        stage_run(1);
        if (is_due(message, stage_now_ms())) {
            return;
        }
    }
}

void stage_deliver(hal_can_side_t side, const hal_can_frame_t *frames, unsigned count) {
    before();
    world.now_ms++;
    for (unsigned i = 0; i < count; i++) {
        if (stage_teller != NULL) {
            stage_teller->delivered(side, &frames[i]);
        }
        world_frame(side, frames[i], 0);
    }
    finish_ms();
}

static bool could_speak(unsigned message) {
    const traffic_message_t *m = &world.traffic[message];
    return (m->muted || m->frozen) && !is_off(world.traffic[message].side);
}

bool stage_can_speak(void) {
    bool can = false;
    for (unsigned m = 0; m < (unsigned)TRAFFIC_MESSAGES; m++) {
        can = can || could_speak(m);
    }
    return can;
}

void stage_speak(void) {
    before();
    world.now_ms++;
    for (unsigned m = 0; m < (unsigned)TRAFFIC_MESSAGES; m++) {
        const traffic_message_t kept = world.traffic[m];
        if (could_speak(m)) {
            world.traffic[m].frozen = false;
            world.traffic[m].counter = (uint8_t)(kept.counter + 100u);
            send(m);
            if (stage_teller != NULL) {
                stage_teller->spoke(m);
            }
            world.traffic[m].frozen = kept.frozen;
            world.traffic[m].muted = kept.muted;
        }
    }
    finish_ms();
}

/* What was recorded decides nothing, and a start looks through all of it: it finds nothing there. */
static void empty_recorder(void) {
    for (unsigned i = 0; i < (unsigned)AGV_RECORDER_EVENTS; i++) {
        world.recorder.events[i].kind = 0;
    }
}

/* rules.h knows of no damaged latch: the reason that stood in it is lost, and only that (FSM-7). */
static void judge_damaged(bool power_on) {
    static const char LOST[] = "FSM-7: after a reset the first reason is SUPERVISOR_RESET";
    if (!power_on && (strcmp(world.rules.broken, LOST) == 0)) {
        world.rules.broken[0] = '\0';
    }
}

void stage_restart(hal_reset_cause_t cause) {
    before();
    empty_recorder();
    if (stage_teller != NULL) {
        stage_teller->restarted(cause);
    }
    world.now_ms++;
    sim_hal_set_now_ms(&world.hal, (uint32_t)world.now_ms + world.offset_ms);
    stage.frames = 0;
    stage.bus = BUS_FINE;
    stage.ai_off = false;
    stage.stalled = false;
    stage.recover_in_ms = 0;
    world_restart(cause);
    if (stage.bad_latch) {
        judge_damaged(cause == HAL_RESET_POWER_ON);
    }
    stage.bad_latch = false;
    stage.latched_ms = world.now_ms;
    stage.stood = false;
    finish_ms();
}

static void tell_pause(uint32_t ms, bool frames_come) {
    if (stage_teller != NULL) {
        stage_teller->without_ticks(ms, frames_come);
    }
}

void stage_late(uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        before();
        if (i == 0u) {
            tell_pause(ms, true);
        }
        world.now_ms++;
        send_due();
    }
    before();
    world.now_ms++;
    finish_ms();
}

void stage_sleep(uint32_t ms) {
    before();
    tell_pause(ms, false);
    world.now_ms += ms;
    stage.wheels_ms = world.now_ms; /* before nothing was heard of them */
    finish_ms();
}

void stage_set_bus(stage_bus_t bus) {
    static const hal_can_state_t STATES[] = {HAL_CAN_ERROR_ACTIVE, HAL_CAN_ERROR_PASSIVE, HAL_CAN_BUS_OFF,
                                             HAL_CAN_BUS_OFF};
    stage.bus = (uint8_t)bus;
    world_disturb(HAL_CAN_VEHICLE, 0, (uint8_t)STATES[bus]);
}

void stage_set_ai_off(bool off) {
    stage.ai_off = off;
    world_disturb(HAL_CAN_AI, 0, off ? (uint8_t)HAL_CAN_BUS_OFF : (uint8_t)HAL_CAN_ERROR_ACTIVE);
}

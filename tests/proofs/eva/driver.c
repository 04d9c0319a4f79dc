/*
 * What frama-c's EVA runs: each entry point once, from any memory that keeps the invariants below, with any frame, time and
 * answer of the port. tests/proofs/eva/run says what is proved.
 */
#include <stddef.h>

#include "hal/clock.h"
#include "hal/inputs.h"
#include "hal/led.h"
#include "hal/reset.h"
#include "hal/safety_output.h"
#include "hal/self_test.h"
#include "hal/store.h"
#include "hal/watchdog.h"
#include "supervisor/core.h"

/* EVA's generators: any bytes, and any number between two. */
/*@ assigns \result \from min, max;
    ensures min <= \result <= max; */
extern unsigned int Frama_C_unsigned_int_interval(unsigned int min, unsigned int max);
/*@ requires \valid(bytes + (0 .. size - 1));
    assigns bytes[0 .. size - 1] \from size;
    ensures \initialized(bytes + (0 .. size - 1)); */
extern void Frama_C_make_unknown(char *bytes, size_t size);

struct hal {
    int nothing;
};

static struct hal port;
static agv_supervisor_t supervisor;
static agv_recorder_t recorder;

static uint32_t any(uint32_t lowest, uint32_t highest) {
    return Frama_C_unsigned_int_interval(lowest, highest);
}

static bool any_bool(void) {
    return any(0u, 1u) != 0u;
}

static void any_bytes(void *bytes, size_t size) {
    Frama_C_make_unknown((char *)bytes, size);
}

/* ---- The port: any answer that its contract allows; what it is handed is read ---- */

bool hal_can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame) {
    /*@ assert \valid(hal) && 0 <= side < HAL_CAN_SIDES && \valid_read(frame) && \initialized(&frame->data[0 .. 7]); */
    return any_bool();
}

void hal_can_purge(hal_t *hal, hal_can_side_t side) {
    /*@ assert \valid(hal) && 0 <= side < HAL_CAN_SIDES; */
}

void hal_can_recover(hal_t *hal, hal_can_side_t side) {
    /*@ assert \valid(hal) && 0 <= side < HAL_CAN_SIDES; */
}

void hal_can_status(hal_t *hal, hal_can_side_t side, hal_can_status_t *status) {
    /*@ assert \valid(hal) && 0 <= side < HAL_CAN_SIDES; */
    any_bytes(status, sizeof *status);
    status->state = (hal_can_state_t)any(HAL_CAN_ERROR_ACTIVE, HAL_CAN_BUS_OFF);
}

void hal_led_set(hal_t *hal, bool on) {
    /*@ assert \valid(hal); */
}

hal_reset_cause_t hal_reset_cause(hal_t *hal) {
    /*@ assert \valid(hal); */
    return (hal_reset_cause_t)any(HAL_RESET_POWER_ON, HAL_RESET_UNKNOWN);
}

void hal_safety_output_set(hal_t *hal, bool closed) {
    /*@ assert \valid(hal); */
}

size_t hal_store_read_latch(hal_t *hal, void *record, size_t size) {
    /*@ assert \valid(hal) && \valid((char *)record + (0 .. size - 1)); */
    any_bytes(record, size);
    return any(0u, HAL_STORE_LATCH_SIZE_MAX);
}

bool hal_store_write_latch(hal_t *hal, const void *record, size_t size) {
    /*@ assert \valid(hal) && size <= HAL_STORE_LATCH_SIZE_MAX && \initialized((char *)record + (0 .. size - 1)); */
    return any_bool();
}

bool hal_store_append(hal_t *hal, const void *record, size_t size) {
    /*@ assert \valid(hal) && size <= HAL_STORE_RECORD_SIZE_MAX && \initialized((char *)record + (0 .. size - 1)); */
    return any_bool();
}

void hal_watchdog_feed(hal_t *hal) {
    /*@ assert \valid(hal); */
}

void hal_inputs_read(hal_t *hal, hal_inputs_t *inputs) {
    /*@ assert \valid(hal); */
    any_bytes(inputs, sizeof *inputs);
}

bool hal_clock_second_ms(hal_t *hal, uint32_t *time_ms) {
    /*@ assert \valid(hal); */
    any_bytes(time_ms, sizeof *time_ms);
    return any_bool();
}

uint32_t hal_self_test(hal_t *hal) {
    /*@ assert \valid(hal); */
    return any(0u, UINT32_MAX);
}

/* ---- The invariants: all that is assumed of the memory between two calls ---- */

/* Every setting within its range: agv_config_check refuses others at the start, and the seal finds what changes later. Of the
   identifiers nothing is assumed. */
static void sound_config(agv_config_t *config) {
#define AGV_SETTING(name, preset, lowest, highest, unit, weakens, scope, meaning)                                      \
    config->name = (uint16_t)any(lowest, highest);
#define AGV_CHOICE(name, words, last, weakens, scope, meaning) config->name = (uint16_t)any(0u, last);
#include "agv/config_settings.def"
#undef AGV_SETTING
#undef AGV_CHOICE
}

static void sound_reset_button(agv_reset_button_t *reset) {
    reset->began_after = any_bool();
    reset->answered = any_bool();
    reset->was_up = any_bool();
    reset->is_pin = any_bool();
}

/* A truth is 0 or 1 in memory. */
static void sound_decisions(agv_core_t *core) {
    core->machine.park_released = any_bool();
    core->machine.output_closed = any_bool();
    core->machine.startup_reported = any_bool();
    core->faults.summary.eps_fault = any_bool();
    core->faults.outdated = any_bool();
    core->faults.transient = any_bool();
    core->faults.ai_loss_warns = any_bool();
    core->confirmation.off.at_tick = any_bool();
    core->confirmation.park.at_tick = any_bool();
    core->confirmation.park_sent = any_bool();
    core->confirmation.unconfirmed = any_bool();
    sound_reset_button(&core->reset_button);
    sound_reset_button(&core->reset_pin);
    core->stopping.stood = any_bool();
    core->stopping.not_stopping = any_bool();
    core->stopping.moving = any_bool();
    core->led.on = any_bool();
    core->transmitter.report.park_sent = any_bool();
    core->transmitter.report.hold_sent = any_bool();
    core->hold.handed_over = any_bool();
    core->stalled = any_bool();
    core->stall_begins = any_bool();
    core->hold.taken = any_bool();
    core->hardware.was_closed = any_bool();
    core->transmitter.status_again = any_bool();
    core->transmitter.throttle_0_waits = any_bool();
}

static void sound_observations(agv_core_t *core) {
    core->mode.heard = any_bool();
    core->mode.engaged = any_bool();
    core->mode.manual = any_bool();
    core->vehicle.throttle_known = any_bool();
    core->vehicle.angle_known = any_bool();
    core->vehicle.eps_in_angle_mode = any_bool();
    core->vehicle.vcu_speed_seen = any_bool();
    core->vehicle.wheels_fresh = any_bool();
    core->vehicle.vcu_alive = any_bool();
    core->vehicle.wheels_doubted = any_bool();
    core->commands.autopilot_off = any_bool();
    core->gateway.steering_known = any_bool();
    core->gateway.throttle_known = any_bool();
    core->gateway.gear_waits = any_bool();
    core->motion_checks.reported = any_bool();
    core->status_checks.ai_alarm = any_bool();
    core->status_checks.reported = any_bool();
    core->status_checks.ai_alarm_armed = any_bool();
    for (unsigned i = 0u; i < AGV_NODE_COUNT; i++) {
        core->liveness.heartbeats[i].counter_known = any_bool();
        core->liveness.heartbeats[i].repeated = any_bool();
    }
}

static void sound_budget(agv_budget_t *budget) {
    budget->present = any_bool();
}

static void sound_counts(agv_core_t *core) {
    sound_budget(&core->mode.manual_spent);
    sound_budget(&core->mode.both_spent);
    sound_budget(&core->mode.none_spent);
    sound_budget(&core->stopping.moved);
    sound_budget(&core->hardware.mismatch);
    for (unsigned i = 0u; i < AGV_COMMAND_COUNT; i++) {
        core->intrusion.fast_gaps[i].present = any_bool();
    }
    for (unsigned i = 0u; i < (unsigned)AGV_BUDGET_COUNT; i++) {
        sound_budget(&core->motion_checks.budgets[i]);
    }
    for (unsigned i = 0u; i < AGV_SCORED_EPS_BITS; i++) {
        core->status_checks.eps_bits[i].present = any_bool();
    }
    for (unsigned i = 0u; i < AGV_SCORED_VALUES; i++) {
        core->status_checks.values[i].present = any_bool();
    }
    core->status_checks.eps_mode.present = any_bool();
    core->status_checks.hold_angle.present = any_bool();
}

static void sound_truths(agv_core_t *core) {
    sound_decisions(core);
    sound_observations(core);
    sound_counts(core);
}

/*
 * Bits of `kept` are messages, `oldest` and `next_to_age` are places. The second copy of status_frame_id is in its range: where it
 * is not, agv_config_check refuses it (tests/proofs/bit-flips). All else is any bytes.
 */
static void any_sound_state(void) {
    agv_core_t *const core = agv_core_of(&supervisor);
    any_bytes(&supervisor, sizeof supervisor);
    any_bytes(&recorder, sizeof recorder);
    sound_config(&core->config);
    sound_truths(core);
    core->transmitter.kept = any(0u, (1u << AGV_MSG_COUNT) - 1u);
    core->status_frame_id = (uint16_t)any(0u, AGV_ID_MAX);
    core->mode.oldest = (uint8_t)any(0u, 2u);
    core->liveness.next_to_age = (uint8_t)any(0u, AGV_MSG_COUNT - 1u);
    supervisor.receive_alive = any_bool();
}

/* ---- And they hold again. A truth that were neither 0 nor 1 would be an alarm of its own ---- */

static void within(uint32_t value, uint32_t lowest, uint32_t highest) {
    /*@ assert lowest <= value <= highest; */
}

static void check_memory(const agv_core_t *core) {
    /*@ assert core->transmitter.kept < (1 << AGV_MSG_COUNT); */
    /*@ assert core->mode.oldest < 3; */
    /*@ assert core->liveness.next_to_age < AGV_MSG_COUNT; */
}

static void check_invariants(const agv_core_t *core) {
    check_memory(core);
#define AGV_SETTING(name, preset, lowest, highest, unit, weakens, scope, meaning)                                      \
    within(core->config.name, lowest, highest);
#define AGV_CHOICE(name, words, last, weakens, scope, meaning) within(core->config.name, 0u, last);
#include "agv/config_settings.def"
#undef AGV_SETTING
#undef AGV_CHOICE
}

/* ---- The entry points ---- */

void eva_frame(void);
void eva_tick(void);
void eva_config(void);
void eva_start(void);

static agv_ports_t any_ports(void) {
    return (agv_ports_t){.hal = &port, .recorder = &recorder};
}

void eva_frame(void) {
    const agv_ports_t ports = any_ports();
    hal_can_frame_t frame;
    any_sound_state();
    any_bytes(&frame, sizeof frame);
    agv_supervisor_frame(&supervisor, &ports, (hal_can_side_t)any(HAL_CAN_VEHICLE, HAL_CAN_AI), &frame);
    check_invariants(agv_core_read(&supervisor));
}

void eva_tick(void) {
    const agv_ports_t ports = any_ports();
    any_sound_state();
    agv_supervisor_tick(&supervisor, &ports, any(0u, UINT32_MAX));
    check_invariants(agv_core_read(&supervisor));
}

/* The check of any configuration. That it passes none with a setting out of its range is for the tests to show. */
void eva_config(void) {
    agv_config_t config;
    any_bytes(&config, sizeof config);
    (void)agv_config_check(&config);
    (void)agv_config_weakens(&config, any(0u, UINT32_MAX));
    (void)agv_config_checksum(&config);
}

/* Any memory before, and a configuration whose settings are within their ranges; what a start does with another, the defaults
   instead, is what the other entry points do with one that has changed. */
void eva_start(void) {
    const agv_ports_t ports = any_ports();
    agv_config_t config;
    any_bytes(&supervisor, sizeof supervisor);
    any_bytes(&recorder, sizeof recorder);
    any_bytes(&config, sizeof config);
    sound_config(&config);
    agv_supervisor_start(&supervisor, &ports, &config, any(0u, UINT32_MAX));
    check_memory(agv_core_read(&supervisor));
}

#include "abstract.h"

#include <string.h>

#include "model.h"
#include "observe/deadlines.h"
#include "supervisor/supervisor_internal.h"

/* The timers (timers.h) that are part of the key in a state. Bit n of a set is timer n. */
#define TIMER(name) (UINT64_C(1) << (unsigned)AGV_TIMER_##name)
#define EVENT(fault) TIMER(EVENT_##fault)
#define MESSAGE(name) TIMER(MESSAGE_##name)

_Static_assert(AGV_TIMER_COUNT <= 64, "a set of timers must fit in 64 bits");

static const uint64_t ALWAYS = TIMER(BUS_OFF) | TIMER(BOTH_MODES) | TIMER(WATCHDOG_FED) | TIMER(TX_TURN_SIGNAL) |
                               TIMER(TX_GEAR) | TIMER(TX_THROTTLE) | TIMER(TX_STEERING) | TIMER(TX_STATUS) |
                               MESSAGE(VEHICLE_STATUS) | MESSAGE(STEERING_STATUS) | MESSAGE(GEAR_STATUS) |
                               MESSAGE(THROTTLE_STATUS) | MESSAGE(EPS_STATUS) | MESSAGE(WHEEL_SPEED);
static const uint64_t IN_INIT = TIMER(INIT_GOOD) | TIMER(STARTUP);
static const uint64_t SUPERVISING = MESSAGE(TURN_SIGNAL_COMMAND) | TIMER(DISENGAGED) | TIMER(NO_MODE);
static const uint64_t WHILE_ENGAGED = TIMER(ENGAGED) | TIMER(AI_NEVER_SEEN) | MESSAGE(GEAR_COMMAND) |
                                      MESSAGE(THROTTLE_COMMAND) | MESSAGE(STEERING_COMMAND);
static const uint64_t LATCHED = TIMER(WHEELS_SLOW) | TIMER(STANDSTILL);

enum { COUNTED_MS = 1220 };

bool abstract_coarse;

static const agv_core_t *core(void) {
    return agv_core_read(&testbed.supervisor);
}

/* A transient fault ends after event_hold_ms. Until then the ones that trip prevent a reset, except those of the AI
 * computer. */
static const uint64_t EVENTS = EVENT(SUPERVISOR_RESET) | EVENT(TX_GATE_REFUSED) | EVENT(STEP_OVERRUN) |
                               EVENT(FOREIGN_COMMAND_SENDER) | EVENT(MODE_FLAPPING);

/* Without the times that no longer have an effect. */
static uint64_t latched_timers(void) {
    const agv_reset_button_t *reset = &core()->reset_button;
    const agv_confirmation_t *sums = &core()->confirmation;
    uint64_t set = LATCHED;
    if (core()->machine.state == AGV_STATE_SAFE) {
        set |= EVENTS | ((reset->began_after && !reset->answered) ? (TIMER(PRESS) | TIMER(PRESS_LONG)) : 0);
    }
    set |= core()->stopping.stood ? 0 : TIMER(STOP);
    set |= ((sums->off.sum_ms | sums->park.sum_ms) != 0) ? TIMER(CONFIRMED) : 0;
    return set;
}

static uint64_t timers(void) {
    const bool waits_for_park = core()->config.park == AGV_PARK_AT_STANDSTILL;
    const uint64_t park = waits_for_park ? (TIMER(PARK_WAIT) | TIMER(WHEELS_SLOW)) : 0;
    switch (core()->machine.state) {
    case AGV_STATE_INIT:
        return ALWAYS | IN_INIT | EVENTS | park;
    case AGV_STATE_STANDBY:
    case AGV_STATE_ACTIVE:
        return ALWAYS | SUPERVISING | (agv_mode_is_engaged(&core()->mode) ? WHILE_ENGAGED : 0);
    default:
        return ALWAYS | latched_timers() | park;
    }
}

static bool runs(unsigned timer) {
    return core()->timers.phase[timer] == AGV_TIMER_RUNNING;
}

/* The running timers of a set that will reach their limit within the given time. */
static uint64_t timers_that_expire_within(uint64_t set, uint32_t ms) {
    agv_timers_t copy = core()->timers;
    uint64_t over = 0;
    agv_timers_advance(&copy, &core()->config, copy.now_ms + ms, 0);
    for (unsigned i = 0; i < AGV_TIMER_COUNT; i++) {
        if ((((set >> i) & 1) != 0) && runs(i) && agv_timer_reached(&copy, i)) {
            over |= UINT64_C(1) << i;
        }
    }
    return over;
}

/* Time for which all conditions of a reset have held. */
static uint16_t all_held_ms(void) {
    uint16_t least_ms = UINT16_MAX;
    for (unsigned i = 0; i < AGV_RESET_CONDITIONS; i++) {
        const uint16_t held_ms = core()->reset_button.held_ms[i];
        least_ms = (held_ms < least_ms) ? held_ms : least_ms;
    }
    return least_ms;
}

/* The sums and budgets that reach their limit in the next millisecond, and whether the conditions of a reset do. */
static unsigned full_next(void) {
    const agv_core_t *c = core();
    const agv_config_t *config = &c->config;
    const uint32_t limits_ms[AGV_BUDGET_SPEED] = {config->steering_deviation_ms, config->throttle_deviation_ms,
                                                  config->gear_deviation_ms, config->autopilot_off_ms,
                                                  config->throttle_in_park_ms};
    unsigned full = 0;
    if (agv_state_is_latched((agv_state_t)c->machine.state)) {
        full |= (c->confirmation.off.sum_ms + 1 == config->confirm_timeout_ms) ? 1 : 0;
        full |= (c->confirmation.park.sum_ms + 1 == config->park_confirm_timeout_ms) ? 2 : 0;
        full |= (all_held_ms() + 1 == config->reset_hold_ms) ? 4 : 0;
    } else if (agv_mode_is_engaged(&c->mode)) {
        for (unsigned i = 0; i < AGV_BUDGET_SPEED; i++) {
            full |= (c->motion_checks.budgets[i].value_ms + 1u == limits_ms[i]) ? (8u << i) : 0u;
        }
    } else {
        /* no sums or budgets in this state */
    }
    return full;
}

/* The first time that expires with the next tick; 0: none. */
static uint8_t first_timer_that_expires_next(void) {
    const uint64_t set = timers_that_expire_within(timers(), 1);
    for (unsigned i = 0; i < AGV_TIMER_COUNT; i++) {
        if (((set >> i) & 1) != 0) {
            return (uint8_t)(i + 1);
        }
    }
    for (unsigned i = 0; i < AGV_BUDGET_SPEED + 3; i++) {
        if (((full_next() >> i) & 1) != 0) {
            return (uint8_t)((unsigned)AGV_TIMER_COUNT + 1 + i);
        }
    }
    return 0;
}

static uint64_t running(void) {
    const uint64_t set = timers();
    uint64_t some = 0;
    for (unsigned i = 0; i < AGV_TIMER_COUNT; i++) {
        some |= ((((set >> i) & 1) != 0) && runs(i)) ? (UINT64_C(1) << i) : 0;
    }
    for (unsigned m = 0; m < TRAFFIC_MESSAGES; m++) {
        if (model_flows(m) && !testbed.traffic[m].frozen) {
            some &= ~(UINT64_C(1) << ((unsigned)AGV_TIMER_MESSAGE + m)); /* restarted by its own frames */
        }
    }
    return some;
}

/* Whether sums, budgets or reset conditions count, which are not timers. */
static bool counts(void) {
    return agv_state_is_latched((agv_state_t)core()->machine.state) || agv_mode_is_engaged(&core()->mode);
}

uint32_t abstract_horizon_ms(void) {
    static const uint32_t HORIZONS_MS[] = {110, 1220, 3020, 5120, 10020};
    const uint64_t set = running();
    uint32_t ms = 0;
    for (unsigned i = 0; i < sizeof HORIZONS_MS / sizeof HORIZONS_MS[0]; i++) {
        ms = HORIZONS_MS[i];
        if ((timers_that_expire_within(set, ms) == set) && ((ms >= COUNTED_MS) || !counts())) {
            break;
        }
    }
    return ms;
}

/* ---- The key ---- */

static uint8_t bits(const bool *bit, unsigned count) {
    uint8_t byte = 0;
    for (unsigned i = 0; i < count; i++) {
        byte = (uint8_t)(byte | ((bit[i] ? 1u : 0u) << i));
    }
    return byte;
}

static uint8_t phase(unsigned timer) {
    return core()->timers.phase[timer];
}

static uint8_t phases(unsigned a, unsigned b, unsigned c) {
    return (uint8_t)(phase(a) | (phase(b) << 2) | (phase(c) << 4));
}

/* A value reduced to three: zero, in between, full. */
static uint8_t zero_part_or_full(uint32_t value, bool full) {
    if (full) {
        return 2;
    }
    return (value != 0) ? 1 : 0;
}

static uint8_t worst(uint8_t a, uint8_t b) {
    return (a > b) ? a : b;
}

static uint8_t score(const agv_score_t *s) {
    return zero_part_or_full(s->value, s->present);
}

/* The highest score of the status checks. */
static uint8_t worst_score(void) {
    const agv_status_checks_t *checks = &core()->status_checks;
    uint8_t most = score(&checks->eps_mode);
    for (unsigned i = 0; i < AGV_SCORED_EPS_BITS; i++) {
        most = worst(most, score(&checks->eps_bits[i]));
    }
    for (unsigned i = 0; i < AGV_SCORED_VALUES; i++) {
        most = worst(most, score(&checks->values[i]));
    }
    return most;
}

static uint8_t worst_budget(void) {
    uint8_t most = 0;
    for (unsigned i = 0; i < AGV_BUDGET_SPEED; i++) {
        const agv_budget_t *b = &core()->motion_checks.budgets[i];
        most = worst(most, zero_part_or_full(b->value_ms, b->present));
    }
    return most;
}

/* Engagements that count for MODE_FLAPPING. */
static uint8_t engagements(void) {
    uint8_t count = 0;
    for (unsigned i = (unsigned)AGV_TIMER_ENGAGEMENT_1; i <= AGV_TIMER_ENGAGEMENT_3; i++) {
        count = (uint8_t)(count + (runs(i) ? 1 : 0));
    }
    return count;
}

/*
 * 0: no press; 1: began before the trip; 2: began after it; in SAFE also 3: long enough; 4: answered without a reset;
 * 5: no press, and the next one has no rising edge yet.
 */
static uint8_t press(void) {
    const agv_reset_button_t *reset = &core()->reset_button;
    if (reset->button != AGV_BUTTON_DOWN) {
        return reset->was_up ? 0 : 5;
    }
    if (!reset->began_after || (core()->machine.state != AGV_STATE_SAFE)) {
        return reset->began_after ? 2 : 1;
    }
    if (reset->answered) {
        return 4;
    }
    return agv_timer_reached(&core()->timers, AGV_TIMER_PRESS) ? 3 : 2;
}

/* 0: the vehicle has not stood since the trip; 1: it has; 2: too late, or it moves again. */
static uint8_t standstill_since_the_trip(void) {
    const agv_stopping_t *stopping = &core()->stopping;
    if (stopping->not_stopping || stopping->moving) {
        return 2;
    }
    return stopping->stood ? 1 : 0;
}

/* The higher of the two sums of FSM-4. */
static uint8_t unconfirmed(void) {
    const agv_confirmation_t *sums = &core()->confirmation;
    const agv_config_t *config = &core()->config;
    return worst(zero_part_or_full(sums->off.sum_ms, sums->off.sum_ms >= config->confirm_timeout_ms),
                 zero_part_or_full(sums->park.sum_ms, sums->park.sum_ms >= config->park_confirm_timeout_ms));
}

static bool messages_fresh(void) {
    return agv_deadlines_messages_fresh(&core()->liveness, &core()->timers, &core()->config);
}

/* Whether 065h may be sent, as the supervisor decides it for its transmitter. */
static bool is_holdable(void) {
    const agv_ports_t none = {0};
    agv_core_t copy = *core();
    return agv_core_orders(&copy, &none).holdable;
}

static bool waits_to_send(void) {
    bool waits = false;
    for (unsigned i = 0; i < AGV_COMMAND_COUNT; i++) {
        waits = waits || agv_timer_is_started(&core()->timers, (unsigned)AGV_TIMER_TX_TURN_SIGNAL + i);
    }
    return waits || agv_timer_is_started(&core()->timers, AGV_TIMER_TX_STATUS) ||
           agv_timer_is_started(&core()->timers, AGV_TIMER_TX_AI);
}

static void always(abstract_t *key) {
    const agv_core_t *c = core();
    const sim_hal_can_t *can = testbed.hal.can;
    const bool whats[] = {agv_liveness_alive(&c->liveness, AGV_NODE_VCU),
                          agv_liveness_alive(&c->liveness, AGV_NODE_EPS),
                          (c->machine.state == AGV_STATE_INIT) && messages_fresh(),
                          c->transmitter.kept != 0,
                          waits_to_send(),
                          can[HAL_CAN_VEHICLE].full,
                          can[HAL_CAN_AI].full};
    const bool supervises = !agv_state_commands_safe((agv_state_t)c->machine.state);
    const bool goes_by_gear =
        agv_state_is_latched((agv_state_t)c->machine.state) || (supervises && agv_mode_is_engaged(&c->mode));
    const bool more[] = {agv_supervisor_output_closed(&testbed.supervisor),
                         model.button && (c->machine.state != AGV_STATE_INIT),
                         goes_by_gear && (model.gear == MODEL_P),
                         model.ai_off,
                         model.bad_latch,
                         model.stalled,
                         !abstract_coarse && model_wrapped(),
                         (phase(AGV_TIMER_WATCHDOG_FED) == AGV_TIMER_REACHED)};
    key->byte[0] = c->machine.state;
    key->byte[1] = supervises ? model.defect : DEFECT_ROWS[model.defect].like;
    key->byte[2] = bits(whats, 7);
    key->byte[3] = bits(more, 8);
    key->byte[4] =
        (uint8_t)(c->mode.bits | phase(AGV_TIMER_BOTH_MODES) | (c->mode.engaged ? 4 : 0) | (c->mode.manual ? 8 : 0));
    if ((c->machine.state == AGV_STATE_INIT) && !c->mode.manual) {
        key->byte[4] = 0;
    }
    key->byte[5] = (uint8_t)(model.bus | (phase(AGV_TIMER_BUS_OFF) << 2));
    key->byte[6] = first_timer_that_expires_next();
}

static void in_init(abstract_t *key) {
    const bool whats[] = {core()->machine.startup_reported, core()->faults.summary.cause != AGV_FAULT_NONE,
                          core()->faults.summary.ai_cause != AGV_FAULT_NONE, core()->machine.park_released};
    key->byte[8] = bits(whats, 4);
    key->byte[9] = phases(AGV_TIMER_INIT_GOOD, AGV_TIMER_STARTUP, AGV_TIMER_STARTUP);
}

static void supervising(abstract_t *key) {
    const agv_core_t *c = core();
    const bool whats[] = {c->status_checks.ai_alarm_armed, c->faults.summary.ai_cause != AGV_FAULT_NONE,
                          c->transmitter.throttle_0_waits};
    key->byte[8] = (uint8_t)(bits(whats, 3) | (engagements() << 4) | (phase(AGV_TIMER_DISENGAGED) << 6));
    key->byte[9] = (uint8_t)(c->liveness.heartbeats[AGV_NODE_AI].state | (phase(AGV_TIMER_NO_MODE) << 4));
    if (agv_mode_is_engaged(&c->mode)) {
        key->byte[10] = phases(AGV_TIMER_ENGAGED, AGV_TIMER_AI_NEVER_SEEN, AGV_TIMER_MESSAGE_GEAR_COMMAND);
        key->byte[11] =
            (uint8_t)(phase(AGV_TIMER_MESSAGE_STEERING_COMMAND) | (worst_score() << 2) | (worst_budget() << 4));
    }
}

static void in_latched(abstract_t *key) {
    const agv_core_t *c = core();
    const agv_state_machine_t *m = &c->machine;
    const bool waits = (c->config.park == AGV_PARK_AT_STANDSTILL) && !m->park_released;
    const bool whats[] = {m->park_released,
                          is_holdable(),
                          m->unresettable != AGV_FAULT_NONE,
                          model.wheels_turn && (waits || (standstill_since_the_trip() != 0)),
                          c->faults.summary.cause != AGV_FAULT_NONE,
                          c->faults.summary.ai_cause != AGV_FAULT_NONE,
                          all_held_ms() >= c->config.reset_hold_ms};
    key->byte[8] = bits(whats, 7);
    if (abstract_coarse) {
        key->byte[9] = (uint8_t)(press() | (worst(unconfirmed(), (standstill_since_the_trip() == 2) ? 2 : 0) << 5));
    } else {
        key->byte[9] = (uint8_t)(press() | (standstill_since_the_trip() << 3) | (unconfirmed() << 5));
    }
}

void abstract_now(abstract_t *key) {
    memset(key, 0, sizeof *key);
    always(key);
    switch (core()->machine.state) {
    case AGV_STATE_INIT:
        in_init(key);
        break;
    case AGV_STATE_STANDBY:
    case AGV_STATE_ACTIVE:
        supervising(key);
        break;
    default:
        in_latched(key);
        break;
    }
}

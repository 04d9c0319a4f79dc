#include "abstract.h"

#include <string.h>

#include "observe/deadlines.h"
#include "stage.h"
#include "supervisor/supervisor_internal.h"

/* Which of the timers of a supervisor (timers.h) count in a state; bit n of a set is the timer n. */
#define TIMER(name) (UINT64_C(1) << (unsigned)AGV_TIMER_##name)
#define EVENT(fault) TIMER(EVENT_##fault)
#define MESSAGE(name) TIMER(MESSAGE_##name)

_Static_assert(AGV_TIMER_COUNT <= 64, "a set of timers is a word");

static const uint64_t ALWAYS = TIMER(BUS_OFF) | TIMER(BOTH_MODES) | TIMER(WATCHDOG_FED) | TIMER(TX_TURN_SIGNAL) |
                               TIMER(TX_GEAR) | TIMER(TX_THROTTLE) | TIMER(TX_STEERING) | MESSAGE(VEHICLE_STATUS) |
                               MESSAGE(STEERING_STATUS) | MESSAGE(GEAR_STATUS) | MESSAGE(THROTTLE_STATUS) |
                               MESSAGE(EPS_STATUS) | MESSAGE(WHEEL_SPEED);
static const uint64_t IN_INIT = TIMER(INIT_GOOD) | TIMER(STARTUP);
static const uint64_t SUPERVISING = MESSAGE(TURN_SIGNAL_COMMAND);
static const uint64_t WHILE_ENGAGED = TIMER(ENGAGED) | TIMER(AI_NEVER_SEEN) | TIMER(STEERING_OFF) |
                                      TIMER(THROTTLE_IN_PARK) | MESSAGE(GEAR_COMMAND) | MESSAGE(THROTTLE_COMMAND) |
                                      MESSAGE(STEERING_COMMAND);
static const uint64_t IN_SAFE = TIMER(STANDSTILL) | TIMER(RESET_GOOD) | TIMER(PRESS);
static const uint64_t UNTIL_SAFE = TIMER(UNCONFIRMED) | TIMER(PARK_SENT);

static const agv_core_t *core(void) {
    return agv_core_read(&world.supervisor);
}

/* A transient fault is over event_hold_ms after it; those that trip keep a reset from being accepted, but the AI's. */
static const uint64_t EVENTS =
    EVENT(SUPERVISOR_RESET) | EVENT(TX_GATE_REFUSED) | EVENT(STEP_OVERRUN) | EVENT(FOREIGN_COMMAND_SENDER);

static uint64_t timers(void) {
    const bool waits_for_park = core()->config.park == (uint16_t)AGV_PARK_AT_STANDSTILL;
    uint64_t set = ALWAYS;
    switch (core()->machine.state) {
    case AGV_STATE_INIT:
        set |= IN_INIT | EVENTS | (waits_for_park ? (TIMER(PARK_WAIT) | TIMER(STANDSTILL)) : 0u);
        break;
    case AGV_STATE_STANDBY:
    case AGV_STATE_ACTIVE:
        set |= SUPERVISING | (agv_mode_is_engaged(&core()->mode) ? WHILE_ENGAGED : 0u);
        break;
    case AGV_STATE_TRIPPED:
        set |= UNTIL_SAFE | (waits_for_park ? (TIMER(PARK_WAIT) | TIMER(STANDSTILL)) : 0u);
        break;
    default:
        set |= IN_SAFE | EVENTS;
        break;
    }
    return set;
}

static bool runs(unsigned timer) {
    return core()->timers.phase[timer] == (uint8_t)AGV_TIMER_RUNNING;
}

/* The timers of a set that have reached their limit so much later, and not yet. */
static uint64_t over_in(uint64_t set, uint32_t ms) {
    agv_timers_t copy = core()->timers;
    uint64_t over = 0;
    copy.now_ms += ms;
    for (unsigned i = 0; i < (unsigned)AGV_TIMER_COUNT; i++) {
        if ((((set >> i) & 1u) != 0u) && runs(i) && agv_timer_reached(&copy, i)) {
            over |= UINT64_C(1) << i;
        }
    }
    return over;
}

/* The first of the times that will be over with the next tick, and not before; 0: none. */
static uint8_t eve(void) {
    const uint64_t set = over_in(timers(), 1);
    for (unsigned i = 0; i < (unsigned)AGV_TIMER_COUNT; i++) {
        if (((set >> i) & 1u) != 0u) {
            return (uint8_t)(i + 1u);
        }
    }
    return 0;
}

static uint64_t running(void) {
    const uint64_t set = timers();
    uint64_t some = 0;
    for (unsigned i = 0; i < (unsigned)AGV_TIMER_COUNT; i++) {
        some |= ((((set >> i) & 1u) != 0u) && runs(i)) ? (UINT64_C(1) << i) : 0u;
    }
    for (unsigned m = 0; m < (unsigned)WORLD_MESSAGES; m++) {
        if (stage_flows(m) && !world.traffic[m].frozen) {
            some &= ~(UINT64_C(1) << ((unsigned)AGV_TIMER_MESSAGE + m)); /* comes on */
        }
    }
    return some;
}

uint32_t abstract_horizon_ms(void) {
    static const uint32_t HORIZONS_MS[] = {110, 520, 1020, 3020, 10020};
    const uint64_t set = running();
    uint32_t ms = 0;
    for (unsigned i = 0; i < sizeof HORIZONS_MS / sizeof HORIZONS_MS[0]; i++) {
        ms = HORIZONS_MS[i];
        if (over_in(set, ms) == set) {
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
    return (uint8_t)(phase(a) | (phase(b) << 2u) | (phase(c) << 4u));
}

static bool is_counting(unsigned first, unsigned last) {
    bool counts = false;
    for (unsigned row = first; row <= last; row++) {
        counts = counts ||
                 ((core()->status_checks.in_a_row[row] != 0u) && (core()->status_checks.in_a_row[row] != UINT8_MAX));
    }
    return counts;
}

static bool messages_fresh(void) {
    return agv_deadlines_messages_fresh(&core()->liveness, &core()->timers, &core()->config);
}

/* Whether 065h may be sent, as the supervisor tells its transmitter. */
static bool is_holdable(void) {
    const agv_ports_t none = {0};
    agv_core_t copy = *core();
    return agv_core_orders(&copy, &none).holdable;
}

static bool waits_to_send(void) {
    bool waits = false;
    for (unsigned i = 0; i < (unsigned)AGV_COMMAND_COUNT; i++) {
        waits = waits || agv_timer_runs(&core()->timers, (unsigned)AGV_TIMER_TX_TURN_SIGNAL + i);
    }
    return waits;
}

static void always(abstract_t *key) {
    const agv_core_t *c = core();
    const sim_hal_can_t *can = world.hal.can;
    const bool whats[] = {agv_liveness_alive(&c->liveness, AGV_NODE_VCU),
                          agv_liveness_alive(&c->liveness, AGV_NODE_EPS),
                          (c->machine.state == (uint8_t)AGV_STATE_INIT) && messages_fresh(),
                          c->transmitter.kept != 0u,
                          waits_to_send(),
                          can[HAL_CAN_VEHICLE].full,
                          can[HAL_CAN_AI].full};
    const bool supervises = !agv_state_commands_safe((agv_state_t)c->machine.state);
    const bool goes_by_gear =
        agv_state_is_latched((agv_state_t)c->machine.state) || (supervises && agv_mode_is_engaged(&c->mode));
    const bool more[] = {agv_supervisor_output_closed(&world.supervisor),
                         stage.button && (c->machine.state != (uint8_t)AGV_STATE_INIT),
                         goes_by_gear && (stage.gear == (uint8_t)STAGE_P),
                         stage.ai_off,
                         stage.bad_latch,
                         stage.stalled,
                         stage_wrapped(),
                         (phase(AGV_TIMER_WATCHDOG_FED) == (uint8_t)AGV_TIMER_REACHED)};
    key->byte[0] = c->machine.state;
    key->byte[1] = supervises ? stage.illness : ILLNESS[stage.illness].like;
    key->byte[2] = bits(whats, 7);
    key->byte[3] = bits(more, 8);
    key->byte[4] = (uint8_t)(c->mode.value | (phase(AGV_TIMER_BOTH_MODES) << 2u));
    if ((c->machine.state == (uint8_t)AGV_STATE_INIT) && (c->mode.value != (uint8_t)AGV_MODE_MANUAL)) {
        key->byte[4] = 0;
    }
    key->byte[5] = (uint8_t)(stage.bus | (phase(AGV_TIMER_BUS_OFF) << 2u));
    key->byte[6] = eve();
}

static void in_init(abstract_t *key) {
    const bool whats[] = {core()->machine.startup_reported, core()->faults.summary.cause != (uint8_t)AGV_FAULT_NONE,
                          core()->faults.summary.ai_cause != (uint8_t)AGV_FAULT_NONE, core()->machine.park_released};
    key->byte[8] = bits(whats, 4);
    key->byte[9] = phases(AGV_TIMER_INIT_GOOD, AGV_TIMER_STARTUP, AGV_TIMER_STARTUP);
}

static void supervising(abstract_t *key) {
    const agv_core_t *c = core();
    const bool whats[] = {c->status_checks.ai_alarm_armed, is_counting(0, AGV_ROW_EPS_SUPPLY_LAST),
                          is_counting(AGV_ROW_EPS_MODE, AGV_ROW_STEERING_ANGLE),
                          c->faults.summary.ai_cause != (uint8_t)AGV_FAULT_NONE};
    key->byte[8] = bits(whats, 4);
    key->byte[9] = c->liveness.heartbeats[AGV_NODE_AI].state;
    if (agv_mode_is_engaged(&c->mode)) {
        key->byte[10] = phases(AGV_TIMER_ENGAGED, AGV_TIMER_AI_NEVER_SEEN, AGV_TIMER_STEERING_OFF);
        key->byte[11] =
            phases(AGV_TIMER_THROTTLE_IN_PARK, AGV_TIMER_MESSAGE_GEAR_COMMAND, AGV_TIMER_MESSAGE_STEERING_COMMAND);
    }
}

static void tripped(abstract_t *key) {
    const agv_core_t *c = core();
    const agv_state_machine_t *m = &c->machine;
    const bool waits = (c->config.park == (uint16_t)AGV_PARK_AT_STANDSTILL) && !m->park_released;
    const bool whats[] = {m->pressed_after_trip,
                          m->park_released,
                          is_holdable(),
                          m->unresettable != (uint8_t)AGV_FAULT_NONE,
                          agv_fault_monitor_is_active(&c->faults, AGV_FAULT_SAFE_STATE_UNCONFIRMED),
                          waits && stage.wheels_turn,
                          waits && agv_timer_runs(&c->timers, AGV_TIMER_STANDSTILL)};
    key->byte[8] = bits(whats, 7);
    key->byte[9] = phases(AGV_TIMER_UNCONFIRMED, AGV_TIMER_PARK_SENT, AGV_TIMER_PARK_SENT);
}

static void in_safe(abstract_t *key) {
    const agv_core_t *c = core();
    const agv_state_machine_t *m = &c->machine;
    const bool whats[] = {m->button_before,
                          m->pressed_after_trip,
                          m->press_refused,
                          messages_fresh(),
                          is_holdable(),
                          stage.wheels_turn,
                          c->faults.summary.cause != (uint8_t)AGV_FAULT_NONE,
                          c->faults.summary.ai_cause != (uint8_t)AGV_FAULT_NONE};
    key->byte[8] = bits(whats, 8);
    key->byte[9] = m->unresettable;
    key->byte[10] = phases(AGV_TIMER_STANDSTILL, AGV_TIMER_RESET_GOOD, AGV_TIMER_PRESS);
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
    case AGV_STATE_TRIPPED:
        tripped(key);
        break;
    default:
        in_safe(key);
        break;
    }
}

#include "abstract.h"

#include <string.h>

#include "agv/core.h"
#include "stage.h"

/* Which of the times of a supervisor (watch.h) count in a state; bit n of a set is the watch n. */
#define WATCH(name) (UINT64_C(1) << (unsigned)AGV_WATCH_##name)
#define MESSAGE(name) (UINT64_C(1) << ((unsigned)AGV_WATCH_MESSAGE + (unsigned)AGV_MSG_##name))

static const uint64_t ALWAYS = WATCH(BUS_OFF) | WATCH(BOTH_MODES) | WATCH(UNFED) |
                               (UINT64_C(0xF) << (unsigned)AGV_WATCH_TX) | MESSAGE(VEHICLE_STATUS) |
                               MESSAGE(STEERING_STATUS) | MESSAGE(GEAR_STATUS) | MESSAGE(THROTTLE_STATUS) |
                               MESSAGE(EPS_STATUS) | MESSAGE(WHEEL_SPEED);
static const uint64_t IN_INIT = WATCH(INIT_GOOD) | WATCH(INIT);
static const uint64_t SUPERVISING = MESSAGE(TURN_SIGNAL_COMMAND);
static const uint64_t WHILE_ENGAGED = WATCH(ENGAGED) | WATCH(AI_AWAITED) | WATCH(STEERING_OFF) |
                                      WATCH(THROTTLE_IN_PARK) | MESSAGE(GEAR_COMMAND) | MESSAGE(THROTTLE_COMMAND) |
                                      MESSAGE(STEERING_COMMAND);
static const uint64_t IN_SAFE = WATCH(STANDSTILL) | WATCH(RESET_GOOD) | WATCH(PRESS);
static const uint64_t UNTIL_SAFE = WATCH(UNCONFIRMED) | WATCH(PARK_SENT);

static const agv_core_t *core(void) {
    return &world.supervisor.core;
}

/* An event is over event_hold_ms after it; those that trip keep a reset from being accepted. */
static uint64_t events(void) {
    static const uint8_t TRIPS[] = {0, 1, 2,
                                    4}; /* of the events in their order: the others come from the AI, or warn */
    uint64_t set = 0;
    for (unsigned i = 0; i < sizeof TRIPS; i++) {
        set |= UINT64_C(1) << ((unsigned)AGV_WATCH_EVENT + TRIPS[i]);
    }
    return set;
}

static uint64_t watches(void) {
    const bool waits_for_park = core()->config.park == (uint16_t)AGV_PARK_AT_STANDSTILL;
    uint64_t set = ALWAYS;
    switch (core()->machine.state) {
    case AGV_STATE_INIT:
        set |= IN_INIT | events() | (waits_for_park ? (WATCH(PARK_WAIT) | WATCH(STANDSTILL)) : 0u);
        break;
    case AGV_STATE_STANDBY:
    case AGV_STATE_ACTIVE:
        set |= SUPERVISING | (agv_core_engaged(core()) ? WHILE_ENGAGED : 0u);
        break;
    case AGV_STATE_TRIPPED:
        set |= UNTIL_SAFE | (waits_for_park ? (WATCH(PARK_WAIT) | WATCH(STANDSTILL)) : 0u);
        break;
    default:
        set |= IN_SAFE | events();
        break;
    }
    return set;
}

static bool runs(unsigned watch) {
    return core()->watches.phase[watch] == (uint8_t)AGV_WATCH_RUNNING;
}

/* Asks a copy of the supervisor, as it would be so much later; the watches that are over by then. */
static uint64_t over_in(uint64_t set, uint32_t ms) {
    static agv_core_t copy;
    uint64_t over = 0;
    copy.watches = core()->watches;
    copy.config = core()->config;
    copy.now_ms = core()->now_ms + ms;
    for (unsigned i = 0; i < (unsigned)AGV_WATCH_COUNT; i++) {
        if ((((set >> i) & 1u) != 0u) && runs(i) && agv_watch_reached(&copy, i)) {
            over |= UINT64_C(1) << i;
        }
    }
    return over;
}

/* The first of the times that will be over with the next tick, and not before; 0: none. */
static uint8_t eve(void) {
    const uint64_t set = over_in(watches(), 1);
    for (unsigned i = 0; i < (unsigned)AGV_WATCH_COUNT; i++) {
        if (((set >> i) & 1u) != 0u) {
            return (uint8_t)(i + 1u);
        }
    }
    return 0;
}

static uint64_t running(void) {
    const uint64_t set = watches();
    uint64_t some = 0;
    for (unsigned i = 0; i < (unsigned)AGV_WATCH_COUNT; i++) {
        some |= ((((set >> i) & 1u) != 0u) && runs(i)) ? (UINT64_C(1) << i) : 0u;
    }
    for (unsigned m = 0; m < (unsigned)WORLD_MESSAGES; m++) {
        if (stage_flows(m) && !world.traffic[m].frozen) {
            some &= ~(UINT64_C(1) << ((unsigned)AGV_WATCH_MESSAGE + m)); /* comes on */
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

static uint8_t phase(unsigned watch) {
    return core()->watches.phase[watch];
}

static uint8_t phases(unsigned a, unsigned b, unsigned c) {
    return (uint8_t)(phase(a) | (phase(b) << 2u) | (phase(c) << 4u));
}

static bool is_counting(unsigned first, unsigned last) {
    bool counts = false;
    for (unsigned row = first; row <= last; row++) {
        counts = counts || ((core()->monitor.in_a_row[row] != 0u) && (core()->monitor.in_a_row[row] != UINT8_MAX));
    }
    return counts;
}

static bool waits_to_send(void) {
    bool waits = false;
    for (unsigned i = 0; i < (unsigned)AGV_COMMAND_COUNT; i++) {
        waits = waits || agv_watch_runs(core(), (unsigned)AGV_WATCH_TX + i);
    }
    return waits;
}

static void always(abstract_t *key) {
    const agv_core_t *c = core();
    const sim_hal_can_t *can = world.hal.can;
    const bool whats[] = {agv_core_alive(c, AGV_NODE_VCU),
                          agv_core_alive(c, AGV_NODE_EPS),
                          (c->machine.state == (uint8_t)AGV_STATE_INIT) && agv_monitor_messages_fresh(c),
                          c->transmitter.kept != 0u,
                          waits_to_send(),
                          can[HAL_CAN_VEHICLE].full,
                          can[HAL_CAN_AI].full};
    const bool supervises = !agv_state_commands_safe(agv_core_state(c));
    const bool goes_by_gear = agv_core_is_latched(c) || (supervises && agv_core_engaged(c));
    const bool more[] = {agv_supervisor_output_closed(&world.supervisor),
                         stage.button && (c->machine.state != (uint8_t)AGV_STATE_INIT),
                         goes_by_gear && (stage.gear == (uint8_t)STAGE_P),
                         stage.ai_off,
                         stage.bad_latch,
                         stage.stalled,
                         stage_wrapped(),
                         (phase(AGV_WATCH_UNFED) == (uint8_t)AGV_WATCH_REACHED)};
    key->byte[0] = c->machine.state;
    key->byte[1] = supervises ? stage.illness : ILLNESS[stage.illness].like;
    key->byte[2] = bits(whats, 7);
    key->byte[3] = bits(more, 8);
    key->byte[4] = (uint8_t)(c->vehicle.mode | (phase(AGV_WATCH_BOTH_MODES) << 2u));
    if ((c->machine.state == (uint8_t)AGV_STATE_INIT) && (c->vehicle.mode != (uint8_t)AGV_MODE_MANUAL)) {
        key->byte[4] = 0;
    }
    key->byte[5] = (uint8_t)(stage.bus | (phase(AGV_WATCH_BUS_OFF) << 2u));
    key->byte[6] = eve();
}

static void in_init(abstract_t *key) {
    const bool whats[] = {core()->machine.startup_reported, core()->summary.cause != (uint8_t)AGV_FAULT_NONE,
                          core()->summary.ai_cause, core()->machine.park_released};
    key->byte[8] = bits(whats, 4);
    key->byte[9] = phases(AGV_WATCH_INIT_GOOD, AGV_WATCH_INIT, AGV_WATCH_INIT);
}

static void supervising(abstract_t *key) {
    const agv_core_t *c = core();
    const bool whats[] = {c->monitor.ai_alarm_armed, is_counting(0, AGV_ROW_EPS_SUPPLY_LAST),
                          is_counting(AGV_ROW_EPS_MODE, AGV_ROW_STEERING_ANGLE), c->summary.ai_cause};
    key->byte[8] = bits(whats, 4);
    key->byte[9] = c->liveness.heartbeats[AGV_NODE_AI].state;
    if (agv_core_engaged(c)) {
        key->byte[10] = phases(AGV_WATCH_ENGAGED, AGV_WATCH_AI_AWAITED, AGV_WATCH_STEERING_OFF);
        key->byte[11] = phases(AGV_WATCH_THROTTLE_IN_PARK, (unsigned)AGV_WATCH_MESSAGE + (unsigned)AGV_MSG_GEAR_COMMAND,
                               (unsigned)AGV_WATCH_MESSAGE + (unsigned)AGV_MSG_STEERING_COMMAND);
    }
}

static void tripped(abstract_t *key) {
    const agv_core_t *c = core();
    const agv_state_machine_t *m = &c->machine;
    const bool waits = (c->config.park == (uint16_t)AGV_PARK_AT_STANDSTILL) && !m->park_released;
    const bool whats[] = {m->pressed_after_trip,
                          m->park_released,
                          agv_monitor_steering_holdable(c),
                          m->unresettable != (uint8_t)AGV_FAULT_NONE,
                          m->safe_state_unconfirmed,
                          waits && stage.wheels_turn,
                          waits && agv_watch_runs(c, AGV_WATCH_STANDSTILL)};
    key->byte[8] = bits(whats, 7);
    key->byte[9] = phases(AGV_WATCH_UNCONFIRMED, AGV_WATCH_PARK_SENT, AGV_WATCH_PARK_SENT);
}

static void in_safe(abstract_t *key) {
    const agv_core_t *c = core();
    const agv_state_machine_t *m = &c->machine;
    const bool whats[] = {m->button_before,
                          m->pressed_after_trip,
                          m->press_refused,
                          agv_monitor_messages_fresh(c),
                          agv_monitor_steering_holdable(c),
                          stage.wheels_turn,
                          c->summary.cause != (uint8_t)AGV_FAULT_NONE,
                          c->summary.ai_cause};
    key->byte[8] = bits(whats, 8);
    key->byte[9] = m->unresettable;
    key->byte[10] = phases(AGV_WATCH_STANDSTILL, AGV_WATCH_RESET_GOOD, AGV_WATCH_PRESS);
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

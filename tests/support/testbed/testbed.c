#include "testbed.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "frame_bytes.h"

enum { SETTLE_TICKS = 4, BEFORE_WRAP_MS = 700, EPOCH_MS = 1000000 };

testbed_t testbed;

static const agv_state_t STATES[TESTBED_STATES] = {AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_STATE_ACTIVE,
                                                   AGV_STATE_TRIPPED, AGV_STATE_SAFE};

/* ---- Checks ---- */

void (*testbed_on_broken)(void);

static void judge(void) {
    if (testbed.rules.broken[0] == '\0') {
        return;
    }
    if (testbed_on_broken != NULL) {
        testbed_on_broken();
    } else {
        (void)fprintf(stderr, "broken rule after %u ms: %s\n", (unsigned)testbed.now_ms, testbed.rules.broken);
        abort();
    }
}

bool testbed_is_latched(void) {
    return is_latched(agv_supervisor_state(&testbed.supervisor));
}

bool testbed_has(agv_fault_t fault) {
    return agv_supervisor_has_fault(&testbed.supervisor, fault);
}

static rules_seen_t state_of_supervisor(void) {
    const rules_seen_t seen = {.state = agv_supervisor_state(&testbed.supervisor),
                               .first_reason = agv_supervisor_first_reason(&testbed.supervisor),
                               .active = agv_supervisor_active_faults(&testbed.supervisor),
                               .trips = agv_supervisor_active_trips(&testbed.supervisor),
                               .output_closed = testbed.hal.safety_output.on,
                               .gate_refused = agv_supervisor_counters(&testbed.supervisor)->gate_refused,
                               .watchdog_feeds = testbed.hal.feeds};
    return seen;
}

static void on_sent(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame) {
    (void)ctx;
    rules_sent(&testbed.rules, side, frame, agv_supervisor_state(&testbed.supervisor));
    judge();
}

/* After a disturbance of a controller its rules are paused until the supervisor had ticks to detect its end. */
static rules_bus_t state_of_bus(void) {
    const sim_hal_can_t *can = &testbed.hal.can[HAL_CAN_VEHICLE];
    const bool off = can->status.state == HAL_CAN_BUS_OFF;
    return (rules_bus_t){.takes_frames = !off && !can->full && (testbed.unsettled == 0),
                         .is_bus_off = off,
                         .is_passive = can->status.state == HAL_CAN_ERROR_PASSIVE,
                         .tx_pending_ms = can->status.tx_pending_ms};
}

/* ---- Calls ---- */

static uint32_t clock_at(uint64_t moment_ms) {
    return (uint32_t)moment_ms + testbed.offset_ms;
}

void testbed_frame(hal_can_side_t side, hal_can_frame_t frame, int32_t ahead_ms) {
    const uint64_t stamp_ms = (uint64_t)((int64_t)testbed.now_ms + ahead_ms);
    testbed.now_ms = (stamp_ms > testbed.now_ms) ? stamp_ms : testbed.now_ms;
    frame.time_ms = clock_at(stamp_ms);
    sim_hal_set_now_ms(&testbed.hal, clock_at(testbed.now_ms));
    testbed.rules.bus = state_of_bus();
    testbed.rules.oracle.now_ms = clock_at(testbed.now_ms);
    rules_heard(&testbed.rules, side, &frame, stamp_ms);
    agv_supervisor_frame(&testbed.supervisor, &testbed.ports, side, &frame);
    const rules_seen_t seen = state_of_supervisor();
    rules_returned(&testbed.rules, &seen, false, 0);
    judge();
}

void testbed_jump(uint32_t ms) {
    testbed.now_ms += ms;
    sim_hal_set_now_ms(&testbed.hal, clock_at(testbed.now_ms));
    oracle_tick(&testbed.rules.oracle, clock_at(testbed.now_ms));
    rules_ticks(&testbed.rules, testbed.now_ms, state_of_bus());
    if (!testbed.receive_path_dead) {
        agv_supervisor_receive_alive(&testbed.supervisor);
    }
    agv_supervisor_tick(&testbed.supervisor, &testbed.ports, clock_at(testbed.now_ms));
    const rules_seen_t seen = state_of_supervisor();
    rules_returned(&testbed.rules, &seen, true, testbed.now_ms - testbed.ticked_ms);
    testbed.ticked_ms = testbed.now_ms;
    const sim_hal_can_t *can = &testbed.hal.can[HAL_CAN_VEHICLE];
    const bool troubled = (can->status.state == HAL_CAN_BUS_OFF) || can->full;
    testbed.unsettled = troubled ? (uint32_t)SETTLE_TICKS : (testbed.unsettled - ((testbed.unsettled != 0) ? 1 : 0));
    judge();
}

static void start(hal_reset_cause_t cause, const rules_seen_t *before) {
    testbed.rules.oracle.now_ms = clock_at(testbed.now_ms);
    rules_ticks(&testbed.rules, testbed.now_ms, state_of_bus());
    agv_supervisor_start(&testbed.supervisor, &testbed.ports, &testbed.config, clock_at(testbed.now_ms));
    const rules_seen_t seen = state_of_supervisor();
    rules_started(&testbed.rules, cause, before, &seen, testbed.now_ms);
    testbed.ticked_ms = testbed.now_ms;
    judge();
}

void testbed_restart(hal_reset_cause_t cause) {
    const rules_seen_t before = state_of_supervisor();
    sim_hal_reset(&testbed.hal, cause);
    /* During a start the supervisor has no state for the oracle: only the safe commands without 065h may be sent. */
    oracle_restart(&testbed.rules.oracle);
    testbed.rules.own_counter_known = false;
    start(cause, &before);
}

/* ---- Traffic ---- */

void testbed_send(unsigned message) {
    traffic_message_t *m = &testbed.traffic[message];
    testbed_frame(m->side, traffic_next(m), 0);
}

void testbed_run(uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        testbed.now_ms++;
        for (unsigned m = 0; m < TRAFFIC_MESSAGES; m++) {
            if (traffic_is_due(&testbed.traffic[m], testbed.now_ms)) {
                testbed_send(m);
            }
        }
        testbed_jump(0);
    }
}

void testbed_disturb(hal_can_side_t side, unsigned kind, uint8_t amount) {
    switch (kind) {
    case 0:
        sim_hal_set_can_state(&testbed.hal, side, (hal_can_state_t)(amount % 3));
        break;
    case 1:
        sim_hal_set_full(&testbed.hal, side, (amount & 1) != 0);
        break;
    case 2:
        sim_hal_set_tx_pending_ms(&testbed.hal, side, amount);
        break;
    default:
        sim_hal_add_overrun(&testbed.hal, side);
        break;
    }
    testbed.unsettled = SETTLE_TICKS;
}

/* ---- Saved states ---- */

static void configure(unsigned variant) {
    agv_config_t *config = &testbed.config;
    agv_config_defaults(config);
    config->topology = (variant >= 3 && variant <= 5) ? AGV_TOPOLOGY_GATEWAY : AGV_TOPOLOGY_SHARED;
    config->id_set = (variant == 1 || variant == 4) ? AGV_ID_SET_TABLE : AGV_ID_SET_HEADING;
    switch (variant) {
    case 1:
        config->vcu_counter = AGV_COUNTER_INCREMENTS;
        config->eps_counter = AGV_COUNTER_INCREMENTS;
        config->ai_counter = AGV_COUNTER_INCREMENTS;
        break;
    case 2:
        config->park = AGV_PARK_AT_STANDSTILL;
        config->ai_lost_in_manual = AGV_AI_LOST_TRIP;
        config->status_frame_id = 0x700;
        break;
    case 4:
        config->gateway_in_manual = AGV_IN_MANUAL_ALL;
        config->own_heartbeat = AGV_OWN_HEARTBEAT_FROZEN;
        config->throttle_ceiling_pct = 40;
        break;
    case 5:
        config->park = AGV_PARK_AT_STANDSTILL;
        config->steering_slew_ddeg_s = 300;
        config->status_frame_id = 1;
        config->status_frame_period_ms = 10;
        break;
    case 6:
        config->shadow = AGV_SHADOW_ON;
        break;
    default:
        break;
    }
}

static void begin(unsigned variant, uint32_t offset_ms) {
    memset(&testbed, 0, sizeof testbed);
    testbed.now_ms = EPOCH_MS; /* so that stamps may be earlier than the start */
    testbed.offset_ms = offset_ms - (uint32_t)EPOCH_MS;
    testbed.ports = (agv_ports_t){.hal = &testbed.hal, .recorder = &testbed.recorder};
    configure(variant);
    traffic_address(testbed.traffic, &testbed.config);
    traffic_heal(testbed.traffic);
    sim_store_init(&testbed.store);
    const bool gateway = testbed.config.topology == AGV_TOPOLOGY_GATEWAY;
    const sim_hal_config_t hal = {
        .clock_start_ms = offset_ms, .watchdog_ms = SIM_HAL_WATCHDOG_OFF, .store = &testbed.store};
    sim_hal_init_direct(&testbed.hal, &hal, gateway ? 2 : 1, on_sent, NULL);
    rules_init(&testbed.rules, &testbed.config);
    start(HAL_RESET_POWER_ON, NULL);
}

static void expect_state(unsigned state) {
    if (agv_supervisor_state(&testbed.supervisor) != STATES[state]) {
        (void)fprintf(stderr, "state %u was not reached but %02Xh\n", state,
                      (unsigned)agv_supervisor_state(&testbed.supervisor));
        abort();
    }
}

/* Run from the start to a state. The vehicle moves in ACTIVE, and obeys on the way to SAFE. */
static void run_to_state(unsigned state) {
    testbed_run(state == 0 ? 50 : 700);
    if (state >= 2) {
        traffic_mode(testbed.traffic, MODE_ENGAGED);
        traffic_gear(testbed.traffic, GEAR_D);
        traffic_wheels(testbed.traffic, 200, 200);
        testbed_run(800);
    }
    if (state >= 3) {
        testbed.traffic[M_VEHICLE].data[4] = 0x80; /* the S-driver alarm */
        testbed_run(10);
        testbed.traffic[M_VEHICLE].data[4] = 0;
        testbed_run(40);
    }
    if (state >= 4) {
        traffic_mode(testbed.traffic, MODE_MANUAL);
        traffic_gear(testbed.traffic, GEAR_P);
        traffic_wheels(testbed.traffic, 0, 0);
        testbed.traffic[M_THROTTLE_STATUS].data[0] = 0;
        testbed_run(300);
    }
    expect_state(state);
}

/* In some variants the supervisor's clock soon wraps, in one it passes the middle of its range. */
static uint32_t offset_for(unsigned variant, uint64_t took_ms) {
    const uint32_t before = (uint32_t)took_ms + (uint32_t)BEFORE_WRAP_MS;
    switch (variant) {
    case 1:
    case 3:
    case 5:
        return 0 - before;
    case 2:
        return 0x80000000u - before;
    default:
        return 0;
    }
}

void testbed_load(unsigned variant, unsigned state) {
    static testbed_t *kept[TESTBED_VARIANTS][TESTBED_STATES];
    testbed_t **copy = &kept[variant][state];
    if (*copy == NULL) {
        begin(variant, 0);
        run_to_state(state);
        begin(variant, offset_for(variant, testbed.now_ms - EPOCH_MS));
        run_to_state(state);
        *copy = malloc(sizeof testbed);
        if (*copy == NULL) {
            abort();
        }
        memcpy(*copy, &testbed, sizeof testbed);
    }
    memcpy(&testbed, *copy, sizeof testbed);
}

#include "world.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "frame_bytes.h"

enum { SETTLE_TICKS = 4, BEFORE_WRAP_MS = 700, EPOCH_MS = 1000000 };

world_t world;

static const agv_state_t STATES[WORLD_STATES] = {AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_STATE_ACTIVE, AGV_STATE_TRIPPED,
                                                 AGV_STATE_SAFE};

/* ---- Judging ---- */

void (*world_on_broken)(void);

void world_judge(void) {
    if (world.rules.broken[0] == '\0') {
        return;
    }
    if (world_on_broken != NULL) {
        world_on_broken();
    } else {
        (void)fprintf(stderr, "broken rule after %u ms: %s\n", (unsigned)world.now_ms, world.rules.broken);
        abort();
    }
}

bool world_is_latched(void) {
    return is_latched(agv_supervisor_state(&world.supervisor));
}

bool world_has(agv_fault_t fault) {
    return agv_supervisor_has_fault(&world.supervisor, fault);
}

static rules_seen_t look(void) {
    const rules_seen_t seen = {.state = agv_supervisor_state(&world.supervisor),
                               .first_reason = agv_supervisor_first_reason(&world.supervisor),
                               .active = agv_supervisor_active_faults(&world.supervisor),
                               .output_closed = world.hal.safety_output.on,
                               .gate_refused = agv_supervisor_counters(&world.supervisor)->gate_refused,
                               .watchdog_feeds = world.hal.feeds};
    return seen;
}

static void on_sent(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame) {
    (void)ctx;
    rules_sent(&world.rules, side, frame, agv_supervisor_state(&world.supervisor));
    world_judge();
}

/* A controller that was in trouble is not judged before the supervisor has had ticks to see that it is over. */
static rules_bus_t bus(void) {
    const sim_hal_can_t *can = &world.hal.can[HAL_CAN_VEHICLE];
    const bool off = can->status.state == HAL_CAN_BUS_OFF;
    return (rules_bus_t){.takes_frames = !off && !can->full && (world.unsettled == 0u),
                         .is_bus_off = off,
                         .tx_pending_ms = can->status.tx_pending_ms};
}

/* ---- Calls ---- */

static uint32_t clock_at(uint64_t moment_ms) {
    return (uint32_t)moment_ms + world.offset_ms;
}

void world_frame(hal_can_side_t side, hal_can_frame_t frame, int32_t ahead_ms) {
    const uint64_t stamp_ms = (uint64_t)((int64_t)world.now_ms + ahead_ms);
    world.now_ms = (stamp_ms > world.now_ms) ? stamp_ms : world.now_ms;
    frame.time_ms = clock_at(stamp_ms);
    sim_hal_set_now_ms(&world.hal, clock_at(world.now_ms));
    world.rules.bus = bus();
    world.rules.oracle.now_ms = clock_at(world.now_ms);
    rules_heard(&world.rules, side, &frame, stamp_ms);
    agv_supervisor_frame(&world.supervisor, &world.ports, side, &frame);
    const rules_seen_t seen = look();
    rules_returned(&world.rules, &seen, false, 0);
    world_judge();
}

void world_jump(uint32_t ms) {
    world.now_ms += ms;
    sim_hal_set_now_ms(&world.hal, clock_at(world.now_ms));
    world.rules.oracle.now_ms = clock_at(world.now_ms);
    rules_ticks(&world.rules, world.now_ms, bus());
    if (!world.receive_path_dead) {
        agv_supervisor_receive_alive(&world.supervisor);
    }
    agv_supervisor_tick(&world.supervisor, &world.ports, clock_at(world.now_ms));
    const rules_seen_t seen = look();
    rules_returned(&world.rules, &seen, true, world.now_ms - world.ticked_ms);
    world.ticked_ms = world.now_ms;
    const sim_hal_can_t *can = &world.hal.can[HAL_CAN_VEHICLE];
    const bool troubled = (can->status.state == HAL_CAN_BUS_OFF) || can->full;
    world.unsettled = troubled ? (uint32_t)SETTLE_TICKS : (world.unsettled - ((world.unsettled != 0u) ? 1u : 0u));
    world_judge();
}

static void start(hal_reset_cause_t cause, const rules_seen_t *before) {
    world.rules.oracle.now_ms = clock_at(world.now_ms);
    rules_ticks(&world.rules, world.now_ms, bus());
    agv_supervisor_start(&world.supervisor, &world.ports, &world.config, true, clock_at(world.now_ms));
    const rules_seen_t seen = look();
    rules_started(&world.rules, cause, before, &seen, world.now_ms);
    world.ticked_ms = world.now_ms;
    world_judge();
}

void world_restart(hal_reset_cause_t cause) {
    const rules_seen_t before = look();
    sim_hal_reset(&world.hal, cause);
    /* Between two lives the oracle knows of no state: what leaves in the start is the safe commands without 065h. */
    oracle_restart(&world.rules.oracle);
    world.rules.own_counter_known = false;
    start(cause, &before);
}

/* ---- Traffic ---- */

void world_send(unsigned message) {
    traffic_message_t *m = &world.traffic[message];
    world_frame(m->side, traffic_next(m), 0);
}

void world_run(uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        world.now_ms++;
        for (unsigned m = 0; m < (unsigned)TRAFFIC_MESSAGES; m++) {
            if (traffic_is_due(&world.traffic[m], world.now_ms)) {
                world_send(m);
            }
        }
        world_jump(0);
    }
}

void world_mode(uint8_t mode) {
    traffic_mode(world.traffic, mode);
}

void world_button(bool down) {
    traffic_button(world.traffic, down);
}

void world_gear(uint8_t gear) {
    traffic_gear(world.traffic, gear);
}

void world_wheels(uint8_t mm_s) {
    traffic_wheels(world.traffic, mm_s, mm_s);
}

void world_heal(void) {
    traffic_heal(world.traffic);
}

void world_ai_drives(void) {
    traffic_ai_drives(world.traffic);
}

void world_disturb(hal_can_side_t side, unsigned kind, uint8_t amount) {
    switch (kind) {
    case 0:
        sim_hal_set_can_state(&world.hal, side, (hal_can_state_t)(amount % 3u));
        break;
    case 1:
        sim_hal_set_full(&world.hal, side, (amount & 1u) != 0u);
        break;
    case 2:
        sim_hal_set_tx_pending_ms(&world.hal, side, amount);
        break;
    default:
        sim_hal_add_overrun(&world.hal, side);
        break;
    }
    world.unsettled = SETTLE_TICKS;
}

/* ---- States that are kept ---- */

static void configure(unsigned variant) {
    agv_config_t *config = &world.config;
    agv_config_defaults(config);
    config->topology = (variant >= 3u && variant <= 5u) ? AGV_TOPOLOGY_GATEWAY : AGV_TOPOLOGY_SHARED;
    config->id_set = (variant == 1u || variant == 4u) ? AGV_ID_SET_TABLE : AGV_ID_SET_HEADING;
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
    memset(&world, 0, sizeof world);
    world.now_ms = EPOCH_MS; /* so that stamps may lie before the start */
    world.offset_ms = offset_ms - (uint32_t)EPOCH_MS;
    world.ports = (agv_ports_t){.hal = &world.hal, .recorder = &world.recorder};
    configure(variant);
    traffic_address(world.traffic, &world.config);
    world_heal();
    sim_store_init(&world.store);
    const bool gateway = world.config.topology == (uint16_t)AGV_TOPOLOGY_GATEWAY;
    const sim_hal_config_t hal = {
        .clock_start_ms = offset_ms, .watchdog_ms = SIM_HAL_WATCHDOG_OFF, .store = &world.store};
    sim_hal_init_direct(&world.hal, &hal, gateway ? 2 : 1, on_sent, NULL);
    rules_init(&world.rules, &world.config);
    start(HAL_RESET_POWER_ON, NULL);
}

static void expect_state(unsigned state) {
    if (agv_supervisor_state(&world.supervisor) != STATES[state]) {
        (void)fprintf(stderr, "state %u was not reached but %02Xh\n", state,
                      (unsigned)agv_supervisor_state(&world.supervisor));
        abort();
    }
}

/* From the start to a state; the vehicle drives in ACTIVE, and obeys on the way to SAFE. */
static void go_to(unsigned state) {
    world_run(state == 0u ? 50 : 700);
    if (state >= 2u) {
        world_mode(MODE_ENGAGED);
        world_gear(GEAR_D);
        world_wheels(200);
        world_run(800);
    }
    if (state >= 3u) {
        world.traffic[M_VEHICLE].data[4] = 0x80; /* the S-driver alarm */
        world_run(10);
        world.traffic[M_VEHICLE].data[4] = 0;
        world_run(40);
    }
    if (state >= 4u) {
        world_mode(MODE_MANUAL);
        world_gear(GEAR_P);
        world_wheels(0);
        world.traffic[M_THROTTLE_STATUS].data[0] = 0;
        world_run(300);
    }
    expect_state(state);
}

/* In some variants the supervisor's clock wraps a moment later, in one it passes the middle of its range. */
static uint32_t offset_for(unsigned variant, uint64_t took_ms) {
    const uint32_t before = (uint32_t)took_ms + (uint32_t)BEFORE_WRAP_MS;
    switch (variant) {
    case 1:
    case 3:
    case 5:
        return 0u - before;
    case 2:
        return 0x80000000u - before;
    default:
        return 0u;
    }
}

void world_load(unsigned variant, unsigned state) {
    static world_t *kept[WORLD_VARIANTS][WORLD_STATES];
    world_t **copy = &kept[variant][state];
    if (*copy == NULL) {
        begin(variant, 0);
        go_to(state);
        begin(variant, offset_for(variant, world.now_ms - EPOCH_MS));
        go_to(state);
        *copy = malloc(sizeof world);
        if (*copy == NULL) {
            abort();
        }
        memcpy(*copy, &world, sizeof world);
    }
    memcpy(&world, *copy, sizeof world);
}

#include "scenario/scenario_world.h"

#include <string.h>

#include "common/units.h"

enum { PASSIVE_TEC = 200, BITS_PER_BYTE = 8 };

static void tell_event(void *ctx, const session_event_t *event) {
    const scenario_world_t *world = ctx;
    for (size_t i = 0u; i < world->watch_count; i++) {
        if (world->watches[i].on_event != NULL) {
            world->watches[i].on_event(world->watches[i].ctx, event);
        }
    }
}

static int sender_of(const scenario_world_t *world, hal_can_side_t side, sim_bus_node_t number) {
    if (number == world->hal.can[side].node) {
        return SCENARIO_FROM_SUPERVISOR;
    }
    for (int n = 0; n < VEHICLE_NODES; n++) {
        if ((vehicle_side_of(&world->vehicle, (vehicle_node_t)n) == side) && (world->stations[n].number == number)) {
            return n;
        }
    }
    return VEHICLE_STRANGER;
}

static void tell_frame(void *ctx, const sim_bus_event_t *event) {
    const scenario_side_t *side = ctx;
    const scenario_world_t *world = side->world;

    if (event->error) {
        return;
    }
    const int from = sender_of(world, side->side, event->sender);
    for (size_t i = 0u; i < world->watch_count; i++) {
        if (world->watches[i].on_frame != NULL) {
            world->watches[i].on_frame(world->watches[i].ctx, event->end_us, side->side, from, event->frame);
        }
    }
}

/** A node of the vehicle is on the bus when it has power. */
static void follow_power(scenario_world_t *world, vehicle_node_t node) {
    scenario_station_t *station = &world->stations[node];
    const bool runs = vehicle_is_running(&world->vehicle, node);

    if (station->powered != runs) {
        station->powered = runs;
        sim_bus_set_power(&world->buses[vehicle_side_of(&world->vehicle, node)], station->number, runs);
    }
}

/** The bus is a classic one: a frame in FD format takes no time on it, and is heard by everybody with power. */
static void deliver_past_wire(scenario_world_t *world) {
    for (size_t i = 0u; i < world->past_wire_count; i++) {
        const scenario_past_wire_t *waiting = &world->past_wire[i];
        sim_bus_t *bus = &world->buses[waiting->side];
        for (int n = 0; n < VEHICLE_NODES; n++) {
            if (vehicle_side_of(&world->vehicle, (vehicle_node_t)n) == waiting->side) {
                sim_bus_deliver(bus, world->stations[n].number, &waiting->frame);
            }
        }
        sim_bus_deliver(bus, world->hal.can[waiting->side].node, &waiting->frame);
    }
    world->past_wire_count = 0u;
}

static void send_past_wire(scenario_world_t *world, hal_can_side_t side, const hal_can_frame_t *frame) {
    if (world->past_wire_count < VEHICLE_STRANGERS_MAX) {
        world->past_wire[world->past_wire_count] = (scenario_past_wire_t){side, *frame};
        world->past_wire_count++;
    } else {
        world->lost_frames++;
    }
}

static void send_of_vehicle(void *ctx, vehicle_node_t from, hal_can_side_t side, const hal_can_frame_t *frame) {
    scenario_world_t *world = ctx;
    sim_bus_node_t number = world->strangers[side];

    if ((frame->flags & HAL_CAN_FD) != 0u) {
        send_past_wire(world, side, frame);
        return;
    }
    if (from != VEHICLE_STRANGER) {
        follow_power(world, from);
        number = world->stations[from].number;
    } else if (!world->stranger_powered[side]) {
        world->stranger_powered[side] = true; /* before that nobody is there who would acknowledge */
        sim_bus_set_power(&world->buses[side], number, true);
    }
    if (!sim_bus_send(&world->buses[side], number, frame)) {
        world->lost_frames++;
    }
}

static void station_hears(void *ctx, const hal_can_frame_t *frame) {
    scenario_station_t *station = ctx;
    vehicle_receive(&station->world->vehicle, station->node, station->world->t_ms, frame);
}

static void supervisor_hears(void *ctx, const hal_can_frame_t *arrived) {
    const scenario_side_t *side = ctx;
    scenario_world_t *world = side->world;
    hal_can_frame_t frame;

    (void)arrived;
    if (world->t_ms < world->deaf_until_ms) {
        return;
    }
    /* What arrives with the end of this millisecond belongs to the next one. */
    const uint64_t end_us = (world->t_ms + 1u) * US_PER_MS;
    const uint64_t t_ms = world->t_ms + ((sim_bus_now_us(&world->buses[side->side]) >= end_us) ? 1u : 0u);
    while (sim_hal_receive(&world->hal, side->side, &frame)) {
        session_frame(&world->session, side->side, &frame, t_ms);
    }
}

static bool attach(scenario_world_t *world, hal_can_side_t side) {
    const sim_bus_node_config_t own = {
        .on_receive = supervisor_hears, .ctx = &world->sides[side], .rx_slots = SIM_BUS_RX_SLOTS_MAX};
    const sim_bus_node_config_t deaf = {.tx_slots = SIM_BUS_TX_SLOTS_MAX};
    sim_bus_t *bus = &world->buses[side];

    world->sides[side] = (scenario_side_t){world, side};
    if (!sim_hal_attach(&world->hal, side, bus, &own)) {
        return false;
    }
    for (int n = 0; n < VEHICLE_NODES; n++) {
        scenario_station_t *station = &world->stations[n];
        if (vehicle_side_of(&world->vehicle, (vehicle_node_t)n) != side) {
            continue;
        }
        const sim_bus_node_config_t ear = {
            .on_receive = station_hears, .ctx = station, .tx_slots = SIM_BUS_TX_SLOTS_MAX};
        station->world = world;
        station->node = (vehicle_node_t)n;
        station->number = sim_bus_attach(bus, &ear);
        sim_bus_set_power(bus, station->number, false);
    }
    world->strangers[side] = sim_bus_attach(bus, &deaf);
    sim_bus_set_power(bus, world->strangers[side], false);
    return true;
}

bool scenario_world_init(scenario_world_t *world, const scenario_t *scenario) {
    memset(world, 0, sizeof *world);
    const uint32_t phase_us = scenario->tick_phase_us;
    const sim_hal_config_t port = {.clock_start_ms = scenario->clock_start_ms,
                                   .clock_phase_us = (uint16_t)((US_PER_MS - phase_us) % US_PER_MS),
                                   .watchdog_ms = (scenario->watchdog_ms != 0u) ? scenario->watchdog_ms
                                                                                : scenario->config.watchdog_period_ms,
                                   .reset_cause = scenario->reset_cause,
                                   .store = &world->store};

    world->config = scenario->config;
    world->ids = scenario->ids;
    world->tick_phase_us = scenario->tick_phase_us;
    world->bus_count = scenario->vehicle.gateway ? HAL_CAN_SIDES : 1u;
    sim_store_init(&world->store);
    sim_hal_init(&world->hal, &port);
    vehicle_init(&world->vehicle, &scenario->vehicle, send_of_vehicle, world);
    for (size_t side = 0u; side < world->bus_count; side++) {
        world->running[side] = &world->buses[side];
        if (!sim_bus_init(&world->buses[side], scenario->bitrate) || !attach(world, (hal_can_side_t)side)) {
            return false;
        }
    }
    session_init(&world->session, &world->hal);
    if (!scenario->self_test_passed) {
        session_fail_self_test(&world->session);
    }
    return session_observe(&world->session, tell_event, world);
}

void scenario_world_watch(scenario_world_t *world, const scenario_watch_t *watch) {
    if (world->watch_count == SCENARIO_WATCHES_MAX) {
        return;
    }
    world->watches[world->watch_count] = *watch;
    world->watch_count++;
    if (watch->on_frame == NULL) {
        return;
    }
    for (size_t i = 0u; i < world->watch_count - 1u; i++) {
        if (world->watches[i].on_frame != NULL) {
            return; /* the taps are there */
        }
    }
    for (size_t side = 0u; side < world->bus_count; side++) {
        (void)sim_bus_add_tap(&world->buses[side], tell_frame, &world->sides[side]);
    }
}

static void start_supervisor(scenario_world_t *world) {
    session_start(&world->session, &world->config, world->t_ms, sim_hal_now_ms(&world->hal));
}

void scenario_world_start(scenario_world_t *world) {
    start_supervisor(world);
}

static void power_supervisor(scenario_world_t *world, bool on) {
    for (size_t side = 0u; side < world->bus_count; side++) {
        sim_bus_set_power(&world->buses[side], world->hal.can[side].node, on);
    }
    world->off = !on;
}

static void restart(scenario_world_t *world, hal_reset_cause_t cause, uint32_t off_ms) {
    sim_hal_reset(&world->hal, cause);
    world->deaf_until_ms = world->t_ms + off_ms;
    if (off_ms == 0u) {
        start_supervisor(world);
    } else {
        power_supervisor(world, false);
    }
}

/** The supervisor has power again. */
static void wake(scenario_world_t *world) {
    power_supervisor(world, true);
    sim_hal_reset(&world->hal, world->hal.config.reset_cause);
    start_supervisor(world);
}

static void flip_bit(scenario_world_t *world, uint32_t bit) {
    uint8_t *bytes = (uint8_t *)&world->session.supervisor;
    bytes[(bit / BITS_PER_BYTE) % sizeof world->session.supervisor] ^= (uint8_t)(1u << (bit % BITS_PER_BYTE));
}

static void do_to_supervisor(scenario_world_t *world, const scenario_action_t *action) {
    sim_bus_t *bus = &world->buses[action->side];
    const sim_bus_node_t node = world->hal.can[action->side].node;

    switch (action->what) {
    case SCENARIO_RESTART:
        restart(world, action->cause, action->ms);
        break;
    case SCENARIO_HANG:
        world->deaf_until_ms = world->t_ms + action->ms;
        world->was_deaf = true;
        break;
    case SCENARIO_BUS_OFF:
        sim_bus_force_bus_off(bus, node);
        break;
    case SCENARIO_TX_STALL:
        sim_bus_set_stalled(bus, node, action->on);
        world->stalled[action->side] = action->on;
        break;
    case SCENARIO_TX_SWALLOW:
        sim_hal_set_swallowing(&world->hal, action->side, action->on);
        break;
    case SCENARIO_QUEUE_FULL:
        sim_hal_set_full(&world->hal, action->side, action->on);
        break;
    case SCENARIO_OVERRUN:
        sim_bus_inject_overrun(bus, node);
        break;
    case SCENARIO_ERROR_PASSIVE:
        sim_bus_set_error_counters(bus, node, action->on ? PASSIVE_TEC : 0u, 0u);
        break;
    case SCENARIO_DELIVER:
        sim_bus_deliver(bus, node, &action->frame);
        break;
    case SCENARIO_CORRUPT_LATCH:
        (void)sim_store_corrupt_latch(&world->store, 0u, 1u);
        break;
    case SCENARIO_FLIP_BIT:
        flip_bit(world, action->ms);
        break;
    default:
        sim_bus_corrupt_all(bus, action->ms);
        break;
    }
}

void scenario_world_act(scenario_world_t *world, uint64_t t_ms, const scenario_step_t *step) {
    world->t_ms = t_ms;
    if (step->of_vehicle) {
        (void)vehicle_do(&world->vehicle, t_ms, &step->vehicle);
    } else {
        do_to_supervisor(world, &step->supervisor);
    }
}

void scenario_world_do(scenario_world_t *world, const scenario_step_t *step) {
    scenario_world_act(world, step->at_ms, step);
}

static void restore_bus(const sim_bus_t *bus, sim_bus_t *saved) {
    memcpy(saved->taps, bus->taps, sizeof saved->taps);
    for (size_t i = 0u; i < SIM_BUS_NODES_MAX; i++) {
        saved->nodes[i].config = bus->nodes[i].config;
    }
}

void scenario_world_restore(scenario_world_t *world, scenario_world_t *saved) {
    for (size_t side = 0u; side < HAL_CAN_SIDES; side++) {
        restore_bus(&world->buses[side], &saved->buses[side]);
        saved->running[side] = world->running[side];
        saved->hal.can[side].bus = world->hal.can[side].bus;
        saved->sides[side].world = world->sides[side].world;
    }
    for (int n = 0; n < VEHICLE_NODES; n++) {
        saved->stations[n].world = world->stations[n].world;
    }
    saved->hal.ops = world->hal.ops;
    saved->hal.config.store = world->hal.config.store;
    saved->hal.sink = world->hal.sink;
    saved->hal.sink_ctx = world->hal.sink_ctx;
    saved->session.ports = world->session.ports;
    memcpy(saved->session.observers, world->session.observers, sizeof saved->session.observers);
    vehicle_set_send(&saved->vehicle, send_of_vehicle, world);
    memcpy(saved->watches, world->watches, sizeof saved->watches);
    *world = *saved;
}

static void step_supervisor(scenario_world_t *world) {
    if (world->off && (world->t_ms >= world->deaf_until_ms)) {
        wake(world);
    }
    if (world->t_ms >= world->deaf_until_ms) {
        for (size_t side = 0u; world->was_deaf && (side < world->bus_count); side++) {
            supervisor_hears(&world->sides[side], NULL); /* what waits since then */
        }
        world->was_deaf = false;
        session_tick(&world->session, world->t_ms, sim_hal_now_ms(&world->hal));
    }
    if (!world->off && sim_hal_poll(&world->hal)) {
        restart(world, HAL_RESET_WATCHDOG, 0u);
    }
}

static void run_buses(scenario_world_t *world, uint64_t until_us) {
    if (world->bus_count == 1u) {
        sim_bus_run_until(&world->buses[HAL_CAN_VEHICLE], until_us);
    } else {
        sim_bus_run_all_until(world->running, world->bus_count, until_us);
    }
}

void scenario_world_tick(scenario_world_t *world, uint64_t t_ms) {
    const uint64_t until_us = (t_ms + 1u) * US_PER_MS;

    world->t_ms = t_ms;
    vehicle_tick(&world->vehicle, t_ms);
    if (world->power_changes != vehicle_power_changes(&world->vehicle)) {
        world->power_changes = vehicle_power_changes(&world->vehicle);
        for (int n = 0; n < VEHICLE_NODES; n++) {
            follow_power(world, (vehicle_node_t)n);
        }
    }
    if (world->past_wire_count != 0u) {
        deliver_past_wire(world);
    }
    if (world->tick_phase_us != 0u) {
        run_buses(world, (t_ms * US_PER_MS) + world->tick_phase_us);
    }
    step_supervisor(world);
    run_buses(world, until_us);
}

void scenario_world_view(const scenario_world_t *world, scenario_world_view_t *view) {
    const hal_t *hal = &world->hal;
    *view = (scenario_world_view_t){
        .t_ms = world->t_ms,
        .now_us = sim_bus_now_us(&world->buses[HAL_CAN_VEHICLE]),
        .status_frame_id = world->config.status_frame_id,
        .output_closed = hal->safety_output.on,
        .is_deaf = world->t_ms < world->deaf_until_ms,
        .received = hal->can[HAL_CAN_VEHICLE].received + hal->can[HAL_CAN_AI].received,
        .feeds = hal->feeds,
        .bites = hal->bites,
        .lost_frames = world->lost_frames,
        .is_off = world->off,
    };
    vehicle_state(&world->vehicle, &view->vehicle);
}

void scenario_world_controller(const scenario_world_t *world, hal_can_side_t side, scenario_controller_t *controller) {
    const sim_hal_can_t *can = &world->hal.can[side];
    *controller = (scenario_controller_t){
        .is_stalled = can->full || world->stalled[side],
        .swallows = can->swallows,
    };
    sim_bus_status(&world->buses[side], can->node, &controller->status);
}

void scenario_world_bus_stats(const scenario_world_t *world, hal_can_side_t side, sim_bus_stats_t *stats) {
    sim_bus_stats(&world->buses[side], stats);
}

hal_t *scenario_world_port(scenario_world_t *world) {
    return &world->hal;
}

void scenario_world_vehicle(scenario_world_t *world, vehicle_view_t *view) {
    vehicle_view(&world->vehicle, world->t_ms, view);
}

agv_message_t scenario_world_message(const scenario_world_t *world, uint32_t id) {
    return (agv_message_t)agv_ids_find(&world->ids, id);
}

const session_t *scenario_world_session(const scenario_world_t *world) {
    return &world->session;
}

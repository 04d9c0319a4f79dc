#include "scenario/scenario_testbed.h"

#include <string.h>

#include "text/units.h"

enum { PASSIVE_TEC = 200, BITS_PER_BYTE = 8 };

static void pass_event(void *ctx, const session_event_t *event) {
    scenario_testbed_t *testbed = ctx;
    (void)scenario_events_note(&testbed->events, event);
    for (size_t i = 0; i < testbed->watch_count; i++) {
        if (testbed->watches[i].on_event != NULL) {
            testbed->watches[i].on_event(testbed->watches[i].ctx, event);
        }
    }
}

static int sender_of(const scenario_testbed_t *testbed, hal_can_side_t side, sim_bus_node_t number) {
    if (number == testbed->hal.can[side].node) {
        return SCENARIO_FROM_SUPERVISOR;
    }
    for (int n = 0; n < VEHICLE_NODES; n++) {
        if ((vehicle_side_of(&testbed->vehicle, (vehicle_node_t)n) == side) &&
            (testbed->stations[n].number == number)) {
            return n;
        }
    }
    return VEHICLE_ROGUE;
}

static void pass_frame(void *ctx, const sim_bus_event_t *event) {
    const scenario_side_t *side = ctx;
    const scenario_testbed_t *testbed = side->testbed;

    if (event->error) {
        return;
    }
    const int from = sender_of(testbed, side->side, event->sender);
    for (size_t i = 0; i < testbed->watch_count; i++) {
        if (testbed->watches[i].on_frame != NULL) {
            testbed->watches[i].on_frame(testbed->watches[i].ctx, event->end_us, side->side, from, event->frame);
        }
    }
}

/** A node of the vehicle is on the bus when it has power. */
static void follow_power(scenario_testbed_t *testbed, vehicle_node_t node) {
    scenario_station_t *station = &testbed->stations[node];
    const bool runs = vehicle_is_running(&testbed->vehicle, node);

    if (station->powered != runs) {
        station->powered = runs;
        sim_bus_set_power(&testbed->buses[vehicle_side_of(&testbed->vehicle, node)], station->number, runs);
    }
}

/** The bus is a classic one. A frame in FD format takes no time on it, and all nodes with power receive it. */
static void deliver_past_wire(scenario_testbed_t *testbed) {
    for (size_t i = 0; i < testbed->past_wire_count; i++) {
        const scenario_past_wire_t *waiting = &testbed->past_wire[i];
        sim_bus_t *bus = &testbed->buses[waiting->side];
        for (int n = 0; n < VEHICLE_NODES; n++) {
            if (vehicle_side_of(&testbed->vehicle, (vehicle_node_t)n) == waiting->side) {
                sim_bus_deliver(bus, testbed->stations[n].number, &waiting->frame);
            }
        }
        sim_bus_deliver(bus, testbed->hal.can[waiting->side].node, &waiting->frame);
    }
    testbed->past_wire_count = 0;
}

static void send_past_wire(scenario_testbed_t *testbed, hal_can_side_t side, const hal_can_frame_t *frame) {
    if (testbed->past_wire_count < VEHICLE_ROGUES_MAX) {
        testbed->past_wire[testbed->past_wire_count] = (scenario_past_wire_t){side, *frame};
        testbed->past_wire_count++;
    } else {
        testbed->lost_frames++;
    }
}

static void send_of_vehicle(void *ctx, vehicle_node_t from, hal_can_side_t side, const hal_can_frame_t *frame) {
    scenario_testbed_t *testbed = ctx;
    sim_bus_node_t number = testbed->rogues[side];

    if ((frame->flags & HAL_CAN_FD) != 0) {
        send_past_wire(testbed, side, frame);
        return;
    }
    if (from != VEHICLE_ROGUE) {
        follow_power(testbed, from);
        number = testbed->stations[from].number;
    } else if (!testbed->rogue_powered[side]) {
        testbed->rogue_powered[side] = true; /* before, there is no node that would acknowledge */
        sim_bus_set_power(&testbed->buses[side], number, true);
    }
    if (!sim_bus_send(&testbed->buses[side], number, frame)) {
        testbed->lost_frames++;
    }
}

static void station_hears(void *ctx, const hal_can_frame_t *frame) {
    scenario_station_t *station = ctx;
    vehicle_receive(&station->testbed->vehicle, station->node, station->testbed->t_ms, frame);
}

static void pass_received(const scenario_testbed_t *testbed, hal_can_side_t side, const hal_can_frame_t *frame) {
    for (size_t i = 0; i < testbed->watch_count; i++) {
        const scenario_watch_t *watch = &testbed->watches[i];
        if (watch->on_received != NULL) {
            watch->on_received(watch->ctx, sim_bus_now_us(&testbed->buses[side]), side, frame);
        }
    }
}

static void supervisor_hears(void *ctx, const hal_can_frame_t *arrived) {
    const scenario_side_t *side = ctx;
    scenario_testbed_t *testbed = side->testbed;
    hal_can_frame_t frame;

    (void)arrived;
    if (testbed->t_ms < testbed->halted_until_ms) {
        return;
    }
    /* What arrives with the end of this millisecond belongs to the next one. */
    const uint64_t end_us = (testbed->t_ms + 1) * US_PER_MS;
    const uint64_t t_ms = testbed->t_ms + ((sim_bus_now_us(&testbed->buses[side->side]) >= end_us) ? 1 : 0);
    while (sim_hal_receive(&testbed->hal, side->side, &frame)) {
        pass_received(testbed, side->side, &frame);
        session_frame(&testbed->session, side->side, &frame, t_ms);
    }
}

static bool attach(scenario_testbed_t *testbed, hal_can_side_t side) {
    const sim_bus_node_config_t own = {
        .on_receive = supervisor_hears, .ctx = &testbed->sides[side], .rx_slots = SIM_BUS_RX_SLOTS_MAX};
    const sim_bus_node_config_t sender = {.tx_slots = SIM_BUS_TX_SLOTS_MAX};
    sim_bus_t *bus = &testbed->buses[side];

    testbed->sides[side] = (scenario_side_t){testbed, side};
    if (!sim_hal_attach(&testbed->hal, side, bus, &own)) {
        return false;
    }
    for (int n = 0; n < VEHICLE_NODES; n++) {
        scenario_station_t *station = &testbed->stations[n];
        if (vehicle_side_of(&testbed->vehicle, (vehicle_node_t)n) != side) {
            continue;
        }
        const sim_bus_node_config_t node = {
            .on_receive = station_hears, .ctx = station, .tx_slots = SIM_BUS_TX_SLOTS_MAX};
        station->testbed = testbed;
        station->node = (vehicle_node_t)n;
        station->number = sim_bus_attach(bus, &node);
        sim_bus_set_power(bus, station->number, false);
    }
    testbed->rogues[side] = sim_bus_attach(bus, &sender);
    sim_bus_set_power(bus, testbed->rogues[side], false);
    return true;
}

bool scenario_testbed_init(scenario_testbed_t *testbed, const scenario_t *scenario) {
    memset(testbed, 0, sizeof *testbed);
    const uint32_t phase_us = scenario->tick_phase_us;
    const sim_hal_config_t port = {.clock_start_ms = scenario->clock_start_ms,
                                   .clock_phase_us = (uint16_t)((US_PER_MS - phase_us) % US_PER_MS),
                                   .watchdog_ms = (scenario->watchdog_ms != 0) ? scenario->watchdog_ms
                                                                               : scenario->config.watchdog_period_ms,
                                   .reset_cause = scenario->reset_cause,
                                   .store = &testbed->store};

    testbed->config = scenario->config;
    testbed->ids = scenario->ids;
    testbed->tick_phase_us = scenario->tick_phase_us;
    testbed->bus_count = scenario->vehicle.gateway ? HAL_CAN_SIDES : 1;
    sim_store_init(&testbed->store);
    sim_hal_init(&testbed->hal, &port);
    vehicle_init(&testbed->vehicle, &scenario->vehicle, send_of_vehicle, testbed);
    for (size_t side = 0; side < testbed->bus_count; side++) {
        testbed->running[side] = &testbed->buses[side];
        if (!sim_bus_init(&testbed->buses[side], scenario->bitrate) || !attach(testbed, (hal_can_side_t)side)) {
            return false;
        }
    }
    session_init(&testbed->session, &testbed->hal);
    testbed->hal.board = scenario->board;
    return session_observe(&testbed->session, pass_event, testbed);
}

void scenario_testbed_watch(scenario_testbed_t *testbed, const scenario_watch_t *watch) {
    if (testbed->watch_count == SCENARIO_WATCHES_MAX) {
        return;
    }
    testbed->watches[testbed->watch_count] = *watch;
    testbed->watch_count++;
    if (watch->on_frame == NULL) {
        return;
    }
    for (size_t i = 0; i < testbed->watch_count - 1; i++) {
        if (testbed->watches[i].on_frame != NULL) {
            return; /* the taps are there */
        }
    }
    for (size_t side = 0; side < testbed->bus_count; side++) {
        (void)sim_bus_add_tap(&testbed->buses[side], pass_frame, &testbed->sides[side]);
    }
}

static void start_supervisor(scenario_testbed_t *testbed) {
    session_start(&testbed->session, &testbed->config, testbed->t_ms, sim_hal_now_ms(&testbed->hal));
}

void scenario_testbed_start(scenario_testbed_t *testbed) {
    start_supervisor(testbed);
}

static void power_supervisor(scenario_testbed_t *testbed, bool on) {
    for (size_t side = 0; side < testbed->bus_count; side++) {
        sim_bus_set_power(&testbed->buses[side], testbed->hal.can[side].node, on);
    }
    testbed->off = !on;
}

static void restart(scenario_testbed_t *testbed, hal_reset_cause_t cause, uint32_t off_ms) {
    sim_hal_reset(&testbed->hal, cause);
    testbed->halted_until_ms = testbed->t_ms + off_ms;
    if (off_ms == 0) {
        start_supervisor(testbed);
    } else {
        session_stop(&testbed->session, testbed->t_ms);
        power_supervisor(testbed, false);
    }
}

/** The supervisor has power again. */
static void wake(scenario_testbed_t *testbed) {
    power_supervisor(testbed, true);
    sim_hal_reset(&testbed->hal, testbed->hal.config.reset_cause);
    start_supervisor(testbed);
}

static void flip_bit(scenario_testbed_t *testbed, uint32_t bit) {
    uint8_t *bytes = (uint8_t *)&testbed->session.supervisor;
    bytes[(bit / BITS_PER_BYTE) % sizeof testbed->session.supervisor] ^= (uint8_t)(1u << (bit % BITS_PER_BYTE));
}

static void start_bounce(scenario_testbed_t *testbed, const scenario_action_t *action) {
    scenario_bounce_t *bounce = &testbed->bounce;
    memcpy(bounce->after_ms, action->bounce_ms, sizeof bounce->after_ms);
    bounce->count = action->bounce_count;
    bounce->next = 0;
    bounce->due_ms = testbed->t_ms + bounce->after_ms[0];
    testbed->hal.board.button_is_down = !testbed->hal.board.button_is_down;
}

/** The changes of a bouncing button that are due. */
static void follow_bounce(scenario_testbed_t *testbed) {
    scenario_bounce_t *bounce = &testbed->bounce;
    if ((bounce->next < bounce->count) && (testbed->t_ms >= bounce->due_ms)) {
        testbed->hal.board.button_is_down = !testbed->hal.board.button_is_down;
        bounce->next++;
        bounce->due_ms += (bounce->next < bounce->count) ? bounce->after_ms[bounce->next] : 0;
    }
}

static void do_to_board(scenario_testbed_t *testbed, const scenario_action_t *action) {
    sim_board_t *board = &testbed->hal.board;

    switch (action->what) {
    case SCENARIO_CONTACT_WORKS:
        board->contact = SIM_CONTACT_WORKS;
        break;
    case SCENARIO_CONTACT_WELDED:
        board->contact = SIM_CONTACT_WELDED;
        break;
    case SCENARIO_CONTACT_STUCK:
        board->contact = SIM_CONTACT_STUCK_OPEN;
        break;
    case SCENARIO_FEEDBACK_INVERTED:
        board->feedback_is_inverted = action->on;
        break;
    case SCENARIO_STOP_OPEN:
        board->stop_is_open = action->on;
        break;
    case SCENARIO_BUTTON:
        board->button_is_down = action->on;
        testbed->bounce.count = 0;
        break;
    case SCENARIO_BUTTON_BOUNCES:
        start_bounce(testbed, action);
        break;
    case SCENARIO_CLOCK:
        board->clock_permille = action->permille;
        break;
    default:
        board->failed |= action->parts;
        break;
    }
}

static void do_to_supervisor(scenario_testbed_t *testbed, const scenario_action_t *action) {
    sim_bus_t *bus = &testbed->buses[action->side];
    const sim_bus_node_t node = testbed->hal.can[action->side].node;

    switch (action->what) {
    case SCENARIO_RESTART:
        restart(testbed, action->cause, action->ms);
        break;
    case SCENARIO_HANG:
        testbed->halted_until_ms = testbed->t_ms + action->ms;
        testbed->was_halted = true;
        break;
    case SCENARIO_BUS_OFF:
        sim_bus_force_bus_off(bus, node);
        break;
    case SCENARIO_TX_STALL:
        sim_bus_set_stalled(bus, node, action->on);
        testbed->stalled[action->side] = action->on;
        break;
    case SCENARIO_TX_SWALLOW:
        sim_hal_set_swallowing(&testbed->hal, action->side, action->on);
        break;
    case SCENARIO_QUEUE_FULL:
        sim_hal_set_full(&testbed->hal, action->side, action->on);
        break;
    case SCENARIO_OVERRUN:
        sim_bus_inject_overrun(bus, node);
        break;
    case SCENARIO_ERROR_PASSIVE:
        sim_bus_set_error_counters(bus, node, action->on ? PASSIVE_TEC : 0, 0);
        break;
    case SCENARIO_DELIVER:
        sim_bus_deliver(bus, node, &action->frame);
        break;
    case SCENARIO_CORRUPT_LATCH:
        (void)sim_store_corrupt_latch(&testbed->store, 0, 1);
        break;
    case SCENARIO_FLIP_BIT:
        flip_bit(testbed, action->ms);
        break;
    case SCENARIO_CORRUPT_FRAMES:
        sim_bus_corrupt_all(bus, action->ms);
        break;
    default:
        do_to_board(testbed, action);
        break;
    }
}

void scenario_testbed_act(scenario_testbed_t *testbed, uint64_t t_ms, const scenario_step_t *step) {
    testbed->t_ms = t_ms;
    if (step->of_vehicle) {
        (void)vehicle_do(&testbed->vehicle, t_ms, &step->vehicle);
    } else {
        do_to_supervisor(testbed, &step->supervisor);
    }
}

void scenario_testbed_do(scenario_testbed_t *testbed, const scenario_step_t *step) {
    scenario_testbed_act(testbed, step->at_ms, step);
}

static void restore_bus(const sim_bus_t *bus, sim_bus_t *saved) {
    memcpy(saved->taps, bus->taps, sizeof saved->taps);
    for (size_t i = 0; i < SIM_BUS_NODES_MAX; i++) {
        saved->nodes[i].config = bus->nodes[i].config;
    }
}

void scenario_testbed_restore(scenario_testbed_t *testbed, scenario_testbed_t *saved) {
    for (size_t side = 0; side < HAL_CAN_SIDES; side++) {
        restore_bus(&testbed->buses[side], &saved->buses[side]);
        saved->running[side] = testbed->running[side];
        saved->hal.can[side].bus = testbed->hal.can[side].bus;
        saved->sides[side].testbed = testbed->sides[side].testbed;
    }
    for (int n = 0; n < VEHICLE_NODES; n++) {
        saved->stations[n].testbed = testbed->stations[n].testbed;
    }
    saved->hal.ops = testbed->hal.ops;
    saved->hal.config.store = testbed->hal.config.store;
    saved->hal.sink = testbed->hal.sink;
    saved->hal.sink_ctx = testbed->hal.sink_ctx;
    saved->session.ports = testbed->session.ports;
    memcpy(saved->session.observers, testbed->session.observers, sizeof saved->session.observers);
    vehicle_set_send(&saved->vehicle, send_of_vehicle, testbed);
    memcpy(saved->watches, testbed->watches, sizeof saved->watches);
    *testbed = *saved;
}

static void step_supervisor(scenario_testbed_t *testbed) {
    if (testbed->off && (testbed->t_ms >= testbed->halted_until_ms)) {
        wake(testbed);
    }
    if (testbed->t_ms >= testbed->halted_until_ms) {
        for (size_t side = 0; testbed->was_halted && (side < testbed->bus_count); side++) {
            supervisor_hears(&testbed->sides[side], NULL); /* frames that arrived meanwhile */
        }
        testbed->was_halted = false;
        session_tick(&testbed->session, testbed->t_ms, sim_hal_now_ms(&testbed->hal));
    }
    if (!testbed->off && sim_hal_poll(&testbed->hal)) {
        restart(testbed, HAL_RESET_WATCHDOG, 0);
    }
}

static void run_buses(scenario_testbed_t *testbed, uint64_t until_us) {
    if (testbed->bus_count == 1) {
        sim_bus_run_until(&testbed->buses[HAL_CAN_VEHICLE], until_us);
    } else {
        sim_bus_run_all_until(testbed->running, testbed->bus_count, until_us);
    }
}

void scenario_testbed_tick(scenario_testbed_t *testbed, uint64_t t_ms) {
    const uint64_t until_us = (t_ms + 1) * US_PER_MS;

    testbed->t_ms = t_ms;
    follow_bounce(testbed);
    vehicle_tick(&testbed->vehicle, t_ms);
    if (testbed->power_changes != vehicle_power_changes(&testbed->vehicle)) {
        testbed->power_changes = vehicle_power_changes(&testbed->vehicle);
        for (int n = 0; n < VEHICLE_NODES; n++) {
            follow_power(testbed, (vehicle_node_t)n);
        }
    }
    if (testbed->past_wire_count != 0) {
        deliver_past_wire(testbed);
    }
    if (testbed->tick_phase_us != 0) {
        run_buses(testbed, (t_ms * US_PER_MS) + testbed->tick_phase_us);
    }
    step_supervisor(testbed);
    run_buses(testbed, until_us);
}

void scenario_testbed_view(const scenario_testbed_t *testbed, scenario_testbed_view_t *view) {
    const hal_t *hal = &testbed->hal;
    *view = (scenario_testbed_view_t){
        .t_ms = testbed->t_ms,
        .now_us = sim_bus_now_us(&testbed->buses[HAL_CAN_VEHICLE]),
        .status_frame_id = testbed->config.status_frame_id,
        .output_closed = hal->safety_output.on,
        .is_halted = testbed->t_ms < testbed->halted_until_ms,
        .received = hal->can[HAL_CAN_VEHICLE].received + hal->can[HAL_CAN_AI].received,
        .feeds = hal->feeds,
        .bites = hal->bites,
        .lost_frames = testbed->lost_frames,
        .is_off = testbed->off,
        .pin_is_down = hal->board.button_is_down,
    };
    vehicle_state(&testbed->vehicle, &view->vehicle);
}

void scenario_testbed_controller(const scenario_testbed_t *testbed, hal_can_side_t side,
                                 scenario_controller_t *controller) {
    const sim_hal_can_t *can = &testbed->hal.can[side];
    *controller = (scenario_controller_t){
        .is_stalled = can->full || testbed->stalled[side],
        .swallows = can->swallows,
    };
    sim_bus_status(&testbed->buses[side], can->node, &controller->status);
}

void scenario_testbed_bus_stats(const scenario_testbed_t *testbed, hal_can_side_t side, sim_bus_stats_t *stats) {
    sim_bus_stats(&testbed->buses[side], stats);
}

hal_t *scenario_testbed_port(scenario_testbed_t *testbed) {
    return &testbed->hal;
}

void scenario_testbed_vehicle(scenario_testbed_t *testbed, vehicle_view_t *view) {
    vehicle_view(&testbed->vehicle, testbed->t_ms, view);
}

agv_message_t scenario_testbed_message(const scenario_testbed_t *testbed, uint32_t id) {
    return (agv_message_t)agv_ids_find(&testbed->ids, id);
}

const scenario_events_t *scenario_testbed_events(const scenario_testbed_t *testbed) {
    return &testbed->events;
}

const session_t *scenario_testbed_session(const scenario_testbed_t *testbed) {
    return &testbed->session;
}

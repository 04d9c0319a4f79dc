#include "live/scenario_bus.h"

#include <errno.h>
#include <string.h>

#include "common/interrupt.h"
#include "common/report.h"
#include "hal_linux/linux_can.h"
#include "hal_linux/linux_clock.h"
#include "hal_linux/linux_loop.h"
#include "live/external.h"
#include "live/live_files.h"
#include "live/node.h"
#include "live/vehicle_bus.h"
#include "logs/candump_line.h"
#include "scenario/scenario_player.h"
#include "text/units.h"

/* 128 times 11 recessive bits at 500 kbit/s: how long the recovery of a controller takes on an idle bus. */
enum { RECOVERY_MS = 3, ERROR_DLC = 8 };

/** A scenario as it is played. */
typedef struct {
    const scenario_bus_t *bus;
    const scenario_t *scenario;
    scenario_check_t *check;
    const scenario_bus_watch_t *watch;
    linux_clock_t clock;
    bool has_begun; /* the clock counts the run's time: not while another program starts */
    linux_loop_t loop;
    bool loop_is_open;
    node_t *node;         /* NULL: without power, or another program */
    external_t *external; /* NULL: this program's own supervisor */
    live_files_t files;
    int64_t node_began_us;    /* when its own time began, in that of the run */
    uint64_t halted_until_ms; /* it hangs, or has no power, until then */
    bool hangs;
    scenario_events_t events;
    scenario_player_t player;
    uint64_t next_view_ms;                  /* the first millisecond that is not evaluated yet */
    linux_can_t controllers[HAL_CAN_SIDES]; /* what sends the error frames of the supervisor's controllers */
    uint64_t recovered_ms[HAL_CAN_SIDES];   /* end of bus-off; UINT64_MAX: no bus-off */
    events_summary_t *summary;
    bool vehicle_is_open;
    vehicle_bus_t vehicle;
} run_t;

static uint64_t scenario_ms(const run_t *run) {
    return linux_clock_now_us(&run->clock) / US_PER_MS;
}

static void on_supervisor_event(void *ctx, const session_event_t *reported) {
    run_t *run = ctx;
    session_event_t event = *reported;
    event.t_ms = run->has_begun ? scenario_ms(run) : 0;
    (void)scenario_events_note(&run->events, &event);
    scenario_check_event(run->check, &event);
    if (run->watch->on_event != NULL) {
        run->watch->on_event(run->watch->event_ctx, &event);
    }
}

static void on_supervisor_sent(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t at_us) {
    const run_t *run = ctx;
    const int64_t since_us = run->node_began_us + (int64_t)at_us;
    const uint64_t t_us = (since_us > 0) ? (uint64_t)since_us : 0;
    scenario_check_frame(run->check, t_us, side, SCENARIO_FROM_SUPERVISOR, frame);
    if (run->watch->on_sent != NULL) {
        run->watch->on_sent(run->watch->sent_ctx, side, frame, t_us);
    }
}

static void on_vehicle_sent(void *ctx, vehicle_node_t from, hal_can_side_t side, const hal_can_frame_t *frame,
                            uint64_t at_us) {
    const run_t *run = ctx;
    scenario_check_frame(run->check, at_us, side, (int)from, frame);
    if (run->external != NULL) {
        external_vehicle_sent(run->external, side, frame);
    }
}

/** On the shared bus a second interface that was named has nothing to do. */
static const char *interface_of(const run_t *run, hal_can_side_t side) {
    return ((side == HAL_CAN_VEHICLE) || run->scenario->vehicle.gateway) ? run->bus->interfaces[side] : NULL;
}

static bool open_external(run_t *run) {
    const external_config_t config = {
        .command = run->bus->command,
        .interfaces =
            {[HAL_CAN_VEHICLE] = interface_of(run, HAL_CAN_VEHICLE), [HAL_CAN_AI] = interface_of(run, HAL_CAN_AI)},
        .clock = &run->clock,
        .delay_us = (uint64_t)run->bus->tolerance_ms * US_PER_MS,
        .on_event = on_supervisor_event,
        .on_sent = on_supervisor_sent,
        .ctx = run,
    };
    run->external = external_open(&config);
    return (run->external != NULL) && external_start(run->external) && external_wait(run->external);
}

static bool open_node(run_t *run) {
    const node_config_t config = {
        .config = &run->scenario->config,
        .interfaces =
            {[HAL_CAN_VEHICLE] = interface_of(run, HAL_CAN_VEHICLE), [HAL_CAN_AI] = interface_of(run, HAL_CAN_AI)},
        .on_event = on_supervisor_event,
        .on_sent = on_supervisor_sent,
        .ctx = run,
    };
    run->node = node_open(&config);
    return (run->node != NULL) && live_files_follow(&run->files, &run->loop, run->node);
}

static void start_node(run_t *run) {
    run->node_began_us = (int64_t)linux_clock_now_us(&run->clock) - (int64_t)node_now_us(run->node);
    node_start(run->node);
}

static void close_node(run_t *run) {
    if (run->node != NULL) {
        live_files_leave(&run->files, &run->loop);
        events_summarise(node_session(run->node), run->summary);
        run->summary->t_ms = scenario_ms(run);
        node_close(run->node);
        run->node = NULL;
    }
}

static bool open_vehicle(run_t *run) {
    const vehicle_bus_config_t config = {
        .vehicle = run->scenario->vehicle,
        .interfaces =
            {[HAL_CAN_VEHICLE] = interface_of(run, HAL_CAN_VEHICLE), [HAL_CAN_AI] = interface_of(run, HAL_CAN_AI)},
        .clock = &run->clock,
        .on_sent = on_vehicle_sent,
        .ctx = run,
    };
    run->vehicle_is_open = vehicle_bus_open(&run->vehicle, &config);
    if (!run->vehicle_is_open) {
        return false;
    }
    for (unsigned file = 0; file < VEHICLE_BUS_FILES; file++) {
        const int fd = vehicle_bus_fd(&run->vehicle, file);
        if ((fd >= 0) && !linux_loop_add(&run->loop, fd)) {
            return report("cannot wait for the interfaces: %s", strerror(errno));
        }
    }
    return true;
}

/** Open a socket that only sends. */
static bool open_tx_socket(linux_can_t *can, const char *interface) {
    static const uint16_t nothing[1] = {0};
    const linux_can_options_t options = {.ids = nothing};
    char error[LINUX_CAN_ERROR_SIZE];
    return linux_can_open(can, interface, &options, error) || report("%s", error);
}

static bool open_controllers(run_t *run) {
    for (int side = 0; side < HAL_CAN_SIDES; side++) {
        const char *interface = interface_of(run, (hal_can_side_t)side);
        if ((interface != NULL) && !open_tx_socket(&run->controllers[side], interface)) {
            return false;
        }
    }
    return true;
}

/** Send an error frame of a controller of the supervisor. */
static void play_controller(run_t *run, hal_can_side_t side, uint32_t classes, uint8_t details) {
    const hal_can_frame_t frame = {.id = classes, .flags = HAL_CAN_ERROR, .length = ERROR_DLC, .data = {[1] = details}};
    (void)linux_can_write(&run->controllers[side], &frame);
}

static bool switch_on(run_t *run) {
    if (!open_node(run)) {
        return false;
    }
    start_node(run);
    return true;
}

/** Switch the supervisor off, and at once or later on again. */
static bool restart(run_t *run, uint64_t t_ms, uint32_t off_ms) {
    close_node(run);
    run->halted_until_ms = t_ms + off_ms;
    return (off_ms > 0) || switch_on(run);
}

static bool do_to_supervisor(run_t *run, uint64_t t_ms, const scenario_action_t *action) {
    switch (action->what) {
    case SCENARIO_RESTART:
        return restart(run, t_ms, action->ms);
    case SCENARIO_HANG:
        run->halted_until_ms = t_ms + action->ms;
        run->hangs = true;
        live_files_leave(&run->files, &run->loop);
        return true;
    case SCENARIO_BUS_OFF:
        /* A virtual interface does not see the request to recover; it comes after a configured time. */
        play_controller(run, action->side, CANDUMP_ERROR_BUS_OFF, 0);
        run->recovered_ms[action->side] = t_ms + run->scenario->config.bus_off_recovery_ms + RECOVERY_MS;
        return true;
    case SCENARIO_OVERRUN:
        play_controller(run, action->side, CANDUMP_ERROR_CONTROLLER, CANDUMP_CONTROLLER_RX_OVERFLOW);
        return true;
    default: /* SCENARIO_ERROR_PASSIVE; all others are left out */
        play_controller(run, action->side, CANDUMP_ERROR_CONTROLLER,
                        action->on ? CANDUMP_CONTROLLER_PASSIVE : CANDUMP_CONTROLLER_ACTIVE);
        return true;
    }
}

static bool do_steps(run_t *run, uint64_t t_ms) {
    const scenario_step_t *step = NULL;
    bool good = true;
    while (good && ((step = scenario_player_next(&run->player, t_ms)) != NULL)) {
        if (step->of_vehicle) {
            (void)vehicle_bus_do(&run->vehicle, &step->vehicle);
        } else {
            good = do_to_supervisor(run, t_ms, &step->supervisor);
        }
    }
    for (int side = 0; side < HAL_CAN_SIDES; side++) {
        if (t_ms >= run->recovered_ms[side]) {
            run->recovered_ms[side] = UINT64_MAX;
            play_controller(run, (hal_can_side_t)side, CANDUMP_ERROR_RESTARTED, 0);
        }
    }
    return good;
}

/** It has power again, or does not hang any more. */
static bool start_supervisor_again(run_t *run) {
    run->hangs = false;
    return (run->node != NULL) ? live_files_follow(&run->files, &run->loop, run->node) : switch_on(run);
}

static bool serve_supervisor(run_t *run, uint64_t t_ms, bool is_tick) {
    if (run->external != NULL) {
        return !is_tick || external_listen(run->external);
    }
    if (t_ms < run->halted_until_ms) {
        return true;
    }
    if ((run->hangs || (run->node == NULL)) && !start_supervisor_again(run)) {
        return false;
    }
    if (!is_tick) {
        node_receive(run->node);
        return true;
    }
    return !node_tick(run->node) || live_files_follow(&run->files, &run->loop, run->node);
}

static bool is_output_closed(const run_t *run) {
    if (run->external != NULL) {
        return external_output_closed(run->external);
    }
    return (run->node != NULL) && agv_supervisor_output_closed(&node_session(run->node)->supervisor);
}

static void check(run_t *run, uint64_t t_ms) {
    scenario_check_output(run->check, (uint32_t)t_ms, is_output_closed(run));
    for (; run->next_view_ms <= t_ms; run->next_view_ms++) {
        if (scenario_check_wants_vehicle(run->check, (uint32_t)run->next_view_ms)) {
            vehicle_view_t view;
            vehicle_bus_view(&run->vehicle, &view);
            scenario_check_vehicle(run->check, (uint32_t)run->next_view_ms, &view);
        }
    }
}

/** Wait for something, and do what is due. @return false: reported */
static bool advance(run_t *run) {
    const uint32_t what = linux_loop_wait(&run->loop);
    const bool is_tick = (what & LINUX_LOOP_TICK) != 0;
    const uint64_t t_ms = scenario_ms(run);
    if (((what & LINUX_LOOP_SIGNAL) != 0) || interrupt_pending()) {
        return report("interrupted");
    }
    if (!do_steps(run, t_ms)) {
        return false;
    }
    const bool good = is_tick ? vehicle_bus_tick(&run->vehicle) : vehicle_bus_receive(&run->vehicle);
    if (!good || !serve_supervisor(run, t_ms, is_tick)) {
        return false;
    }
    check(run, t_ms);
    return true;
}

static bool prepare_bus(run_t *run) {
    run->loop_is_open = linux_loop_open(&run->loop);
    if (!run->loop_is_open) {
        return report("cannot create the tick timer: %s", strerror(errno));
    }
    linux_clock_start(&run->clock);
    const bool is_outside = run->bus->command != NULL;
    if (!open_controllers(run) || !open_vehicle(run) || !(is_outside ? open_external(run) : open_node(run))) {
        return false;
    }
    linux_clock_start(&run->clock); /* opening took its time: now it begins */
    run->has_begun = true;
    (void)linux_loop_align(&run->loop, linux_clock_now_us(&run->clock));
    if (!is_outside) {
        start_node(run);
    }
    return true;
}

static void close_run(run_t *run) {
    node_finish(run->node);
    close_node(run);
    external_close(run->external);
    if (run->vehicle_is_open) {
        vehicle_bus_close(&run->vehicle);
    }
    for (int side = 0; side < HAL_CAN_SIDES; side++) {
        linux_can_close(&run->controllers[side]);
    }
    if (run->loop_is_open) {
        linux_loop_close(&run->loop);
    }
}

bool scenario_bus_check(const scenario_bus_t *bus) {
    for (int side = 0; side < HAL_CAN_SIDES; side++) {
        linux_can_t can = {.fd = -1};
        if ((bus->interfaces[side] != NULL) && !open_tx_socket(&can, bus->interfaces[side])) {
            return false;
        }
        linux_can_close(&can);
    }
    return true;
}

bool scenario_bus_play(const scenario_bus_t *bus, scenario_check_t *check, const scenario_bus_watch_t *watch,
                       events_summary_t *summary) {
    run_t run = {.bus = bus, .scenario = check->scenario, .check = check, .watch = watch, .summary = summary};
    live_files_none(&run.files);
    scenario_player_init(&run.player, check->scenario, &run.events);
    for (int side = 0; side < HAL_CAN_SIDES; side++) {
        run.controllers[side].fd = -1;
        run.recovered_ms[side] = UINT64_MAX;
    }
    bool good = prepare_bus(&run);
    while (good && (scenario_ms(&run) <= run.scenario->duration_ms)) {
        good = advance(&run);
    }
    if (good && (run.external != NULL)) {
        external_finish(run.external);
    }
    close_run(&run);
    if (good) {
        scenario_check_finish(check, &summary->counters);
    }
    return good;
}

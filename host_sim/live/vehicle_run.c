#include "live/vehicle_run.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "hal_linux/linux_clock.h"
#include "hal_linux/linux_loop.h"
#include "live/typed_lines.h"
#include "live/vehicle_bus.h"
#include "monitor/companion/monitor_companion.h"
#include "text/units.h"
#include "ui/vehicle_show.h"

enum { ENGAGE_MS = 1500, ENGAGE_AGAIN_MS = 500, THROTTLE_PERMILLE = 300, LINES_AT_ONCE = 16 };

/** A run. */
typedef struct {
    const vehicle_run_request_t *request;
    linux_clock_t clock;
    linux_loop_t loop;
    vehicle_bus_t bus;
    vehicle_show_t show;
    monitor_companion_t screen;
    typed_lines_t typed;
    size_t next_fault;
    uint64_t engage_ms; /**< when the operator engages the autopilot; UINT64_MAX: no more */
    bool was_refused;
    bool has_more_typed;  /**< lines may be left that were not taken yet */
    bool waits_for_typed; /**< the loop reports typed lines; else they are polled with every tick */
    bool was_down[HAL_CAN_SIDES];
    bool quits;
} vehicle_run_t;

/** Do the action of a --fault or of a typed line. */
static void do_action(vehicle_run_t *run, const vehicle_words_t *words) {
    const vehicle_action_t *action = &words->step.vehicle;

    const bool done = vehicle_bus_do(&run->bus, action);
    vehicle_show_event(&run->show, run->bus.now_ms, words->step.actor, "%s", words->what);
    if ((action->what == VEHICLE_DO_ENGAGE) || (action->what == VEHICLE_DO_DISENGAGE)) {
        run->engage_ms = UINT64_MAX; /* the user operates now */
    }
    if (!done) {
        vehicle_show_clear(&run->show, false);
        (void)report("%s %s: refused; %u rogue nodes are already sending", words->step.actor, words->what,
                     VEHICLE_ROGUES_MAX);
    }
}

static void act_on_faults(vehicle_run_t *run, uint64_t now_ms) {
    const vehicle_run_request_t *request = run->request;

    while ((run->next_fault < request->fault_count) && (request->faults[run->next_fault].step.at_ms <= now_ms)) {
        run->next_fault++;
        do_action(run, &request->faults[run->next_fault - 1]);
    }
}

static void vehicle_action(vehicle_run_t *run, vehicle_do_t what) {
    const vehicle_action_t action = {.what = what, .gear = AGV_GEAR_D, .throttle_permille = THROTTLE_PERMILLE};
    (void)vehicle_bus_do(&run->bus, &action);
}

/** The operator engages the autopilot; while the bus commands autopilot off he tries again. */
static void operate(vehicle_run_t *run, uint64_t now_ms) {
    vehicle_state_t state;

    if (now_ms < run->engage_ms) {
        return;
    }
    run->engage_ms = now_ms + ENGAGE_AGAIN_MS;
    if (!vehicle_is_running(&run->bus.vehicle, VEHICLE_VCU)) {
        return;
    }
    vehicle_action(run, VEHICLE_DO_ENGAGE);
    vehicle_state(&run->bus.vehicle, &state);
    if (state.autopilot) {
        vehicle_show_event(&run->show, run->bus.now_ms, "operator", "engage");
        run->engage_ms = UINT64_MAX;
    } else if (!run->was_refused) {
        vehicle_show_event(&run->show, run->bus.now_ms, "operator", "engage: refused, autopilot off is commanded");
        run->was_refused = true;
    }
}

static void show_links(vehicle_run_t *run) {
    for (unsigned side = 0; side < HAL_CAN_SIDES; side++) {
        if (run->bus.is_down[side] != run->was_down[side]) {
            run->was_down[side] = run->bus.is_down[side];
            vehicle_show_event(&run->show, run->bus.now_ms, run->request->bus.interfaces[side], "the interface is %s",
                               run->was_down[side] ? "down" : "up again");
        }
    }
}

/** Look at the vehicle, and print what has changed. */
static void show(vehicle_run_t *run) {
    vehicle_view_t view;

    vehicle_bus_view(&run->bus, &view);
    show_links(run);
    vehicle_show_view(&run->show, run->bus.now_ms, &view);
}

/** A line was typed. */
static void on_typed_line(vehicle_run_t *run, const char *line) {
    vehicle_words_t words;

    vehicle_show_clear(&run->show, true);
    if (line[strspn(line, " \t")] == '\0') {
        return;
    }
    switch (vehicle_words_command(line)) {
    case VEHICLE_COMMAND_QUIT:
        run->quits = true;
        break;
    case VEHICLE_COMMAND_HELP:
        vehicle_words_help();
        break;
    case VEHICLE_COMMAND_STATUS:
        show(run);
        vehicle_show_status(&run->show);
        break;
    case VEHICLE_COMMAND_NONE:
        if (vehicle_words_typed(line, &run->request->config, &words)) {
            do_action(run, &words);
        }
        break;
    default:
        break;
    }
}

/** Some of the lines that are there: the vehicle drives on while more of them come than can be taken. */
static void take_typed(vehicle_run_t *run) {
    typed_lines_t *typed = &run->typed;
    const char *line = "";

    if (typed->ended && !run->has_more_typed) {
        return;
    }
    for (unsigned i = 0; (i < LINES_AT_ONCE) && !run->quits && (line != NULL); i++) {
        line = typed_lines_next(typed);
        if (line != NULL) {
            on_typed_line(run, line);
        }
    }
    run->has_more_typed = line != NULL;
    if (typed->ended && !run->has_more_typed) {
        linux_loop_remove(&run->loop, typed->fd);
        run->waits_for_typed = true; /* for nothing, then */
    }
}

/**
 * A millisecond has passed. What has arrived in it is looked at now: the sockets are not waited for, which saves half
 * of the work, and frames carry the stamps of their arrival. @return false: an interface is gone; was reported
 */
static bool tick(vehicle_run_t *run) {
    const uint64_t now_ms = vehicle_bus_now_ms(&run->bus);

    act_on_faults(run, now_ms);
    operate(run, now_ms);
    const bool there = vehicle_bus_tick(&run->bus);
    show(run);
    return there;
}

static void show_end(vehicle_run_t *run) {
    const vehicle_bus_t *bus = &run->bus;

    (void)printf("%" PRIu64 ".%03" PRIu64 " s; frames: %" PRIu64 " sent, %" PRIu64 " refused by the kernel\n",
                 bus->now_ms / MS_PER_S, bus->now_ms % MS_PER_S, bus->sent, bus->unsent);
}

/** No signal, no `quit`, the time is not over, and standard output works. */
static bool goes_on(const vehicle_run_t *run, uint32_t events) {
    const uint64_t for_ms = run->request->bus.for_ms;

    return ((events & LINUX_LOOP_SIGNAL) == 0) && !run->quits && (ferror(stdout) == 0) &&
           ((for_ms == INTERFACE_UNTIL_SIGNAL) || (run->bus.now_ms < for_ms));
}

/** Go on until the end. @return false: an interface is gone; was reported */
static bool run_until_end(vehicle_run_t *run) {
    uint32_t events = LINUX_LOOP_TICK;
    bool there = true;

    while (there && goes_on(run, events)) {
        if ((events & LINUX_LOOP_TICK) != 0) {
            there = tick(run);
        }
        if (((events & LINUX_LOOP_FILE) != 0) || !run->waits_for_typed || run->has_more_typed) {
            take_typed(run);
        }
        events = there ? linux_loop_wait(&run->loop) : 0;
    }
    return there;
}

static bool open_bus(vehicle_run_t *run) {
    const vehicle_run_request_t *request = run->request;
    vehicle_bus_config_t config = {
        .interfaces = {[HAL_CAN_VEHICLE] = request->bus.interfaces[HAL_CAN_VEHICLE],
                       [HAL_CAN_AI] = request->bus.interfaces[HAL_CAN_AI]},
        .clock = &run->clock,
    };

    vehicle_defaults(&config.vehicle);
    agv_config_ids(&request->config, &config.vehicle.ids);
    config.vehicle.gateway = request->bus.interfaces[HAL_CAN_AI] != NULL;
    return vehicle_bus_open(&run->bus, &config);
}

static bool run_on_bus(vehicle_run_t *run) {
    vehicle_view_t view;

    monitor_companion_show(&run->screen);
    vehicle_bus_view(&run->bus, &view);
    vehicle_show_init(&run->show, &view);
    run->waits_for_typed = linux_loop_add(&run->loop, run->typed.fd); /* refused for a file */
    vehicle_action(run, VEHICLE_DO_AI_DRIVE);
    const bool good = run_until_end(run);
    vehicle_show_clear(&run->show, false);
    monitor_companion_end(&run->screen);
    show_end(run);
    return good;
}

/** Start the screen, which is a process of its own: before anything is opened. @return false: reported */
static bool open_vehicle_screen(vehicle_run_t *run) {
    const vehicle_run_request_t *request = run->request;
    const monitor_companion_config_t config = {
        .title = "vehicle",
        .config = &request->config,
        .interfaces = {[HAL_CAN_VEHICLE] = request->bus.interfaces[HAL_CAN_VEHICLE],
                       [HAL_CAN_AI] = request->bus.interfaces[HAL_CAN_AI]},
        .can_type = true,
    };
    return !request->screen || monitor_companion_fork(&run->screen, &config);
}

status_t vehicle_run_nodes(const vehicle_run_request_t *request) {
    vehicle_run_t run = {.request = request, .engage_ms = request->manual ? UINT64_MAX : ENGAGE_MS};
    bool good = false;

    if (!open_vehicle_screen(&run)) {
        return STATUS_UNUSABLE;
    }
    typed_lines_init(&run.typed, (run.screen.child != 0) ? monitor_companion_typed(&run.screen) : STDIN_FILENO);
    if (!linux_loop_open(&run.loop)) {
        (void)report("cannot wait for timers and signals: %s", strerror(errno));
        monitor_companion_end(&run.screen);
        return STATUS_UNUSABLE;
    }
    linux_clock_start(&run.clock);
    if (open_bus(&run)) {
        good = run_on_bus(&run);
        vehicle_bus_close(&run.bus);
    }
    linux_loop_close(&run.loop);
    monitor_companion_end(&run.screen);
    return good ? STATUS_OK : STATUS_UNUSABLE;
}

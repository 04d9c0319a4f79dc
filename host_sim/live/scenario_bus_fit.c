/* What of a scenario can be shown on a real bus, and how strictly its times hold there. */
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "common/message_facts.h"
#include "live/scenario_bus.h"

enum { PATH_SIZE = 64, STATUS_AGAIN_MS = 5 };

#define NO_BOARD "board: a computer has no feedback, emergency stop, reset button or second clock"

/** Why a step of the supervisor or the bus cannot be played; NULL: it can. */
static const char *const left_out_steps[] = {
    [SCENARIO_TX_STALL] = "stall_tx: the frames of a real interface cannot be held back",
    [SCENARIO_TX_SWALLOW] = "swallow_tx: the frames of a real interface cannot be discarded",
    [SCENARIO_QUEUE_FULL] = "fill_queue: the queue of a real interface cannot be filled on demand",
    [SCENARIO_DELIVER] = "deliver: on a real bus every frame is on the wire",
    [SCENARIO_CORRUPT_LATCH] = "corrupt_latch: the memory of the node is not accessible",
    [SCENARIO_FLIP_BIT] = "flip_bit: the memory of the node is not accessible",
    [SCENARIO_CONTACT_WORKS] = NO_BOARD,
    [SCENARIO_CONTACT_WELDED] = NO_BOARD,
    [SCENARIO_CONTACT_STUCK] = NO_BOARD,
    [SCENARIO_FEEDBACK_INVERTED] = NO_BOARD,
    [SCENARIO_STOP_OPEN] = NO_BOARD,
    [SCENARIO_BUTTON] = NO_BOARD,
    [SCENARIO_BUTTON_BOUNCES] = NO_BOARD,
    [SCENARIO_CLOCK] = NO_BOARD,
    [SCENARIO_TEST_FAILS] = NO_BOARD,
    [SCENARIO_CORRUPT_FRAMES] = "destroy: frames on a real bus cannot be destroyed",
};

/** A virtual interface has no controller. Error frames are sent on it instead. */
static bool is_virtual(const char *interface) {
    char path[PATH_SIZE];
    struct stat found;
    (void)snprintf(path, sizeof path, "/sys/devices/virtual/net/%s", interface);
    return stat(path, &found) == 0;
}

static const char *why_not_controller(const scenario_bus_t *bus, const scenario_action_t *action) {
    const char *interface = bus->interfaces[action->side];
    return ((interface == NULL) || is_virtual(interface))
               ? NULL
               : "bus_off, overrun, error_passive: played on a virtual interface only";
}

/** In bus-off a virtual interface still receives. It matters only for an AI side that is silent for too long. */
static const char *why_not_bus_off(const scenario_bus_t *bus, const scenario_t *scenario,
                                   const scenario_action_t *action) {
    if ((action->side == HAL_CAN_AI) &&
        (scenario->config.bus_off_recovery_ms >= scenario->config.steering_command_timeout_ms)) {
        return "bus_off: a virtual interface still receives from the AI computer";
    }
    return why_not_controller(bus, action);
}

/** Actions that are not possible with an external supervisor. */
static const char *why_not_of_outsider(const scenario_action_t *action) {
    switch (action->what) {
    case SCENARIO_RESTART:
        return "restart: the start-up time of another program is unknown";
    case SCENARIO_HANG:
        return "hang: another program cannot be stopped";
    case SCENARIO_BUS_OFF:
    case SCENARIO_OVERRUN:
    case SCENARIO_ERROR_PASSIVE:
        return "bus_off, overrun, error_passive: not played to another program";
    default:
        return NULL;
    }
}

static const char *why_not_step(const scenario_bus_t *bus, const scenario_t *scenario,
                                const scenario_action_t *action) {
    const char *why = (bus->command != NULL) ? why_not_of_outsider(action) : NULL;
    if (why != NULL) {
        return why;
    }
    switch (action->what) {
    case SCENARIO_RESTART:
        return (action->cause == HAL_RESET_POWER_ON) ? NULL : "restart: a program starts by power-on only";
    case SCENARIO_HANG:
        return ((scenario->watchdog_ms == UINT32_MAX) || (action->ms < scenario->config.watchdog_period_ms))
                   ? NULL
                   : "hang: a computer has no hardware watchdog";
    case SCENARIO_BUS_OFF:
        return why_not_bus_off(bus, scenario, action);
    case SCENARIO_OVERRUN:
    case SCENARIO_ERROR_PASSIVE:
        return why_not_controller(bus, action);
    default:
        return left_out_steps[action->what];
    }
}

static const char *why_not_vehicle(const vehicle_action_t *action) {
    const bool is_fd = (action->what == VEHICLE_DO_SEND) && ((action->frame.flags & HAL_CAN_FD) != 0);
    return is_fd ? "send, kind: fd: the interfaces are used as classic CAN" : NULL;
}

static bool has_board(const sim_board_t *board) {
    return board->has_feedback || board->has_emergency_stop || board->has_reset_button || board->has_second_clock;
}

static const char *why_not_start(const scenario_t *scenario) {
    if (scenario->bitrate != SCENARIO_DEFAULT_BITRATE) {
        return "bitrate: a real interface has its own";
    }
    if (scenario->clock_start_ms != 0) {
        return "clock_start_ms: the clock of a node starts at 0";
    }
    if (scenario->tick_phase_us != 0) {
        return "tick_phase_us: the tick phase of a computer cannot be set";
    }
    if (scenario->reset_cause != HAL_RESET_POWER_ON) {
        return "reset_cause: a program starts by power-on only";
    }
    if (has_board(&scenario->board)) {
        return NO_BOARD;
    }
    return (scenario->board.failed == 0) ? NULL : "self_test: the self-test of a node cannot be made to fail";
}

/** Faults that need acknowledges or collisions on the wire, unless a step plays them. */
static const struct {
    agv_fault_t fault;
    scenario_do_t played_by;
    const char *why;
} faults_of_wire[] = {
    {AGV_FAULT_TX_STALLED, SCENARIO_TX_STALL,
     "TX_STALLED: a virtual interface accepts every frame, acknowledged or not"},
    {AGV_FAULT_AI_BUS_OFF, SCENARIO_BUS_OFF,
     "AI_BUS_OFF: a virtual interface accepts every frame, acknowledged or not"},
    {AGV_FAULT_ERROR_PASSIVE, SCENARIO_ERROR_PASSIVE, "ERROR_PASSIVE: frames do not collide on a virtual interface"},
};

static bool expects(const scenario_expect_t *expect, agv_fault_t fault) {
    bool expected = false;
    for (size_t i = 0; i < expect->faults.count; i++) {
        expected = expected || (expect->faults.items[i].fault == fault);
    }
    return expected;
}

static bool plays(const scenario_t *scenario, scenario_do_t what) {
    bool played = false;
    for (size_t i = 0; i < scenario->step_count; i++) {
        const scenario_step_t *step = &scenario->steps[i];
        played = played || (!step->of_vehicle && (step->supervisor.what == what));
    }
    return played;
}

static const char *why_not_faults(const scenario_t *scenario) {
    for (size_t i = 0; i < sizeof faults_of_wire / sizeof faults_of_wire[0]; i++) {
        if (expects(&scenario->expect, faults_of_wire[i].fault) && !plays(scenario, faults_of_wire[i].played_by)) {
            return faults_of_wire[i].why;
        }
    }
    return NULL;
}

/** Whether a frame is one that the kernel hands over to the supervisor (node.c). */
static bool is_of_protocol(const scenario_t *scenario, uint32_t id) {
    return message_id_is_heard(&scenario->ids, id) || (id == scenario->config.status_frame_id);
}

/** What the supervisor counts of frames that it is not given here. */
static const char *why_not_counters(const scenario_t *scenario) {
    static const char *const of_received[] = {"received", "dropped", "rejected_extended", "rejected_remote"};
    bool foreign = false;
    for (size_t i = 0; i < scenario->step_count; i++) {
        const scenario_step_t *step = &scenario->steps[i];
        foreign = foreign || (step->of_vehicle && (step->vehicle.what == VEHICLE_DO_SEND) &&
                              !is_of_protocol(scenario, step->vehicle.frame.id));
    }
    for (size_t i = 0; foreign && (i < scenario->expect.counters.count); i++) {
        const scenario_counter_t *counter = &scenario->expect.counters.items[i];
        for (size_t name = 0; name < sizeof of_received / sizeof of_received[0]; name++) {
            if ((counter->value.from > 0) && (strcmp(counter->name, of_received[name]) == 0)) {
                return "counters_at_end: the kernel filters out frames that are not in the protocol";
            }
        }
    }
    return NULL;
}

const char *scenario_bus_leaves_out(const scenario_bus_t *bus, const scenario_t *scenario) {
    const char *why = why_not_start(scenario);
    for (size_t i = 0; (why == NULL) && (i < scenario->step_count); i++) {
        const scenario_step_t *step = &scenario->steps[i];
        why = step->of_vehicle ? why_not_vehicle(&step->vehicle) : why_not_step(bus, scenario, &step->supervisor);
    }
    why = (why != NULL) ? why : why_not_faults(scenario);
    if ((why == NULL) && (scenario->expect.no_hazards != 0)) {
        why = "hazards: they are checked inside the simulated vehicle";
    }
    return (why != NULL) ? why : why_not_counters(scenario);
}

/** An event is expected within it. */
static void widen(scenario_window_t *window, uint32_t by_ms) {
    window->early = (window->from < by_ms) ? by_ms - window->from : 0;
    window->from = (window->from > by_ms) ? window->from - by_ms : 0;
    window->to = (window->to < UINT32_MAX - by_ms) ? window->to + by_ms : UINT32_MAX;
}

/** A condition holds throughout it. One that is shorter than twice the tolerance is not evaluated. */
static void narrow(scenario_window_t *window, uint32_t by_ms, uint32_t end_ms) {
    const bool from_start = (window->from == 0) && (window->after.kind == SCENARIO_FROM_START);
    window->from += from_start ? 0 : by_ms;
    window->to -= ((window->to < end_ms) && (window->to > by_ms)) ? by_ms : 0;
    if (window->from > window->to) {
        *window = (scenario_window_t){.from = UINT32_MAX, .to = 0};
    }
}

/** At a trip the supervisor sends a status frame again that may have been discarded. An interface may have sent it already. */
static void tolerate_again(const scenario_t *scenario, scenario_frame_t *frame) {
    const bool is_status = scenario_frame_id(scenario, frame) == scenario->config.status_frame_id;
    frame->again_ms = is_status ? (uint32_t)STATUS_AGAIN_MS : 0;
    for (size_t i = 0; i < scenario->expect.states.count; i++) {
        frame->again_max += (scenario->expect.states.items[i].to == AGV_STATE_TRIPPED) ? 1 : 0;
    }
}

static void tolerate_frames(scenario_t *scenario, uint32_t by_ms) {
    scenario_expect_t *expect = &scenario->expect;
    for (size_t i = 0; i < expect->frames.count; i++) {
        scenario_frame_t *frame = &expect->frames.items[i];
        if (frame->every_ms != 0) {
            narrow(&frame->at_ms, by_ms, scenario->duration_ms);
            frame->jitter_ms += by_ms;
            tolerate_again(scenario, frame);
        } else if (frame->count.to == UINT32_MAX) {
            widen(&frame->at_ms, by_ms);
        }
    }
    for (size_t i = 0; i < expect->never.count; i++) {
        narrow(&expect->never.items[i].at_ms, by_ms, scenario->duration_ms);
    }
}

void scenario_bus_tolerate(const scenario_bus_t *bus, scenario_t *scenario) {
    const uint32_t tolerance_ms = bus->tolerance_ms;
    scenario_expect_t *expect = &scenario->expect;
    if (bus->command != NULL) {
        expect->counters.count = 0;
    }
    tolerate_frames(scenario, tolerance_ms);
    for (size_t i = 0; i < expect->states.count; i++) {
        widen(&expect->states.items[i].at_ms, tolerance_ms);
    }
    for (size_t i = 0; i < expect->outputs.count; i++) {
        widen(&expect->outputs.items[i].at_ms, tolerance_ms);
    }
    for (size_t i = 0; i < expect->leds.count; i++) {
        scenario_led_t *led = &expect->leds.items[i];
        if (led->at_some_time) {
            widen(&led->at_ms, tolerance_ms);
        } else {
            narrow(&led->at_ms, tolerance_ms, scenario->duration_ms);
        }
    }
    for (size_t i = 0; i < expect->faults.count; i++) {
        widen(&expect->faults.items[i].raised_ms, tolerance_ms);
        widen(&expect->faults.items[i].ended_ms, tolerance_ms);
    }
    for (size_t i = 0; i < expect->resets.count; i++) {
        widen(&expect->resets.items[i].at_ms, tolerance_ms);
    }
    for (size_t i = 0; i < expect->startups.count; i++) {
        widen(&expect->startups.items[i].at_ms, tolerance_ms);
    }
    for (size_t i = 0; i < expect->vehicle.count; i++) {
        scenario_window_t *window = &expect->vehicle.items[i].at_ms;
        if (window->from != window->to) {
            widen(window, tolerance_ms);
        }
    }
}

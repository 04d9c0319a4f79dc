#include "agv/supervisor.h"

#include <stddef.h>
#include <string.h>

#include "agv/checksum.h"
#include "hal/led.h"
#include "hal/store.h"
#include "hal/watchdog.h"
#include "supervisor_internal.h"

_Static_assert(sizeof(agv_core_t) % sizeof(uint32_t) == 0u, "whole words: all of it is under the seal");

/* Activities that check in before the hardware watchdog is fed (TIM-3). */
enum { CHECKED_RECEIVE = 1, CHECKED_STEP = 2, CHECKED_SEND = 4, CHECKED_ALL = 7 };

/* The supervisor's time never goes backwards, whatever stamps frames carry. */
static void advance(agv_core_t *core, uint32_t moment_ms, uint32_t moment_us) {
    const uint32_t now_us = (moment_ms * 1000u) + moment_us;
    const bool same_ms_later = (moment_ms == core->now_ms) && ((now_us - core->now_us) < 1000u);
    if (same_ms_later || (agv_age_ms(moment_ms, core->now_ms) > 0u)) {
        core->now_ms = moment_ms;
        core->now_us = now_us;
    }
}

static void attach(agv_core_t *core, const agv_ports_t *ports) {
    core->hal = ports->hal;
    core->recorder = ports->recorder;
}

/* Every call begins with a look at the whole memory (INT-5). */
static agv_core_t *open_core(agv_supervisor_t *supervisor, const agv_ports_t *ports, uint32_t moment_ms,
                             uint32_t moment_us) {
    agv_core_t *const core = &supervisor->core;
    const bool intact =
        (supervisor->seal == agv_seal(core, sizeof *core)) && agv_state_machine_is_sound(&core->machine);
    attach(core, ports);
    if (intact) {
        advance(core, moment_ms, moment_us);
    } else {
        core->now_ms = moment_ms;
        core->now_us = moment_ms * 1000u;
        agv_core_begin_corrupted(core);
    }
    return core;
}

static void close_core(agv_supervisor_t *supervisor) {
    supervisor->core.hal = NULL;
    supervisor->core.recorder = NULL;
    supervisor->seal = agv_seal(&supervisor->core, sizeof supervisor->core);
}

static uint32_t step_time(agv_core_t *core) {
    const uint32_t elapsed_ms = core->now_ms - core->last_tick_ms;
    if (agv_core_step_is_late(core)) {
        agv_faults_event(core, AGV_FAULT_STEP_OVERRUN);
    }
    core->last_tick_ms = core->now_ms;
    return elapsed_ms;
}

/* SUP-7, one side: recovery is asked for after a purge; what waited is never sent. */
static uint32_t follow_bus(agv_core_t *core, hal_can_side_t side) {
    const uint32_t report = agv_bus_tick(core, side);
    if ((report & (AGV_BUS_OFF | AGV_BUS_RECOVERED)) != 0u) {
        agv_transmitter_discard(core, side);
    }
    if ((report & AGV_BUS_ASK_RECOVERY) != 0u) {
        hal_can_purge(core->hal, side);
        hal_can_recover(core->hal, side);
    }
    return report;
}

/* Returns whether the vehicle side has come back from bus-off. */
static bool judge_buses(agv_core_t *core) {
    const uint32_t vehicle = follow_bus(core, HAL_CAN_VEHICLE);
    uint32_t ai = 0u;
    if (agv_core_is_gateway(core)) {
        ai = follow_bus(core, HAL_CAN_AI);
    }
    if (((vehicle | ai) & AGV_BUS_OVERRUN) != 0u) {
        agv_faults_event(core, AGV_FAULT_RX_OVERRUN);
    }
    agv_faults_level(core, AGV_FAULT_BUS_OFF, (vehicle & AGV_BUS_OFF) != 0u);
    agv_faults_level(core, AGV_FAULT_TX_STALLED, agv_transmitter_stalled(core) || ((vehicle & AGV_BUS_STALLED) != 0u));
    agv_faults_level(core, AGV_FAULT_ERROR_PASSIVE, (vehicle & AGV_BUS_PASSIVE) != 0u);
    agv_faults_level(core, AGV_FAULT_AI_BUS_OFF, (ai & (AGV_BUS_OFF | AGV_BUS_STALLED)) != 0u);
    return (vehicle & AGV_BUS_RECOVERED) != 0u;
}

static void transmit(agv_core_t *core) {
    agv_transmitter_tick(core);
    core->checked_in |= CHECKED_SEND;
    if (core->summary.changed) {
        (void)agv_core_react(core); /* the gate refused a frame */
    }
}

void agv_core_show_led(agv_core_t *core, uint32_t elapsed_ms) {
    if (agv_led_tick(&core->led, core->led_code, core->config.shadow == (uint16_t)AGV_SHADOW_ON, elapsed_ms)) {
        hal_led_set(core->hal, core->led.on);
    }
}

/* INT-3: flash may stall the processor, so only where no reaction can be due. One event a tick. */
static void store_events(agv_core_t *core) {
    if ((core->machine.state != (uint8_t)AGV_STATE_SAFE) &&
        ((core->machine.state != (uint8_t)AGV_STATE_STANDBY) || !agv_monitor_standstill(core))) {
        return;
    }
    const agv_event_t *const event = agv_recorder_next_to_store(core->recorder);
    if (event != NULL) {
        (void)hal_store_append(core->hal, event, sizeof *event);
        agv_recorder_stored(core->recorder);
    }
}

static void feed_watchdog(agv_core_t *core) {
    if (core->checked_in == (uint8_t)CHECKED_ALL) {
        core->checked_in = 0u;
        agv_watch_start(core, AGV_WATCH_UNFED);
        hal_watchdog_feed(core->hal);
    }
}

void agv_supervisor_start(agv_supervisor_t *supervisor, const agv_ports_t *ports, const agv_config_t *config,
                          bool self_test_passed, uint32_t now_ms) {
    agv_core_t *const core = &supervisor->core;
    uint32_t found = self_test_passed ? 0u : AGV_FOUND_SELF_TEST_FAILED;
    (void)memset(core, 0, sizeof *core);
    attach(core, ports);
    core->now_ms = now_ms;
    core->now_us = now_ms * 1000u;
    core->config = *config;
    agv_core_keep_wiring(core);
    if (!agv_core_check_config(core, true)) {
        found |= AGV_FOUND_CONFIG_INVALID;
    }
    agv_recorder_start(core->recorder);
    agv_core_begin(core, found);
    close_core(supervisor);
}

void agv_supervisor_frame(agv_supervisor_t *supervisor, const agv_ports_t *ports, hal_can_side_t side,
                          const hal_can_frame_t *frame) {
    agv_core_t *const core = open_core(supervisor, ports, frame->time_ms, frame->time_us);
    agv_core_frame(core, side, frame);
    close_core(supervisor);
}

void agv_supervisor_tick(agv_supervisor_t *supervisor, const agv_ports_t *ports, uint32_t now_ms) {
    agv_core_t *const core = open_core(supervisor, ports, now_ms, 0u);
    const uint32_t elapsed_ms = step_time(core);
    core->checked_in |= (uint8_t)(CHECKED_STEP | (supervisor->receive_alive ? CHECKED_RECEIVE : 0));
    supervisor->receive_alive = false;
    const bool recovered = judge_buses(core);
    agv_monitor_tick(core);
    const bool all_sent = agv_core_react(core);
    if (recovered && !all_sent) {
        agv_transmitter_burst(core);
    }
    transmit(core);
    feed_watchdog(core);
    agv_core_show_led(core, elapsed_ms);
    store_events(core);
    close_core(supervisor);
}

void agv_supervisor_receive_alive(agv_supervisor_t *supervisor) {
    supervisor->receive_alive = true;
}

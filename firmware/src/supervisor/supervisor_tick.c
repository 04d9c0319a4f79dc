#include <stddef.h>

#include "hal/led.h"
#include "hal/safety_output.h"
#include "hal/store.h"
#include "hal/watchdog.h"
#include "observe/deadlines.h"
#include "supervisor/supervisor_internal.h"

/* Activities that check in before the hardware watchdog is fed (TIM-3). */
enum { CHECKED_RECEIVE = 1, CHECKED_STEP = 2, CHECKED_SEND = 4, CHECKED_ALL = 7 };

static uint32_t step_time(agv_core_t *core) {
    const uint32_t elapsed_ms = core->timers.now_ms - core->last_tick_ms;
    if (agv_core_step_is_late(core)) {
        agv_fault_monitor_event(&core->faults, &core->timers, AGV_FAULT_STEP_OVERRUN);
    }
    core->last_tick_ms = core->timers.now_ms;
    return elapsed_ms;
}

/* SUP-7, one side: request the recovery after a purge; waiting frames are never sent. */
static uint32_t follow_bus(agv_core_t *core, hal_t *hal, hal_can_side_t side) {
    const uint32_t report = agv_bus_tick(&core->buses[side], &core->timers, &core->config, hal, side);
    if ((report & (AGV_BUS_OFF | AGV_BUS_RECOVERED)) != 0u) {
        agv_transmitter_discard(&core->transmitter, &core->timers, side);
    }
    if ((report & AGV_BUS_ASK_RECOVERY) != 0u) {
        hal_can_purge(hal, side);
        hal_can_recover(hal, side);
    }
    return report;
}

/* FSM-10: whether a 065h has left the controller. Bus-off discards it. */
static void track_hold_frame(agv_core_t *core, uint32_t report) {
    if ((report & (AGV_BUS_OFF | AGV_BUS_RECOVERED)) != 0u) {
        agv_hold_withdrawn(&core->hold);
    } else if ((report & AGV_BUS_WAITING) == 0u) {
        agv_hold_left(&core->hold);
    } else {
        /* it may still wait */
    }
}

/*
 * SUP-7: a stall begins when a frame has waited for too long, and ends when none waits. In TRIPPED and SAFE all frames are then
 * withdrawn; this does not end the stall.
 */
static bool follow_stall(agv_core_t *core, uint32_t report) {
    const bool stalled = agv_transmitter_is_stalled(&core->timers) || ((report & AGV_BUS_STALLED) != 0u);
    const bool waits = agv_transmitter_waits(&core->timers) || ((report & AGV_BUS_WAITING) != 0u);
    core->stall_begins = stalled && (core->stall_begins || !core->stalled);
    core->stalled = stalled;
    return stalled || (waits && agv_fault_monitor_is_active(&core->faults, AGV_FAULT_TX_STALLED));
}

/* Overruns. SUP-7: one of the AI side only warns. */
static void observe_overruns(agv_core_t *core, uint32_t vehicle, uint32_t ai) {
    const bool warns = !agv_config_is_trip(&core->config, AGV_FAULT_RX_OVERRUN);
    if ((((vehicle | (warns ? ai : 0u)) & AGV_BUS_OVERRUN)) != 0u) {
        agv_fault_monitor_event(&core->faults, &core->timers, AGV_FAULT_RX_OVERRUN);
    }
}

/* Returns whether the vehicle side has recovered from bus-off. */
static bool observe_buses(agv_core_t *core, hal_t *hal) {
    agv_fault_monitor_t *const faults = &core->faults;
    const uint32_t vehicle = follow_bus(core, hal, HAL_CAN_VEHICLE);
    const uint32_t ai = agv_core_is_gateway(core) ? follow_bus(core, hal, HAL_CAN_AI) : 0u;
    track_hold_frame(core, vehicle);
    observe_overruns(core, vehicle, ai);
    agv_fault_monitor_set(faults, AGV_FAULT_BUS_OFF, (vehicle & AGV_BUS_OFF) != 0u);
    agv_fault_monitor_set(faults, AGV_FAULT_TX_STALLED, follow_stall(core, vehicle));
    agv_fault_monitor_set(faults, AGV_FAULT_ERROR_PASSIVE, (vehicle & AGV_BUS_PASSIVE) != 0u);
    agv_fault_monitor_set(faults, AGV_FAULT_AI_BUS_OFF,
                          ((ai & (AGV_BUS_OFF | AGV_BUS_STALLED)) != 0u) ||
                              agv_timer_reached(&core->timers, AGV_TIMER_TX_AI));
    return (vehicle & AGV_BUS_RECOVERED) != 0u;
}

/* HW-1 to HW-4. The output is compared with what it was set to at the last tick, or since. */
static void observe_hardware(agv_core_t *core, hal_t *hal, uint32_t elapsed_ms) {
    agv_hardware_tick(&core->hardware, &core->faults, &core->timers, &core->config, hal, elapsed_ms,
                      core->machine.output_closed);
    agv_reset_button_read(&core->reset_pin, core->hardware.button);
}

/* A gateway expects no command while the last 363h reports manual alone: an operator may be taking over (TOP-2). */
static bool expects_commands(const agv_core_t *core) {
    const agv_mode_t *const mode = &core->mode;
    const bool is_handed_over = agv_mode_is_manual(mode) && !agv_mode_is_ambiguous(mode);
    return agv_mode_is_engaged(mode) && (!agv_core_is_gateway(core) || !is_handed_over);
}

static void observe_time(agv_core_t *core, uint32_t elapsed_ms) {
    agv_timers_t *const timers = &core->timers;
    agv_fault_monitor_t *const faults = &core->faults;
    agv_fault_monitor_tick(faults, timers);
    agv_liveness_tick(&core->liveness, timers, agv_mode_is_engaged(&core->mode));
    const bool vcu_alive = agv_liveness_alive(&core->liveness, AGV_NODE_VCU);
    agv_core_follow_mode(core, agv_mode_tick(&core->mode, timers, &core->config, vcu_alive, elapsed_ms),
                         timers->now_ms);
    if (!vcu_alive) {
        agv_reset_button_lose(&core->reset_button);
        agv_reset_button_lose(&core->reset_pin);
    }
    agv_core_evaluate_standstill(core);
    agv_intrusion_evaluate(&core->intrusion, faults, timers, &core->config, &core->liveness);
    agv_mode_check(&core->mode, timers, faults, &core->config, agv_core_is_supervising(core),
                   agv_vehicle_is_at_standstill(timers));
    agv_deadlines_tick(faults, timers, &core->config, &core->liveness, expects_commands(core));
    const agv_motion_facts_t facts = agv_core_motion_facts(core);
    agv_motion_checks_tick(&core->motion_checks, &facts, elapsed_ms);
    agv_vehicle_doubt_wheels(&core->vehicle, timers, &core->config,
                             agv_motion_checks_doubts_wheels(&core->motion_checks, &core->vehicle));
}

void agv_core_show_led(agv_core_t *core, const agv_ports_t *ports, uint32_t elapsed_ms) {
    if (agv_led_tick(&core->led, core->led_code, core->config.shadow == (uint16_t)AGV_SHADOW_ON, elapsed_ms)) {
        hal_led_set(ports->hal, core->led.on);
    }
}

/* INT-3: at most 60 writes in any minute: 20 that were not used before, and one each 1.5 s. */
enum { STORE_CREDIT_MS = 1500, STORE_CREDITS_MAX = 20 };

static void earn_store_credits(agv_core_t *core, uint32_t elapsed_ms) {
    const uint32_t time_ms = core->store_credit_ms + ((elapsed_ms < STORE_CREDIT_MS) ? elapsed_ms : STORE_CREDIT_MS);
    if (time_ms < STORE_CREDIT_MS) {
        core->store_credit_ms = (uint16_t)time_ms;
        return;
    }
    core->store_credit_ms = (uint16_t)(time_ms - STORE_CREDIT_MS);
    if (core->store_credits < (uint8_t)STORE_CREDITS_MAX) {
        core->store_credits++;
    }
}

/* INT-3: writing flash may stall the processor: only while no reaction can be due. In SAFE the vehicle may still move. There
 * the wheels alone decide, so that a speed in 363h that hangs does not keep the events in RAM. */
static bool may_store(const agv_core_t *core) {
    return ((core->machine.state == (uint8_t)AGV_STATE_STANDBY) && agv_vehicle_is_at_standstill(&core->timers)) ||
           ((core->machine.state == (uint8_t)AGV_STATE_SAFE) &&
            (agv_vehicle_wheels_stand(&core->timers) || !core->machine.output_closed));
}

/* One event per tick. */
static void store_events(agv_core_t *core, const agv_ports_t *ports) {
    if (!may_store(core) || (core->store_credits == 0u)) {
        return;
    }
    const agv_event_t *const event = agv_recorder_next_to_store(ports->recorder);
    if (event != NULL) {
        core->store_credits--;
        (void)hal_store_append(ports->hal, event, sizeof *event);
        agv_recorder_stored(ports->recorder);
    }
}

static void feed_watchdog(agv_core_t *core, const agv_ports_t *ports) {
    if (core->checked_in == (uint8_t)CHECKED_ALL) {
        core->checked_in = 0u;
        agv_timer_start(&core->timers, AGV_TIMER_WATCHDOG_FED);
        hal_watchdog_feed(ports->hal);
    }
}

void agv_core_tick(agv_core_t *core, const agv_ports_t *ports, bool receive_alive) {
    const uint32_t elapsed_ms = step_time(core);
    core->checked_in |= (uint8_t)(receive_alive ? CHECKED_RECEIVE : 0);
    if (elapsed_ms != 0u) { /* a time stamp far ahead stops the time: then a step supervises nothing */
        core->checked_in |= CHECKED_STEP;
    }
    observe_hardware(core, ports->hal, elapsed_ms);
    const bool recovered = observe_buses(core, ports->hal);
    observe_time(core, elapsed_ms);
    const agv_pass_t pass = agv_core_decide(core, ports, elapsed_ms);
    const agv_tx_orders_t orders = agv_core_orders(core, ports);
    if (recovered && ((pass.actions.what & AGV_ACTION_TRIP) == 0u)) {
        agv_transmitter_burst(&core->transmitter, &orders);
    }
    agv_transmitter_tick(&core->transmitter, &orders);
    core->checked_in |= CHECKED_SEND;
    agv_core_conclude(core, ports, &pass);
    hal_safety_output_set(ports->hal, core->machine.output_closed);
    feed_watchdog(core, ports);
    agv_core_show_led(core, ports, elapsed_ms);
    earn_store_credits(core, elapsed_ms);
    store_events(core, ports);
}

/**
 * @file scenario_testbed.h
 * The simulated bus with everything on it: a supervisor, a vehicle, and what goes wrong, in virtual time.
 *
 * One call of scenario_testbed_tick() is a millisecond: the vehicle sends what is due, the supervisor steps, and the
 * bus runs up to the next millisecond. A received frame is handed to the supervisor when it arrives.
 */
#ifndef HOST_SIM_SCENARIO_TESTBED_H
#define HOST_SIM_SCENARIO_TESTBED_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_sim/sim_bus.h"
#include "hal_sim/sim_hal.h"
#include "hal_sim/sim_store.h"
#include "scenario/scenario.h"
#include "session/session.h"
#include "vehicle/vehicle.h"

/** A frame was on the wire. @param from SCENARIO_FROM_SUPERVISOR or a vehicle_node_t */
typedef void scenario_frame_fn(void *ctx, uint64_t t_us, hal_can_side_t side, int from, const hal_can_frame_t *frame);

/** A frame is handed to the supervisor. */
typedef void scenario_received_fn(void *ctx, uint64_t t_us, hal_can_side_t side, const hal_can_frame_t *frame);

/** Callbacks; each may be NULL. */
typedef struct {
    session_observer_fn *on_event;
    scenario_frame_fn *on_frame;
    void *ctx;
    scenario_received_fn *on_received;
} scenario_watch_t;

#define SCENARIO_WATCHES_MAX 5u

typedef struct scenario_testbed scenario_testbed_t;

/** A node of the vehicle on its bus. */
typedef struct {
    scenario_testbed_t *testbed;
    vehicle_node_t node;
    sim_bus_node_t number;
    bool powered;
} scenario_station_t;

/** A bus, as its listeners see it. */
typedef struct {
    scenario_testbed_t *testbed;
    hal_can_side_t side;
} scenario_side_t;

/** A frame that this bus does not carry, on its way to all nodes of a side. */
typedef struct {
    hal_can_side_t side;
    hal_can_frame_t frame;
} scenario_past_wire_t;

/** A reset button that bounces. */
typedef struct {
    uint16_t after_ms[SCENARIO_BOUNCE_MAX]; /**< time from one change to the next */
    uint8_t count;
    uint8_t next;
    uint64_t due_ms; /**< of the next change */
} scenario_bounce_t;

/** Some 200 KiB: not for the stack. Change it through the functions, look at it by scenario_testbed_view(). */
struct scenario_testbed {
    sim_bus_t buses[HAL_CAN_SIDES];
    sim_bus_t *running[HAL_CAN_SIDES];
    size_t bus_count;
    hal_t hal;
    sim_store_t store;
    session_t session;
    vehicle_t vehicle;
    agv_config_t config;
    agv_ids_t ids; /**< of `config` */
    scenario_station_t stations[VEHICLE_NODES];
    sim_bus_node_t rogues[HAL_CAN_SIDES];
    bool rogue_powered[HAL_CAN_SIDES];
    scenario_side_t sides[HAL_CAN_SIDES];
    scenario_watch_t watches[SCENARIO_WATCHES_MAX];
    size_t watch_count;
    scenario_events_t events;
    uint64_t t_ms;
    uint16_t tick_phase_us;      /**< of scenario_t */
    uint64_t halted_until_ms;    /**< the supervisor hangs, or is without power, until then */
    bool was_halted;             /**< it hung: frames may wait for it */
    bool off;                    /**< it is without power */
    bool stalled[HAL_CAN_SIDES]; /**< frames of the supervisor do not leave */
    scenario_bounce_t bounce;
    uint32_t power_changes;                             /**< of the vehicle, that the buses know of */
    uint32_t lost_frames;                               /**< of the vehicle, that found no room in a mailbox */
    scenario_past_wire_t past_wire[VEHICLE_ROGUES_MAX]; /**< FD frames of this millisecond */
    size_t past_wire_count;
};

/** What checkers and screens may see of a testbed. */
typedef struct {
    uint64_t t_ms;
    uint64_t now_us;          /**< of the vehicle side's bus */
    uint16_t status_frame_id; /**< as configured; 0: none */
    bool output_closed;
    bool is_halted;       /**< the supervisor hangs or is without power: frames may wait for it */
    uint32_t received;    /**< frames handed to it, of both sides */
    uint32_t feeds;       /**< of its watchdog */
    uint32_t bites;       /**< likewise */
    uint32_t lost_frames; /**< of the vehicle, that found no room in a mailbox */
    bool is_off;          /**< the supervisor is without power */
    bool pin_is_down;     /**< its push button */
    vehicle_state_t vehicle;
} scenario_testbed_view_t;

/** A controller of the supervisor. */
typedef struct {
    hal_can_status_t status;
    bool is_stalled; /**< its frames do not leave, or it takes none */
    bool swallows;   /**< its frames are lost, and it reports that they were sent */
} scenario_controller_t;

/** Build a testbed as a scenario begins. @return false: unsupported bit rate */
bool scenario_testbed_init(scenario_testbed_t *testbed, const scenario_t *scenario);

/** Add callbacks; before scenario_testbed_start(). */
void scenario_testbed_watch(scenario_testbed_t *testbed, const scenario_watch_t *watch);

/** Switch the supervisor on, at 0 ms. */
void scenario_testbed_start(scenario_testbed_t *testbed);

/** Do a step at its time, before the tick of that millisecond. */
void scenario_testbed_do(scenario_testbed_t *testbed, const scenario_step_t *step);

/** Do a step at another time: the time of a step has 32 bits, that of a testbed 64. */
void scenario_testbed_act(scenario_testbed_t *testbed, uint64_t t_ms, const scenario_step_t *step);

/**
 * Resume from a copy of another testbed, perhaps of another run of this program: @p testbed was made of the same
 * scenario, has the same watches, and was started.
 * @param saved its pointers are replaced
 */
void scenario_testbed_restore(scenario_testbed_t *testbed, scenario_testbed_t *saved);

/** Look at it. */
void scenario_testbed_view(const scenario_testbed_t *testbed, scenario_testbed_view_t *view);

/** Look at a controller of the supervisor. */
void scenario_testbed_controller(const scenario_testbed_t *testbed, hal_can_side_t side,
                                 scenario_controller_t *controller);

/** Counters of a bus. */
void scenario_testbed_bus_stats(const scenario_testbed_t *testbed, hal_can_side_t side, sim_bus_stats_t *stats);

/** The supervisor's port, for a stub that stands in its place. */
hal_t *scenario_testbed_port(scenario_testbed_t *testbed);

/** What the vehicle does, now. */
void scenario_testbed_vehicle(scenario_testbed_t *testbed, vehicle_view_t *view);

/** The message of an identifier, with the configured ID set; AGV_MSG_NONE: none. */
agv_message_t scenario_testbed_message(const scenario_testbed_t *testbed, uint32_t id);

/** The supervisor's session, to read. */
const session_t *scenario_testbed_session(const scenario_testbed_t *testbed);

/** The events of the supervisor that steps may wait for. */
const scenario_events_t *scenario_testbed_events(const scenario_testbed_t *testbed);

/** A millisecond: @p t_ms is 0 and then one more each time. */
void scenario_testbed_tick(scenario_testbed_t *testbed, uint64_t t_ms);

#endif

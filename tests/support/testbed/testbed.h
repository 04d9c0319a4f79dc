/*
 * One supervisor on the simulated port, with the traffic of a vehicle and the rules that check every call (rules.h). For
 * programs that start from the same state very often: a state is reached once and then copied.
 *
 * There is one global testbed. The first broken rule ends the program.
 */
#ifndef TESTBED_H
#define TESTBED_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/supervisor.h"
#include "hal_sim/sim_hal.h"
#include "hal_sim/sim_store.h"
#include "rules.h"
#include "traffic.h"

enum { TESTBED_STATES = 5, TESTBED_VARIANTS = 7 };

typedef struct {
    agv_supervisor_t supervisor;
    agv_recorder_t recorder;
    struct hal hal;
    sim_store_t store;
    agv_config_t config;
    agv_ports_t ports;
    rules_t rules;
    uint64_t now_ms;    /* time since the start of the testbed; never wraps */
    uint32_t offset_ms; /* the supervisor's clock is now_ms + offset_ms */
    uint64_t ticked_ms; /* time of the last tick */
    uint32_t unsettled; /* ticks until a disturbance of the controller counts as over */
    bool receive_path_dead;
    traffic_message_t traffic[TRAFFIC_MESSAGES]; /* traffic_mode() and others set its values */
} testbed_t;

extern testbed_t testbed;

/*
 * Put the testbed into a state that was just entered and has settled.
 * @param variant of the configuration, below TESTBED_VARIANTS: topology, ID set, choices, and the clock at the start; in
 *                some variants it wraps soon after
 * @param state   0 INIT, 1 STANDBY, 2 ACTIVE, 3 TRIPPED, 4 SAFE
 */
void testbed_load(unsigned variant, unsigned state);

/* Pass any frame to the supervisor, `ahead_ms` later than now. Below 0: now, with an older stamp. */
void testbed_frame(hal_can_side_t side, hal_can_frame_t frame, int32_t ahead_ms);

/* Send the next healthy frame of a message now. */
void testbed_send(unsigned message);

/* One tick after `ms`, without traffic in between. */
void testbed_jump(uint32_t ms);

/* Run steps of a millisecond, each with traffic and a tick. */
void testbed_run(uint32_t ms);

/* Restart the supervisor after a reset with this cause. */
void testbed_restart(hal_reset_cause_t cause);

/* Disturb the controller of a side. */
void testbed_disturb(hal_can_side_t side, unsigned kind, uint8_t amount);

/* Whether the supervisor is latched, also by a corrupted state code; whether the cause of a fault is present. */
bool testbed_is_latched(void);
bool testbed_has(agv_fault_t fault);

/* Called when a rule was broken; NULL: the program ends. */
extern void (*testbed_on_broken)(void);

#endif

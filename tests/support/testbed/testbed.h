/*
 * One supervisor on the simulated port, the traffic of a vehicle around it, and the rules that judge it (rules.h). For
 * programs that start from the same state very often: a state is reached once and then copied.
 *
 * There is one live testbed; it is judged in every call, and the first broken rule ends the program.
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
    uint64_t now_ms;    /* since the testbed began; never wraps */
    uint32_t offset_ms; /* the supervisor's clock reads now_ms + offset_ms */
    uint64_t ticked_ms; /* when the last tick came */
    uint32_t unsettled; /* ticks until what the controller went through counts as over */
    bool receive_path_dead;
    traffic_message_t traffic[TRAFFIC_MESSAGES];
} testbed_t;

extern testbed_t testbed;

/*
 * Put the testbed into a state, as it is just after it was entered and has settled.
 * @param variant of the configuration, below TESTBED_VARIANTS: topologies, identifier sets, choices, and where the clock
 *                stands; in some it wraps soon after
 * @param state   0 INIT, 1 STANDBY, 2 ACTIVE, 3 TRIPPED, 4 SAFE
 */
void testbed_load(unsigned variant, unsigned state);

/* Hand over any frame, `ahead_ms` later than now; less than 0: its stamp is so much older. */
void testbed_frame(hal_can_side_t side, hal_can_frame_t frame, int32_t ahead_ms);

/* The message's own next frame, now. */
void testbed_send(unsigned message);

/* One tick, so much later, without traffic in between. */
void testbed_jump(uint32_t ms);

/* So many steps of a millisecond, with traffic and a tick each. */
void testbed_run(uint32_t ms);

/* Restart the supervisor after a reset with this cause. */
void testbed_restart(hal_reset_cause_t cause);

/* The controller of a side goes through something. */
void testbed_disturb(hal_can_side_t side, unsigned kind, uint8_t amount);

/* Values of the traffic. */
void testbed_mode(uint8_t mode);
void testbed_button(bool down);
void testbed_gear(uint8_t gear);
void testbed_wheels(uint8_t mm_s);
void testbed_heal(void);
void testbed_ai_drives(void);

/* Whether the supervisor is latched, also by a state code that is none of the five; whether a fault's cause is there. */
bool testbed_is_latched(void);
bool testbed_has(agv_fault_t fault);

/* End the program when a rule was broken, or do this instead, once it is set. */
void testbed_judge(void);
extern void (*testbed_on_broken)(void);

#endif

/**
 * @file fixture.h
 * One supervisor on the simulated port without a bus, the healthy traffic of a vehicle around it, and a log of all that
 * it sends. Virtual time: one step is one millisecond.
 *
 * A step (fixture_run): the clock moves on by 1 ms; the messages that are due are handed over with that time stamp, in
 * the order of agv_message_t; the receive path checks in; one tick; the watchdog looks at the clock.
 *
 * Use: fixture_init(), change what the test is about (config, traffic), fixture_start(), run, look.
 * Everything in the struct may be read and changed by a test at any time.
 */
#ifndef FIXTURE_H
#define FIXTURE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/recorder.h"
#include "agv/supervisor.h"
#include "hal_sim/sim_hal.h"
#include "hal_sim/sim_store.h"
#include "oracle.h"
#include "traffic.h"

#define FIXTURE_SENT_MAX 4096u

/** One frame that the supervisor sent. */
typedef struct {
    uint32_t time_ms; /**< clock */
    uint32_t call;    /**< number of the call to the supervisor in which it was sent */
    hal_can_side_t side;
    uint32_t id;
    uint8_t flags;
    uint8_t length;
    uint8_t data[8];
} fixture_sent_t;

struct fixture;

/** Asked for every frame of the traffic: may change it. @return false: it is not handed over. */
typedef bool fixture_edit_fn(struct fixture *f, agv_message_t message, hal_can_frame_t *frame);

/** All of it. */
typedef struct fixture {
    agv_supervisor_t supervisor;
    agv_recorder_t recorder;
    agv_ports_t ports;
    struct hal hal;
    sim_store_t store;
    agv_config_t config;           /**< what fixture_start() hands in */
    hal_reset_cause_t reset_cause; /**< what fixture_start() starts with; power-on */
    bool self_test_passed;         /**< true */
    uint32_t now_ms;               /**< clock; set it before fixture_start() */
    uint32_t elapsed_ms;           /**< steps since fixture_start() */
    bool receive_path_dead;        /**< the receive path does not check in */
    uint32_t call;                 /**< calls to the supervisor so far */
    fixture_edit_fn *edit;         /**< NULL: nothing is edited */
    traffic_message_t traffic[TRAFFIC_MESSAGES];
    const char *what; /**< the case of a table, for messages of failures */
    oracle_t oracle;  /**< judges every frame that leaves (FSM-6): a forbidden one ends the test */
    bool
        other_ids; /**< the id_... of the configuration are what is on the wire; frames are logged and judged as if not */
    bool long_run;         /**< a full log of sent frames begins anew instead of ending the test */
    bool log_status;       /**< the supervisor's status frames (TOP-3) are logged too; else only counted and judged */
    uint32_t status_count; /**< status frames sent since fixture_init() */
    uint32_t sent_count;
    fixture_sent_t sent[FIXTURE_SENT_MAX];
} fixture_t;

/** @name Building @{ */

/**
 * Default configuration, shared bus, power-on, healthy traffic in manual mode. Not started yet. The clock stands at 0, or
 * so many milliseconds before its wrap as in the environment variable AGV_TEST_WRAP_IN_MS.
 */
void fixture_init(fixture_t *f);

/** Start the supervisor at now_ms. Identifiers and sides of the traffic follow config.id_set, other_ids, config.topology. */
void fixture_start(fixture_t *f);

/** Start it once more, on the same port, store, recorder, clock and traffic, after a reset with this cause. */
void fixture_restart(fixture_t *f, hal_reset_cause_t cause);

/** fixture_start(), then run until STANDBY, which has to come within a second. The log of sent frames is emptied. */
void fixture_standby(fixture_t *f);

/** fixture_standby(), then engage: ACTIVE, and the grace of 500 ms is over. The log of sent frames is emptied. */
void fixture_active(fixture_t *f);
/** @} */

/** @name Time @{ */

/** So many steps of 1 ms. */
void fixture_run(fixture_t *f, uint32_t ms);

/** Steps until a frame of this message was just handed over and the tick of that moment is done. */
void fixture_run_past(fixture_t *f, agv_message_t message);

/** Steps until the next step would send a frame of this message. */
void fixture_run_before(fixture_t *f, agv_message_t message);

/** Only a tick, @p ms later: no traffic in between, the receive path checks in. */
void fixture_jump(fixture_t *f, uint32_t ms);

/** Traffic without ticks: the clock moves on, frames are handed over in their time, the supervisor's step does not come. */
void fixture_run_without_ticks(fixture_t *f, uint32_t ms);
/** @} */

/** @name Traffic @{ */

/** The message's own next frame, now instead of in its time: counter and all. */
void fixture_send_now(fixture_t *f, agv_message_t message);

/** Hand over a frame with the message's identifier and side, this payload, and now as its time stamp. */
void fixture_frame(fixture_t *f, agv_message_t message, const uint8_t data[8]);

/** Hand over any frame; its time stamp is filled in. */
void fixture_raw(fixture_t *f, hal_can_side_t side, hal_can_frame_t frame);

/** Mute or unmute all messages of a node: VCU (363h, 0A3h, 050h, 101h), EPS (067h, 167h, 267h), AI (the commands). */
void fixture_mute_vcu(fixture_t *f, bool muted);
void fixture_mute_eps(fixture_t *f, bool muted);
void fixture_mute_ai(fixture_t *f, bool muted);

/** Set the mode bits of 363h byte 7 (MODE_*), or press and release button 1; the rest of the byte stays. */
void fixture_mode(fixture_t *f, uint8_t mode);
void fixture_button(fixture_t *f, bool pressed);

/**
 * Press button 1 now, hold it for so many milliseconds, release it (FSM-3): it is down in 363h from the frame of this
 * moment on, and the frame that many milliseconds later, which is the last thing handed over and is followed by a tick,
 * reports it up. A multiple of 10 ms, as 363h comes. The button was reported up before.
 */
void fixture_press(fixture_t *f, uint32_t held_ms);

/** Set gear status, throttle status, speed of 363h (counts of 1 m/h), raw measured and commanded angle, wheel speeds. */
void fixture_gear(fixture_t *f, uint8_t gear);
void fixture_throttle(fixture_t *f, uint8_t counts);
void fixture_speed(fixture_t *f, uint16_t counts);
void fixture_angle(fixture_t *f, uint16_t raw);
void fixture_command_angle(fixture_t *f, uint16_t raw);
void fixture_wheels(fixture_t *f, int32_t left_mm_s, int32_t right_mm_s);

/** The vehicle moves: both wheels with this speed, and 363h reports it. 0: it stands. */
void fixture_drive(fixture_t *f, int32_t mm_s);

/**
 * The vehicle obeys: autopilot mode off (manual), gear P, throttle 0, it stands. The engagement ends with the third 363h
 * from now on.
 */
void fixture_vehicle_confirms(fixture_t *f);
/** @} */

/** @name Looking. A failed expectation names f->what. @{ */

/** Whether a fault's cause is there now. */
bool fixture_has(const fixture_t *f, agv_fault_t fault);

/** Events of this kind, and with these parameters a and c, that the recorder still has, and the last of them. */
enum { ANY = -1 };
uint32_t fixture_events(const fixture_t *f, agv_event_kind_t kind, int a, int c, agv_event_t *last);

/** How often a fault was raised (or ended) since fixture_start(), of the events that the recorder still has. */
uint32_t fixture_raised(const fixture_t *f, agv_fault_t fault);
uint32_t fixture_ended(const fixture_t *f, agv_fault_t fault);

/** The last event in which this fault was raised. @return false: there is none. */
bool fixture_last_raised(const fixture_t *f, agv_fault_t fault, agv_event_t *event);

/** Empty the log of sent frames. */
void fixture_forget_sent(fixture_t *f);

/** How many frames with this identifier are in the log, and the n-th of them (0 = oldest; it has to be there). */
uint32_t fixture_count_sent(const fixture_t *f, uint32_t id);
const fixture_sent_t *fixture_nth_sent(const fixture_t *f, uint32_t id, uint32_t n);

void expect_state(const fixture_t *f, agv_state_t expected);
void expect_reason(const fixture_t *f, agv_fault_t expected);
void expect_fault(const fixture_t *f, agv_fault_t fault, bool active);
void expect_led(const fixture_t *f, int expected_code);
void expect_output(const fixture_t *f, bool closed);
void expect_silence(const fixture_t *f);
/** @} */

#endif

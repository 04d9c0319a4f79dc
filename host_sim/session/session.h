/**
 * @file session.h
 * A supervisor with flight recorder, port, a time that does not wrap, and observers of its events. Replay, scenarios
 * and nodes on a real bus drive the supervisor through this.
 *
 * The program calls session_init, session_observe as often as it likes, session_start, and then session_frame and
 * session_tick in the order of time.
 */
#ifndef HOST_SIM_SESSION_H
#define HOST_SIM_SESSION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/recorder.h"
#include "agv/supervisor.h"
#include "hal/can.h"
#include "hal/hal.h"

#define SESSION_OBSERVERS_MAX 4u

/** An event of the flight recorder, of a fault that it left out, or a change of the LED code. */
typedef struct {
    uint64_t t_ms;        /**< since the start of the run */
    uint64_t stopped_ms;  /**< when the supervisor had no power any more before it was started last */
    bool is_led;          /**< `led_code` is the news; else `recorded` */
    int8_t led_code;      /**< as agv_supervisor_led_code() */
    bool is_left_out;     /**< of a fault that changes too often: the recorder did not keep it */
    agv_event_t recorded; /**< kind, a, b, c, missing as recorder.h says */
} session_event_t;

/**
 * Called for every event, in order. The recorder keeps at most 4 events of a fault in a second; observers are told of
 * those it left out, too, from the faults of the supervisor.
 */
typedef void session_observer_fn(void *ctx, const session_event_t *event);

/** The faults after the last call. */
typedef struct {
    agv_fault_set_t active;
    agv_fault_set_t trips;              /**< those of `active` that count as trips */
    uint16_t left_out[AGV_FAULT_COUNT]; /**< events of each fault that the recorder left out since the last it kept */
} session_faults_t;

/** Read the members freely; change nothing but through the functions. */
typedef struct {
    _Alignas(16) agv_supervisor_t supervisor; /**< aligned, for the speed of its seal */
    agv_recorder_t recorder;
    agv_ports_t ports;
    uint64_t t_ms;          /**< time of the last call, since the start of the run */
    uint64_t counted_ms;    /**< up to here supervised_ms is counted */
    uint64_t supervised_ms; /**< time outside INIT, with power */
    uint64_t stopped_ms;    /**< when it was stopped last */
    bool runs;              /**< it was started and not stopped */
    agv_counters_t before;  /**< the counters of the supervisor's earlier starts, in sum */
    uint32_t next;          /**< sequence number of the next event to report */
    int8_t led_code;        /**< as last reported */
    session_faults_t faults;
    size_t observer_count;
    struct {
        session_observer_fn *fn;
        void *ctx;
    } observers[SESSION_OBSERVERS_MAX];
} session_t;

/** Make a session: an empty recorder, no observers. @param hal stays the caller's and must outlive the session */
void session_init(session_t *session, hal_t *hal);

/** Add an observer. @return false: there are SESSION_OBSERVERS_MAX already */
bool session_observe(session_t *session, session_observer_fn *fn, void *ctx);

/**
 * Start the supervisor, or start it again after a reset of its processor: the recorder is kept. Observers get the
 * first state first, then (once each) whether the safety output is closed, and the LED code.
 *
 * @param t_ms     time since the start of the run
 * @param clock_ms the supervisor's clock, any value
 */
void session_start(session_t *session, const agv_config_t *config, uint64_t t_ms, uint32_t clock_ms);

/** The processor has no power from now on, until the next session_start. */
void session_stop(session_t *session, uint64_t t_ms);

/** The counters of the whole run: of all starts of the supervisor. */
agv_counters_t session_counters(const session_t *session);

/** Hand over a frame that was received; its time_ms is the supervisor's clock. */
void session_frame(session_t *session, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_ms);

/** A millisecond passed and every frame up to it was handed over. */
void session_tick(session_t *session, uint64_t t_ms, uint32_t clock_ms);

/** A millisecond passed, but frames up to it were not handed over yet: the receive path does not check in (TIM-3). */
void session_tick_behind(session_t *session, uint64_t t_ms, uint32_t clock_ms);

#endif

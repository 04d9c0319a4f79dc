/**
 * @file web_sim.h
 * The simulation for a page: one supervisor, one vehicle and one bus in virtual time, as a WebAssembly module. These are
 * the functions that it exports; there is one run at a time.
 *
 *     web_create(...)              read a scenario, lay settings over it, build everything
 *     web_inject("{at_ms: ...}")   add a step, now or later
 *     web_step(16)                 play 16 ms
 *     web_view(), web_events(), web_bus(), web_frames(), web_expectations()     look at it
 *
 * The same scenario, settings and steps give the same run, bit for bit, however it is cut into calls of web_step().
 *
 * Texts are UTF-8 and end with a zero. The page puts its own into memory of web_alloc(); those that it gets are valid
 * until the next call. What is wrong is printed as one line on standard error (the import fd_write of WASI, descriptor
 * 2), and the function returns 0.
 */
#ifndef WEB_SIM_H
#define WEB_SIM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WEB_EXPORT(name) __attribute__((export_name(#name), visibility("default")))

/** As a number: there is none. */
#define WEB_NONE INT32_MIN

/** Memory for a text; NULL: there is none. web_free() releases it. */
WEB_EXPORT(web_alloc) void *web_alloc(size_t size);
WEB_EXPORT(web_free) void web_free(void *memory);

/** What a page shows without a run, as a JSON object: settings, faults, messages, actions of steps. See web_lists.c. */
WEB_EXPORT(web_lists) const char *web_lists(void);

/**
 * Begin a run. The one before is over.
 * @param name of the scenario, for messages
 * @param scenario text of a scenario file (docs/scenarios.md)
 * @param settings text of a configuration file that is laid over the settings of the scenario; "": nothing. It may
 *                 name topology and id_set, as options of the command line do
 * @param with_report whether web_report() will be called: it costs time
 * @return 0: a text makes no sense; there is no run
 */
WEB_EXPORT(web_create)
int32_t web_create(const char *name, const char *scenario, const char *settings, int32_t with_report);

/**
 * Add a step of a scenario: "{at_ms: 5000, ai: mute, message: gear_command}".
 * @return 0: it makes no sense, its time has passed, or there is no run
 */
WEB_EXPORT(web_inject) int32_t web_inject(const char *step);

/**
 * Play up to @p ms milliseconds. The first millisecond of a run is 0. After the last one, the scenario's duration_ms, the
 * run has ended.
 * @return how many were played
 */
WEB_EXPORT(web_step) uint32_t web_step(uint32_t ms);

/** What one looks at in every picture. All members are 32 bits wide; a switch is 0 or 1. */
typedef struct {
    int32_t t_ms;        /**< the last millisecond that was played; -1: none yet */
    int32_t duration_ms; /**< of the scenario */
    int32_t has_ended;
    int32_t state;     /**< 0 INIT, 1 STANDBY, 2 ACTIVE, 3 TRIPPED, 4 SAFE; WEB_NONE: no state */
    int32_t reason;    /**< rank of the first reason; WEB_NONE: not tripped */
    int32_t is_halted; /**< the supervisor hangs or is without power */
    int32_t output_closed;
    int32_t contact_closed; /**< of the safety output, as it is */
    int32_t stop_open;      /**< the circuit of the emergency stop */
    int32_t led_on;
    int32_t led_code;
    int32_t gear; /**< agv_gear_t: 1 D, 2 R, 4 N, 8 P */
    int32_t autopilot;
    int32_t speed_mm_s;
    int32_t throttle_permille;
    int32_t eps_mode; /**< agv_eps_mode_t */
    int32_t angle_ddeg;
    int32_t alarms;     /**< of the VCU, AGV_VCU_ALARM_* */
    int32_t running[3]; /**< VCU, EPS, AI computer */
    int32_t button_1;
    /** Commands on the wire in the last 300 ms, of the AI computer and of the supervisor; WEB_NONE: none. */
    int32_t command_gear[2];
    int32_t command_throttle_permille[2];
    int32_t command_angle_ddeg[2];
    int32_t event_count;   /**< lines of web_events() since the start of the run */
    int32_t failure_count; /**< of the expectations */
    int32_t bus_permille;  /**< load of the vehicle's bus in the last full second */
} web_view_t;

/** Look at the run; without one, all is 0 but `t_ms`. */
WEB_EXPORT(web_view) const web_view_t *web_view(void);

/** The events since the last call, as host_sim writes them: JSON Lines. After the end, the last line is the summary. */
WEB_EXPORT(web_events) const char *web_events(void);

/** The identifiers on the bus, as a JSON array. See web_bus.c. */
WEB_EXPORT(web_bus) const char *web_bus(void);

/** The last frames, at most @p count, as a JSON array. See web_bus.c. */
WEB_EXPORT(web_frames) const char *web_frames(uint32_t count);

/** The expectations of the scenario and how each of them stands, as a JSON object. See web_expect.c. */
WEB_EXPORT(web_expectations) const char *web_expectations(void);

/** End the run here, and get the report of it: an HTML file. NULL: web_create() was called without it. */
WEB_EXPORT(web_report) const char *web_report(void);

/**
 * Replay a log as `host_sim replay --report` does. The log is read from standard input (the import fd_read of WASI,
 * descriptor 0), not packed.
 * @param name of the log
 * @param settings text of a configuration file; "": the defaults. Its topology does not count
 * @param ai_interface name of the interface of the AI side: a gateway; "": a shared bus
 * @return the report; NULL: the log is none
 */
WEB_EXPORT(web_replay) const char *web_replay(const char *name, const char *settings, const char *ai_interface);

/** The interfaces of the log of the last web_replay(): their names, each with a line end. "": it was none. */
WEB_EXPORT(web_interfaces) const char *web_interfaces(void);

#endif

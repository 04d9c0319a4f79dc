/**
 * @file monitor.h
 * What the monitor knows of a bus: each message with its age, gaps, counter and signals, the alarms, the state of the
 * supervisor, and a log of transitions. It has no terminal and no interface: frames and time come in through the
 * functions, and monitor_page.h lays out what is known.
 *
 * All times are microseconds since the start of the run. Memory is bounded: everything is in arrays of fixed size, but
 * for the supervisor that only listens (monitor_shadow.h), of which there is at most one.
 */
#ifndef HOST_SIM_MONITOR_H
#define HOST_SIM_MONITOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/state.h"
#include "common/message_facts.h"
#include "hal/can.h"
#include "monitor/monitor_log.h"
#include "monitor/monitor_shadow.h"
#include "session/session.h"
#include "traffic/engagement.h"
#include "traffic/signals.h"

/** Rows: all messages on the vehicle side, and in the gateway the commands on the AI side. */
#define MONITOR_ROWS_MAX ((unsigned)AGV_MSG_COUNT + AGV_COMMAND_COUNT)

/** Other identifiers that are listed; more are only counted. */
#define MONITOR_OTHERS_MAX 32u

/** As a gap: there was none yet. */
#define MONITOR_NO_GAP UINT32_MAX

/** One message on one side. */
typedef struct {
    hal_can_side_t side;
    uint32_t message; /**< AGV_MSG_* */
    uint16_t id;
    uint32_t deadline_us;
    uint64_t count; /**< frames; 0: never heard */
    uint64_t last_us;
    uint8_t data[AGV_DLC];
    uint32_t gap_min_us; /**< MONITOR_NO_GAP: none since the start, or since monitor_reset() */
    uint32_t gap_max_us;
    uint32_t worst_us[2]; /**< longest gap that ended in this half second, and in the one before */
    uint64_t counts[2];   /**< `count` at the start of this half second, and of the one before */
    bool is_late;         /**< its age exceeds the deadline, which counts */
    bool is_silent;       /**< its age exceeds the deadline, which does not count: a command while not engaged */
    bool was_late[2];     /**< it was late in this half second, and in the one before */
    bool has_been_late;   /**< since the start, or since monitor_reset() */
    bool has_counter;
    bool is_stuck; /**< frames come, but their alive counter has not counted (SUP-2) for longer than the deadline */
    message_beat_t counter;
    uint64_t counter_us; /**< when it changed last */
    uint64_t listed_us;  /**< start of the second in which changes of its signals are counted */
    uint8_t listed;      /**< changes in it that were listed */
} monitor_row_t;

/** An identifier that is none of the messages. */
typedef struct {
    hal_can_side_t side;
    uint32_t id;
    bool is_extended;
    uint64_t count;
    uint64_t last_us;
    uint64_t counts[2]; /**< as in a row */
} monitor_other_t;

/** From where the state of the supervisor is known. */
typedef enum {
    MONITOR_NO_SOURCE,    /**< not known yet */
    MONITOR_STATUS_FRAME, /**< its status frame */
    MONITOR_SHADOW,       /**< a supervisor in this program, which only listens */
    MONITOR_OWNER         /**< the program whose screen this is */
} monitor_source_t;

/** What is known of the supervisor. */
typedef struct {
    monitor_source_t source;
    agv_state_t state;        /**< 0: unknown */
    agv_fault_t first_reason; /**< AGV_FAULT_NONE: not tripped */
    bool output_closed;
    bool has_led;
    int8_t led_code;        /**< as agv_supervisor_led_code(); a status frame does not carry it */
    agv_fault_set_t faults; /**< active ones; empty when the source is a status frame */
    bool has_checksum;
    uint32_t checksum;    /**< of its configuration */
    uint64_t heard_us;    /**< time of the last status frame */
    uint64_t heard_count; /**< status frames */
} monitor_supervisor_t;

/** How the monitor is made. */
typedef struct {
    const agv_config_t *config;            /**< is copied */
    const char *interfaces[HAL_CAN_SIDES]; /**< names; NULL: no such side, or not known yet */
    bool is_gateway;
    bool shadow;                /**< show the supervisor that only listens, even when a status frame is heard */
    bool owned;                 /**< monitor_event() and monitor_told() say what the supervisor does */
    monitor_entry_fn *on_entry; /**< called for each entry of the log; or NULL */
    void *ctx;
} monitor_config_t;

/** Read the members freely; change them through the functions. Some 300 KiB. */
typedef struct {
    monitor_config_t given;
    agv_config_t config;
    uint32_t checksum;
    uint64_t now_us;
    uint64_t half_us; /**< start of the present half second */
    uint64_t frames;
    uint64_t counts[2]; /**< `frames`, as in a row */
    uint64_t rejected;  /**< frames with the identifier of a message, but of another form */
    uint64_t errors;    /**< error frames */
    uint64_t lost;      /**< frames that this program was too slow for */
    uint64_t lost_us;   /**< when it lost the last ones */
    bool is_down[HAL_CAN_SIDES];
    engagement_t engagement;
    uint64_t engaged_us; /**< when the last engagement began, or was continued */
    size_t row_count;
    monitor_row_t rows[MONITOR_ROWS_MAX];
    uint8_t row_of[HAL_CAN_SIDES][AGV_ID_MAX + 1]; /**< index + 1; 0: none */
    uint8_t watched[AGV_MSG_COUNT][AGV_DLC];       /**< bits whose change is listed */
    size_t other_count;
    monitor_other_t others[MONITOR_OTHERS_MAX];
    uint64_t others_uncounted; /**< frames of identifiers for which there was no room */
    monitor_supervisor_t supervisor;
    monitor_shadow_t *shadow;       /**< NULL: none runs */
    bool shadow_failed;             /**< out of memory */
    bool flickers[AGV_FAULT_COUNT]; /**< it was said that not each change of the fault is listed */
    monitor_log_t log;
} monitor_t;

/** Begin at time 0. @return NULL: out of memory; was reported */
monitor_t *monitor_new(const monitor_config_t *given);

/** Free it; nothing for NULL. */
void monitor_free(monitor_t *monitor);

/** A frame was received. */
void monitor_frame(monitor_t *monitor, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us);

/** Time has passed: what is late by now is found. Also part of monitor_frame(). */
void monitor_time(monitor_t *monitor, uint64_t t_us);

/** The interface of a side went down or came back. */
void monitor_link(monitor_t *monitor, hal_can_side_t side, bool is_down, uint64_t t_us);

/** This program was too slow, and the kernel has lost frames. */
void monitor_lost(monitor_t *monitor, hal_can_side_t side, uint32_t frames, uint64_t t_us);

/** The supervisor of the program whose screen this is: something happened. */
void monitor_event(monitor_t *monitor, const session_event_t *event, uint64_t t_us);

/** The supervisor of the program whose screen this is: its present state. */
void monitor_told(monitor_t *monitor, const monitor_supervisor_t *supervisor);

/** An entry for the log that comes from the program around the monitor. */
void monitor_note(monitor_t *monitor, monitor_level_t level, const char *who, const char *text);

/** Forget the shortest and longest gaps. */
void monitor_reset(monitor_t *monitor);

/** The longest age of a message within the last half to whole second; 0: never heard. */
uint64_t monitor_age_us(const monitor_t *monitor, const monitor_row_t *row);

/** Whether a message is or was late within that time, by a deadline that counted. */
bool monitor_is_late(const monitor_row_t *row);

/** Frames a second, over the last half to whole second. @param counts of a row, or of the monitor */
uint64_t monitor_rate(const monitor_t *monitor, uint64_t count, const uint64_t counts[2]);

/** "ai", "vcu", "eps" or "supervisor": who sends a message on a side. */
const char *monitor_sender(const monitor_t *monitor, const monitor_row_t *row);

/** The last payload of a message on the vehicle side. @return NULL: never heard */
const uint8_t *monitor_payload(const monitor_t *monitor, uint32_t message);

/** An alarm: reported by VCU or EPS, or a fault that the supervisor has found. */
typedef struct {
    agv_fault_t fault;
    uint8_t led_code; /**< 0: it has none */
    bool is_trip;     /**< by the configuration */
    bool is_fresh;    /**< its message is not late */
} monitor_alarm_t;

/** The alarms that are there now, each once, in the order of their rank. @return how many */
size_t monitor_alarms(const monitor_t *monitor, monitor_alarm_t *alarms, size_t room);

#endif

/**
 * @file soak_internal.h
 * What the parts of the soak share. For soak*.c only.
 */
#ifndef HOST_SIM_SOAK_INTERNAL_H
#define HOST_SIM_SOAK_INTERNAL_H

#include "campaign/soak/soak.h"
#include "campaign/soak/soak_rows.h"
#include "io/checkpoint.h"
#include "io/output.h"
#include "scenario/scenario_testbed.h"
#include "text/text.h"
#include "ui/progress.h"

#define SOAK_BROKEN_SIZE 160u
#define SOAK_STATUS_ID 0x7F0u /**< of the supervisor's status frame, every SOAK_STATUS_MS */
#define SOAK_STATUS_MS 100u
#define SOAK_MS_PER_HOUR 3600000u

/** The part of a checkpoint beside the testbed. No pointers. */
typedef struct {
    uint64_t t_ms;
    uint64_t random;
    uint64_t next_ms; /**< of the next disturbance, or of the end of the present one */
    uint32_t row;     /**< the present disturbance; SOAK_ROW_COUNT: none */
    bool ready;       /**< STANDBY was reached: from now on nothing may happen */
    uint64_t ready_ms;
    uint64_t counts[SOAK_ROWS_MAX];
    uint64_t ticks;          /**< that the supervisor was given */
    uint64_t ticks_before;   /**< of those, when it was ready */
    uint32_t feeds_before;   /**< of the watchdog, then */
    uint64_t wire_others;    /**< frames of others, on both sides */
    uint64_t delivered;      /**< past the wire */
    uint64_t wire_own;       /**< frames of the supervisor */
    uint64_t warnings;       /**< that it reported */
    uint64_t status_frames;  /**< of its status frame, after the first */
    uint64_t status_ms;      /**< when the first came */
    uint32_t status_late_ms; /**< the most that one was late */
    uint8_t status_counter;  /**< of the last */
    uint64_t status_last_ms; /**< when it came */
    uint64_t status_again;   /**< that came right after another: what waited was discarded, and perhaps it with it */
    bool status_seen;
    uint64_t real_ms; /**< that it has taken */
    char broken[SOAK_BROKEN_SIZE];
} soak_state_t;

/** The steps of a row. */
typedef struct {
    uint32_t begin;
    uint32_t end;
    uint32_t after; /**< the first step after it */
} soak_steps_t;

/** How it ended: at the end or with a break; by a signal; a checkpoint could not be written, which was reported. */
typedef enum { OVER, INTERRUPTED, UNSAVED } soak_went_t;

/** All of it; some 400 KiB. */
typedef struct {
    const soak_request_t *request;
    soak_state_t state;
    soak_steps_t steps[SOAK_ROWS_MAX];
    uint64_t start_ms;    /**< of this shard, in the time of all */
    uint64_t duration_ms; /**< of this shard */
    bool gateway;
    bool table_ids;
    text_t text;
    scenario_t scenario;
    scenario_testbed_t testbed;
    scenario_testbed_t saved; /**< what a checkpoint is read into */
    checkpoint_t checkpoint;
    output_t file; /**< of the checkpoint */
    soak_went_t went;
    uint64_t began_ms; /**< real time up to which `real_ms` counts */
    progress_t progress;
    output_t results; /**< open from the start on, so that it is known that it can be written */
} soak_t;

/** @name soak_check.c @{ */
scenario_watch_t soak_watch(soak_t *soak);
/** After each millisecond. */
void soak_check_tick(soak_t *soak);
/** Every hour, and at the end: all counters. */
void soak_check_counters(soak_t *soak);
/** @} */

/** @name soak_state.c @{ */
/** Write the checkpoint. @return false: reported */
bool soak_save(soak_t *soak);
/**
 * Open the checkpoint, for checkpoint_close() at the end, and resume from it if something is saved in it.
 * @return false: it cannot be written, is in use, or belongs to another soak or program; reported
 */
bool soak_load(soak_t *soak);
/** @} */

#endif

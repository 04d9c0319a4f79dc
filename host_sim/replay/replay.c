#include "replay/replay.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/analysis.h"
#include "common/interrupt.h"
#include "config/config_text.h"
#include "hal_sim/sim_hal.h"
#include "io/events.h"
#include "io/output.h"
#include "io/store_file.h"
#include "logs/candump_log.h"
#include "logs/error_frame.h"
#include "logs/log_sides.h"
#include "logs/sent_log.h"
#include "replay/replay_heard.h"
#include "replay/replay_text.h"
#include "session/session.h"
#include "text/units.h"
#include "ui/timeline.h"

enum { LOOK_FOR_SIGNALS_EVERY = 65536 };

/** The files that are written. */
enum { OUT, EVENTS, STORE, OUTPUTS };

/** A replay as it runs. Some 2 MiB: on the heap. */
typedef struct {
    const replay_request_t *request;
    uint64_t first_us;     /**< stamp of the first frame */
    uint64_t last_us;      /**< stamp of the last frame, never going backwards */
    uint64_t now_us;       /**< of the frame or tick in hand */
    uint64_t next_tick_us; /**< stamp of the next tick */
    uint64_t next_tick_ms; /**< and its time since the start */
    uint64_t backward_stamps;
    bool ai_was_heard;
    bool unmet; /**< tripped or not supervised at all, and that is a failure */
    analysis_t *analysis;
    timeline_t timeline;
    replay_heard_t heard;
    hal_t hal;
    sim_store_t store;
    session_t session;
    sent_log_t sent;
    output_t outputs[OUTPUTS];
    candump_log_t log;
} replay_t;

static void on_sent(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame) {
    replay_t *replay = ctx;
    sent_log_add(&replay->sent, side, frame, replay->now_us);
    analysis_sent(replay->analysis, side, frame, replay->now_us - replay->first_us);
    if (replay->request->timeline) {
        timeline_sent(&replay->timeline, side, frame, replay->now_us - replay->first_us);
    }
}

static uint32_t clock_at(const replay_t *replay, uint64_t t_ms) {
    return replay->request->start_ms + (uint32_t)t_ms;
}

static bool outputs_work(const replay_t *replay) {
    return (replay->outputs[OUT].error == 0) && (replay->outputs[EVENTS].error == 0) &&
           analysis_works(replay->analysis);
}

/** Run the ticks before @p end_us. @return false: interrupted. */
static bool run_ticks(replay_t *replay, uint64_t end_us) {
    while (replay->next_tick_us < end_us) {
        const uint64_t t_ms = replay->next_tick_ms;
        const uint32_t clock_ms = clock_at(replay, t_ms);
        replay->now_us = replay->next_tick_us;
        sim_hal_set_now_ms(&replay->hal, clock_ms);
        session_tick(&replay->session, t_ms, clock_ms);
        replay->next_tick_us += US_PER_MS;
        replay->next_tick_ms = t_ms + 1;
        if (((t_ms % LOOK_FOR_SIGNALS_EVERY) == 0) && (interrupt_pending() || !outputs_work(replay))) {
            return false;
        }
    }
    return true;
}

/** The side of a frame's interface. The first frame of the vehicle side also gives its name. */
static hal_can_side_t side_of(replay_t *replay, const candump_record_t *record) {
    if (candump_is_from(record, replay->request->ai_interface)) {
        replay->ai_was_heard = true;
        return HAL_CAN_AI;
    }
    if (replay->sent.interfaces[HAL_CAN_VEHICLE][0] == '\0') {
        sent_log_heard(&replay->sent, HAL_CAN_VEHICLE, record->interface, record->interface_length);
        analysis_name_side(replay->analysis, HAL_CAN_VEHICLE, record->interface, record->interface_length);
    }
    return HAL_CAN_VEHICLE;
}

static void pass_on_record(replay_t *replay, candump_record_t *record, uint64_t t_ms) {
    const hal_can_side_t side = side_of(replay, record);
    const uint64_t t_us = record->stamp_us - replay->first_us;
    record->frame.time_ms = clock_at(replay, t_ms);
    record->frame.time_us = (uint16_t)(t_us % US_PER_MS);
    sim_hal_set_now_ms(&replay->hal, record->frame.time_ms);
    replay_heard_add(&replay->heard, record, t_us);
    if (side == HAL_CAN_VEHICLE) {
        replay_heard_recorded(&replay->heard.recorded, &record->frame, t_us);
    }
    analysis_frame(replay->analysis, side, &record->frame, t_us);
    if (replay->request->timeline) {
        timeline_received(&replay->timeline, side, &record->frame, t_us);
    }
    if ((record->frame.flags & HAL_CAN_ERROR) != 0) {
        error_frame_act(&replay->hal, side, &record->frame);
    }
    session_frame(&replay->session, side, &record->frame, t_ms);
}

/** Pass one line of the log. @return false: that was the end, not a good one. */
static bool pass_record(replay_t *replay, candump_record_t *record) {
    if (record->stamp_us < replay->last_us) {
        replay->backward_stamps++;
        replay_heard_back(&replay->heard, replay->last_us - record->stamp_us, replay->log.line,
                          replay->last_us - replay->first_us);
        record->stamp_us = replay->last_us;
    }
    replay->last_us = record->stamp_us;
    if (!run_ticks(replay, record->stamp_us)) {
        return false;
    }
    replay->now_us = record->stamp_us;
    const uint64_t t_ms = replay->next_tick_ms - ((record->stamp_us == replay->next_tick_us) ? 0 : 1);
    pass_on_record(replay, record, t_ms);
    return outputs_work(replay);
}

/** Whether the replay ends before this record. */
static bool is_beyond(const replay_t *replay, const candump_record_t *record) {
    const uint64_t until_us = replay->request->until_ms * US_PER_MS;
    return (until_us > 0) && (record->stamp_us >= replay->first_us + until_us);
}

/** Pass all lines, the first of which was read already, and the tail. @return false: not all of them. */
static bool pass_log(replay_t *replay, candump_record_t *record) {
    candump_result_t result = CANDUMP_RECORD;
    while (result == CANDUMP_RECORD) {
        if (!pass_record(replay, record)) {
            return false;
        }
        result = candump_next(&replay->log, record);
        result = ((result == CANDUMP_RECORD) && is_beyond(replay, record)) ? CANDUMP_END : result;
    }
    return (result == CANDUMP_END) && run_ticks(replay, replay->last_us + (replay->request->tail_ms * US_PER_MS) + 1);
}

static void start(replay_t *replay, uint64_t first_us) {
    const replay_request_t *request = replay->request;
    const bool is_gateway = request->config.topology == AGV_TOPOLOGY_GATEWAY;
    const sim_hal_config_t config = {.clock_start_ms = request->start_ms,
                                     .watchdog_ms = request->config.watchdog_period_ms,
                                     .reset_cause = request->reset_cause,
                                     .store = &replay->store};
    agv_ids_t ids;
    agv_config_ids(&request->config, &ids);
    replay->heard.recorded.lights_id = ids.of[AGV_MSG_TURN_SIGNAL_COMMAND];
    replay->heard.recorded.status_id = request->config.status_frame_id;
    replay->first_us = first_us;
    replay->last_us = first_us;
    replay->now_us = first_us;
    replay->next_tick_us = first_us + US_PER_MS;
    replay->next_tick_ms = 1;
    sim_hal_init_direct(&replay->hal, &config, is_gateway ? 2 : 1, on_sent, replay);
    if (request->ai_interface != NULL) {
        const size_t length = strlen(request->ai_interface);
        sent_log_heard(&replay->sent, HAL_CAN_AI, request->ai_interface, length);
        analysis_name_side(replay->analysis, HAL_CAN_AI, request->ai_interface, length);
    }
    analysis_set_clock(replay->analysis, first_us);
    (void)session_observe(&replay->session, analysis_event, replay->analysis);
    if (request->timeline) {
        timeline_init_run(&replay->timeline, &request->config);
        (void)session_observe(&replay->session, timeline_event, &replay->timeline);
    }
    if (replay->outputs[EVENTS].is_open) {
        (void)session_observe(&replay->session, events_write, &replay->outputs[EVENTS]);
    }
    if (request->listener != NULL) {
        (void)session_observe(&replay->session, request->listener->on_event, request->listener->ctx);
    }
    session_start(&replay->session, &request->config, 0, request->start_ms);
}

/** Whether standard output is free for the text. */
static bool has_text(const replay_request_t *request) {
    return (request->listener == NULL) && !output_is_stdout(request->events) && !output_is_stdout(request->out) &&
           !analysis_paths_use_stdout(&request->analysis);
}

static replay_text_t text_of(const replay_t *replay, const events_summary_t *summary) {
    return (replay_text_t){.name = replay->log.name,
                           .first_us = replay->first_us,
                           .duration_us = replay->now_us - replay->first_us,
                           .config = &replay->request->config,
                           .heard = &replay->heard,
                           .ai_interface = replay->request->ai_interface,
                           .why = analysis_why(replay->analysis),
                           .summary = summary};
}

static void print_text(const replay_t *replay, const replay_text_t *text) {
    if (replay->request->timeline) {
        (void)printf("\n");
    }
    replay_text_print(text);
}

/** Every file or none. @return false: reported */
static bool put_files_in_place(replay_t *replay) {
    return output_flush_all(replay->outputs, OUTPUTS) && analysis_flush(replay->analysis) &&
           analysis_commit(replay->analysis) && output_commit_all(replay->outputs, OUTPUTS);
}

/** The log is over: write what comes last, put every file in its place. @return false: reported. */
static bool conclude(replay_t *replay) {
    const replay_request_t *request = replay->request;
    if (!log_sides_check_heard(request->ai_interface, replay->ai_was_heard, replay->sent.interfaces[HAL_CAN_VEHICLE])) {
        return false;
    }
    events_summary_t summary;
    events_summarise(&replay->session, &summary);
    summary.skipped_lines = replay->log.skipped;
    summary.backward_stamps = replay->backward_stamps;
    sent_log_finish(&replay->sent);
    if (request->events != NULL) {
        events_write_summary(&replay->outputs[EVENTS], &summary);
    }
    if (request->store != NULL) {
        store_file_save(&replay->outputs[STORE], &replay->store, &replay->session.recorder);
    }
    const replay_text_t text = text_of(replay, &summary);
    analysis_end(replay->analysis, text.duration_us);
    replay_text_remarks(&text, replay->analysis);
    analysis_write(replay->analysis);
    const bool good = put_files_in_place(replay);
    if (good && has_text(request)) {
        print_text(replay, &text);
    }
    const why_t *why = analysis_why(replay->analysis);
    if (good && (request->listener != NULL)) {
        request->listener->on_end(request->listener->ctx, why);
    }
    text_t back = {.used = 0};
    const bool is_whole = (why_supervised_us(why) > 0) && !replay_text_goes_back(&back, &replay->heard);
    replay->unmet = request->fail_on_trip && ((why_trip_count(why) > 0) || !is_whole);
    return good;
}

/** Open what is read and what is written, and read the first frame. @return false: reported. */
static bool prepare(replay_t *replay, candump_record_t *first) {
    const replay_request_t *request = replay->request;
    if (!candump_open(&replay->log, request->log, request->skip_bad_lines)) {
        return false;
    }
    const candump_result_t result = candump_next(&replay->log, first);
    if (result != CANDUMP_RECORD) {
        return (result == CANDUMP_END) ? report("%s: contains no frame", replay->log.name) : false;
    }
    if ((request->store != NULL) && !store_file_load(request->store, &replay->store, &replay->session.recorder)) {
        return false;
    }
    const char *const paths[OUTPUTS] = {[OUT] = request->out, [EVENTS] = request->events, [STORE] = request->store};
    for (size_t i = 0; i < OUTPUTS; i++) {
        if ((paths[i] != NULL) && !output_open(&replay->outputs[i], paths[i])) {
            return false;
        }
    }
    if (!analysis_open(replay->analysis)) {
        return false;
    }
    replay->sent.output = (request->out != NULL) ? &replay->outputs[OUT] : NULL;
    config_note_deviations(&request->config);
    return true;
}

static bool run(replay_t *replay) {
    candump_record_t record;
    if (!prepare(replay, &record)) {
        return false;
    }
    start(replay, record.stamp_us);
    if (pass_log(replay, &record)) {
        return conclude(replay);
    }
    (void)(output_flush_all(replay->outputs, OUTPUTS) && analysis_flush(replay->analysis)); /* reports what failed */
    return false;
}

static bool check_request(const replay_request_t *request) {
    const bool is_gateway = request->config.topology == AGV_TOPOLOGY_GATEWAY;
    return log_sides_check(is_gateway, request->ai_interface);
}

static bool make_analysis(replay_t *replay) {
    analysis_request_t request = {
        .config = &replay->request->config, .files = replay->request->analysis, .is_recording = true};
    request.log = report_input_name(replay->request->log);
    replay->analysis = analysis_new(&request);
    return replay->analysis != NULL;
}

status_t replay_run(const replay_request_t *request) {
    if (!check_request(request)) {
        return STATUS_UNUSABLE;
    }
    replay_t *replay = calloc(1, sizeof *replay);
    if (replay == NULL) {
        (void)report("out of memory");
        return STATUS_UNUSABLE;
    }
    replay->request = request;
    replay->log.fd = -1;
    sim_store_init(&replay->store);
    session_init(&replay->session, &replay->hal);
    const bool good = make_analysis(replay) && run(replay);
    const status_t status = replay->unmet ? STATUS_UNMET : STATUS_OK;
    for (size_t i = 0; i < OUTPUTS; i++) {
        output_discard(&replay->outputs[i]);
    }
    analysis_free(replay->analysis);
    candump_close(&replay->log);
    free(replay);
    interrupt_release();
    return good ? status : STATUS_UNUSABLE;
}

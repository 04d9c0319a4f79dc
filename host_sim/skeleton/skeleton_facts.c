#include "skeleton/skeleton_facts.h"

#include <stdlib.h>
#include <string.h>

#include "agv/codec.h"
#include "logs/candump_log.h"
#include "replay/replay.h"
#include "text/units.h"
#include "vehicle/vehicle.h"
#include "why/why_words.h"

/** A silent node is listened for until so long after the trip. */
enum { LISTEN_MS = 500 };

/* --- the first reading: what the supervisor does --- */

static void on_fact_event(void *ctx, const session_event_t *event) {
    skeleton_facts_t *facts = ctx;
    const agv_event_t *recorded = &event->recorded;

    if (event->is_led || facts->has_tripped || (recorded->kind != AGV_EVENT_STATE)) {
        return;
    }
    if (recorded->b == AGV_STATE_ACTIVE) {
        facts->engaged_ms = event->t_ms;
    }
    if (recorded->b == AGV_STATE_TRIPPED) {
        facts->before = (agv_state_t)recorded->a;
        facts->has_tripped = true;
    }
}

static void on_end(void *ctx, const why_t *why) {
    skeleton_facts_t *facts = ctx;

    facts->has_ended = true;
    facts->trips = why_trip_count(why);
    facts->states_us = why_supervised_us(why);
    if (facts->trips > 0) {
        facts->trip = *why_trip(why, 0);
        why_words_cause(&facts->why, why, &facts->trip);
    }
    facts->more = 0;
    for (size_t i = 1; i < facts->trips; i++) {
        facts->more += (why_trip(why, i)->kind == WHY_VEHICLE) ? 0 : 1;
    }
}

/** What counts while the autopilot is engaged only. */
static bool is_by_silent_command(const why_trip_t *trip) {
    return ((trip->kind == WHY_SILENCE) || (trip->kind == WHY_STUCK)) && ((uint32_t)trip->message < AGV_COMMAND_COUNT);
}

bool skeleton_was_heard(const skeleton_facts_t *facts) {
    return facts->trip.last_good_us != WHY_NEVER;
}

uint64_t skeleton_engaged_ms(const skeleton_facts_t *facts) {
    if (facts->trip.from_engagement) {
        return facts->trip.cause_us / US_PER_MS;
    }
    return (facts->before == AGV_STATE_ACTIVE) ? facts->engaged_ms : facts->trip.t_us / US_PER_MS;
}

bool skeleton_is_early(const skeleton_facts_t *facts) {
    return is_by_silent_command(&facts->trip) &&
           (!skeleton_was_heard(facts) || (skeleton_cause_ms(facts) < skeleton_engaged_ms(facts)));
}

uint64_t skeleton_cause_ms(const skeleton_facts_t *facts) {
    const why_trip_t *trip = &facts->trip;
    const bool by_silence = (trip->kind == WHY_SILENCE) || (trip->kind == WHY_STUCK);

    if (by_silence && (trip->last_good_us != WHY_NEVER)) {
        return (trip->last_good_us / US_PER_MS) + 1;
    }
    return ((trip->cause_us != WHY_NEVER) ? trip->cause_us : trip->t_us) / US_PER_MS;
}

/* --- the second one: how the vehicle was driven, and who was silent --- */

/** A reading. */
typedef struct {
    skeleton_facts_t *facts;
    agv_ids_t ids;
    bool heard_gear;
    bool heard_throttle;
    uint64_t silent_from_us;
    uint64_t silent_to_us;
    vehicle_node_t node; /**< that may be silent */
} listening_t;

static void take_command(listening_t *listening, agv_message_t message, const uint8_t data[AGV_DLC]) {
    skeleton_facts_t *facts = listening->facts;
    agv_gear_command_t gear;
    agv_throttle_command_t throttle;
    agv_steering_command_t steering;

    if ((message == AGV_MSG_GEAR_COMMAND) && agv_unpack_gear_command(&gear, data)) {
        facts->gear = gear.gear;
        listening->heard_gear = true;
    } else if ((message == AGV_MSG_THROTTLE_COMMAND) && agv_unpack_throttle_command(&throttle, data)) {
        facts->throttle_permille = throttle.throttle_permille;
        listening->heard_throttle = true;
    } else if ((message == AGV_MSG_STEERING_COMMAND) && agv_unpack_steering_command(&steering, data)) {
        facts->angle_ddeg = steering.angle_ddeg;
    } else {
        return;
    }
}

static void take_status(listening_t *listening, agv_message_t message, const uint8_t data[AGV_DLC]) {
    skeleton_facts_t *facts = listening->facts;
    agv_gear_status_t gear;
    agv_throttle_status_t throttle;

    if ((message == AGV_MSG_GEAR_STATUS) && agv_unpack_gear_status(&gear, data)) {
        facts->gear = gear.gear;
        listening->heard_gear = true;
    } else if ((message == AGV_MSG_THROTTLE_STATUS) && agv_unpack_throttle_status(&throttle, data)) {
        facts->throttle_permille = throttle.throttle_permille;
        listening->heard_throttle = true;
    } else {
        return;
    }
}

static void take_frame(listening_t *listening, const hal_can_frame_t *frame, uint64_t t_us) {
    skeleton_facts_t *facts = listening->facts;
    const agv_message_t message = (agv_message_t)agv_ids_find(&listening->ids, frame->id);

    if ((frame->flags != 0) || (frame->length != AGV_DLC) || (message == AGV_MSG_NONE)) {
        return;
    }
    if ((t_us > listening->silent_from_us) && (t_us < listening->silent_to_us) &&
        (vehicle_sender_of(message) == listening->node)) {
        facts->node_is_silent = false;
    }
    if (t_us / US_PER_MS >= skeleton_cause_ms(facts)) {
        return;
    }
    if (facts->before == AGV_STATE_ACTIVE) {
        take_command(listening, message, frame->data);
    } else {
        take_status(listening, message, frame->data);
    }
}

static bool listen(listening_t *listening, candump_log_t *log) {
    candump_record_t record;
    uint64_t first_us = 0;
    uint64_t last_us = 0;
    bool is_first = true;
    candump_result_t result = candump_next(log, &record);

    for (; result == CANDUMP_RECORD; result = candump_next(log, &record)) {
        first_us = is_first ? record.stamp_us : first_us;
        last_us = (record.stamp_us > last_us) ? record.stamp_us : last_us;
        is_first = false;
        take_frame(listening, &record.frame, last_us - first_us);
    }
    return result == CANDUMP_END;
}

static void prepare(listening_t *listening) {
    skeleton_facts_t *facts = listening->facts;
    const why_trip_t *trip = &facts->trip;

    agv_config_ids(&facts->request->config, &listening->ids);
    facts->node_is_silent = (trip->kind == WHY_SILENCE) && (trip->message != AGV_MSG_NONE);
    if (facts->node_is_silent) {
        listening->node = vehicle_sender_of(trip->message);
        listening->silent_from_us =
            skeleton_was_heard(facts)
                ? trip->last_good_us + ((uint64_t)agv_message_cycle_ms(trip->message) * (uint64_t)US_PER_MS)
                : 0;
        listening->silent_to_us = trip->t_us + ((uint64_t)LISTEN_MS * (uint64_t)US_PER_MS);
    }
}

static bool read_again(skeleton_facts_t *facts) {
    listening_t listening = {.facts = facts};
    candump_log_t *log = calloc(1, sizeof *log);
    if (log == NULL) {
        return report("out of memory");
    }
    prepare(&listening);
    const bool good = candump_open(log, facts->request->log, facts->request->skip_bad_lines) && listen(&listening, log);
    candump_close(log);
    free(log);
    facts->is_driven = listening.heard_gear && listening.heard_throttle &&
                       ((facts->gear == AGV_GEAR_D) || (facts->gear == AGV_GEAR_R));
    return good;
}

bool skeleton_facts_read(skeleton_facts_t *facts, const skeleton_request_t *request) {
    const replay_listener_t listener = {.on_event = on_fact_event, .on_end = on_end, .ctx = facts};
    const replay_request_t replay = {.log = request->log,
                                     .ai_interface = request->ai_interface,
                                     .skip_bad_lines = request->skip_bad_lines,
                                     .reset_cause = HAL_RESET_POWER_ON,
                                     .config = request->config,
                                     .listener = &listener};

    memset(facts, 0, sizeof *facts);
    facts->request = request;
    if ((replay_run(&replay) != STATUS_OK) || !facts->has_ended) {
        return false;
    }
    return (facts->trips == 0) || !facts->has_tripped || read_again(facts);
}

/* The steps that bring the trip of a log about with the simulated vehicle. */
#include <inttypes.h>
#include <string.h>

#include "agv/names.h"
#include "campaign/campaign_rows.h"
#include "scenario/scenario_actions.h"
#include "skeleton/skeleton_plan.h"

enum { EPS_MODE_BYTE = 3, BITS_OF_BYTE = 8, DECIMAL = 10, ENGAGE_EARLIEST_MS = 500, DRIVE_EARLIEST_MS = 1500 };
enum { LONGEST_MS = 60000, SHORT_MS = 10000, DECISION_MAX_MS = 5000, HEARD_MS = 200 };

/** Begin a step of the cause. */
static void begin_step(skeleton_plan_t *plan, uint32_t later_ms) {
    const bool is_first = plan->steps.used == 0;
    if (is_first) {
        text_add(&plan->steps, "  - {name: fault, at_ms: %" PRIu32 ", ", plan->cause_ms);
    } else {
        text_add(&plan->steps, "  - {after: fault, wait: %" PRIu32 "ms, ", later_ms);
    }
}

static const char *node_of(agv_message_t message) {
    return vehicle_node_name(vehicle_sender_of(message));
}

/** A node that is silent, one of its messages, or its counter. */
static void add_silence(skeleton_plan_t *plan) {
    const why_trip_t *trip = &plan->facts->trip;

    begin_step(plan, 0);
    text_add(&plan->steps, "%s: ", node_of(trip->message));
    if (trip->kind == WHY_STUCK) {
        text_add(&plan->steps, "freeze_counter}\n");
    } else if (plan->facts->node_is_silent) {
        text_add(&plan->steps, "stop}\n");
    } else {
        text_add(&plan->steps, "mute, message: %s}\n", agv_message_name(trip->message));
    }
}

/** The field of a message that shows the fault; NULL: none does. */
static const scenario_field_row_t *field_of(const why_trip_t *trip) {
    const why_row_t *why = why_row(trip->reason);
    const scenario_field_row_t *field = scenario_field(0);

    for (size_t i = 1; field != NULL; i++) {
        const uint8_t byte =
            (why->mask != 0) ? why->byte : ((trip->message == AGV_MSG_EPS_STATUS) ? EPS_MODE_BYTE : field->byte);
        if ((field->message == trip->message) && (field->byte == byte) && (strcmp(field->name, "counter") != 0) &&
            (strcmp(field->name, "speed") != 0)) {
            return field;
        }
        field = scenario_field(i);
    }
    return NULL;
}

/** A field with the value that it had in the log. @return false: no frame of it is known */
static bool add_value(skeleton_plan_t *plan) {
    const why_trip_t *trip = &plan->facts->trip;
    const scenario_field_row_t *field = (trip->message != AGV_MSG_NONE) ? field_of(trip) : NULL;
    uint32_t value = 0;

    if ((field == NULL) || (trip->evidence_count == 0)) {
        return false;
    }
    const hal_can_frame_t *frame = &trip->evidence[trip->evidence_count - 1].frame;
    for (unsigned i = 0; i < field->size; i++) {
        value |= (uint32_t)(frame->data[field->byte + i] & field->mask) >> field->shift << (unsigned)(BITS_OF_BYTE * i);
    }
    begin_step(plan, 0);
    if ((trip->kind == WHY_SCORE) && (why_row(trip->reason)->mask != 0)) {
        text_add(&plan->steps, "vcu: set, field: alarms, value: 00h}\n"); /* its own alarm would come first */
        begin_step(plan, 0);
    }
    text_add(&plan->steps, "%s: set, field: %s, value: %02" PRIX32 "h}\n", node_of(trip->message), field->name, value);
    return true;
}

/** The last frame of the evidence as a raw frame, as it was in the log. @return false: there is none */
static bool add_raw_frame(skeleton_plan_t *plan) {
    const why_trip_t *trip = &plan->facts->trip;
    if (trip->evidence_count == 0) {
        return false;
    }
    const why_evidence_t *evidence = &trip->evidence[trip->evidence_count - 1];
    const hal_can_frame_t *frame = &evidence->frame;
    static const struct {
        uint8_t flag;
        const char *kind;
    } kinds[] = {
        {HAL_CAN_EXTENDED, ", kind: extended"}, {HAL_CAN_REMOTE, ", kind: remote"}, {HAL_CAN_FD, ", kind: fd"}};

    begin_step(plan, 0);
    text_add(&plan->steps, "bus: send, id: %03" PRIX32 "h, bytes: \"", frame->id);
    for (uint8_t i = 0; (i < frame->length) && (i < AGV_DLC); i++) {
        text_add(&plan->steps, "%s%02X", (i > 0) ? " " : "", frame->data[i]);
    }
    text_add(&plan->steps, "\"");
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        if ((frame->flags & kinds[i].flag) != 0) {
            text_add(&plan->steps, "%s", kinds[i].kind);
            break;
        }
    }
    text_add(&plan->steps, "%s}\n", (evidence->side == HAL_CAN_AI) ? ", side: ai" : "");
    return true;
}

/** A command whose value is invalid, or one of another length or format. */
static bool add_bad_command(skeleton_plan_t *plan) {
    const why_trip_t *trip = &plan->facts->trip;
    if (trip->evidence_count == 0) {
        return false;
    }
    const hal_can_frame_t *frame = &trip->evidence[trip->evidence_count - 1].frame;
    const bool is_whole = (frame->flags == 0) && (frame->length == AGV_DLC);
    return is_whole ? add_value(plan) : add_raw_frame(plan);
}

bool skeleton_cause_by_evidence(skeleton_plan_t *plan) {
    const why_trip_t *trip = &plan->facts->trip;

    text_clear(&plan->steps);
    switch (trip->kind) {
    case WHY_SILENCE:
    case WHY_STUCK:
        if (trip->message == AGV_MSG_NONE) {
            return false;
        }
        add_silence(plan);
        return true;
    case WHY_BIT:
    case WHY_SCORE:
        return add_value(plan);
    case WHY_VALUE:
        return add_bad_command(plan);
    case WHY_INTRUSION:
        return (trip->reason != AGV_FAULT_COMMAND_TOO_FAST) && add_raw_frame(plan);
    default:
        return false;
    }
}

/** Add a step of a row, with its placeholders filled in. @return what follows it */
static const char *add_words(skeleton_plan_t *plan, const campaign_row_t *row, const char *at) {
    const agv_config_t *config = &plan->facts->request->config;
    const bool is_table = config->id_set == AGV_ID_SET_TABLE;

    for (; (*at != '|') && (*at != '/') && (*at != '\0'); at++) {
        if (*at != '$') {
            text_add(&plan->steps, "%c", *at);
            continue;
        }
        at++;
        if (*at == 'n') {
            text_add(&plan->steps, "%" PRIu32, (row->lowest + row->highest) / 2);
        } else if (*at == 's') {
            text_add(&plan->steps, "%s", (config->topology == AGV_TOPOLOGY_GATEWAY) ? "ai" : "vehicle");
        } else {
            text_add(&plan->steps, "%03Xh",
                     (unsigned)agv_message_id(AGV_MSG_TURN_SIGNAL_COMMAND,
                                              is_table ? AGV_ID_SET_HEADING : AGV_ID_SET_TABLE));
        }
    }
    text_add(&plan->steps, "}\n");
    return (*at == '|') ? at + 1 : NULL;
}

bool skeleton_cause_by_campaign(skeleton_plan_t *plan) {
    const campaign_row_t *row = campaign_row(plan->facts->trip.reason);

    text_clear(&plan->steps);
    if ((row == NULL) || (row->top[0] != '\0') || ((row->flags & CAMPAIGN_START) != 0)) {
        return false;
    }
    for (const char *at = row->steps; at != NULL;) {
        uint32_t later_ms = 0;
        if (*at == '+') {
            for (at++; *at != ' '; at++) {
                later_ms = (later_ms * (uint32_t)DECIMAL) + (uint32_t)(*at - '0');
            }
            at++;
        }
        begin_step(plan, later_ms);
        at = add_words(plan, row, at);
    }
    return true;
}

/** Cut what is longer than people wait for. */
static uint64_t cut(skeleton_plan_t *plan, uint64_t ms, uint32_t shorter_ms) {
    const bool is_longer = ms > LONGEST_MS;
    plan->is_shorter = plan->is_shorter || is_longer;
    return is_longer ? (uint64_t)shorter_ms : ms;
}

/** The AI computer was silent before it was engaged, which counts from the engagement on. */
static void plan_early(skeleton_plan_t *plan, uint32_t ready_ms) {
    const skeleton_facts_t *facts = plan->facts;
    const uint64_t engaged_ms = skeleton_engaged_ms(facts);
    uint64_t engage_ms = cut(plan, engaged_ms, (uint32_t)DRIVE_EARLIEST_MS);

    engage_ms = (engage_ms < ready_ms) ? ready_ms : engage_ms;
    plan->engage_ms = (uint32_t)engage_ms;
    plan->cause_ms = 0;
    if (skeleton_was_heard(facts)) {
        const uint64_t lead_ms = engaged_ms - skeleton_cause_ms(facts);
        plan->cause_ms =
            (uint32_t)((engage_ms > lead_ms + (uint64_t)HEARD_MS) ? engage_ms - lead_ms : (uint64_t)HEARD_MS);
    }
    plan->duration_ms = plan->engage_ms + (uint32_t)DECISION_MAX_MS;
}

void skeleton_plan_times(skeleton_plan_t *plan) {
    const skeleton_facts_t *facts = plan->facts;
    const uint32_t ready_ms = facts->request->config.init_hold_ms + (uint32_t)ENGAGE_EARLIEST_MS;
    const uint64_t cause_ms = skeleton_cause_ms(facts);
    const bool is_engaged = (facts->before == AGV_STATE_ACTIVE) && (cause_ms >= facts->engaged_ms);

    if (skeleton_is_early(facts)) {
        plan_early(plan, ready_ms);
        return;
    }
    uint64_t before_ms = cut(plan, is_engaged ? facts->engaged_ms : cause_ms, (uint32_t)DRIVE_EARLIEST_MS);
    const uint64_t since_ms = cut(plan, is_engaged ? cause_ms - facts->engaged_ms : 0, (uint32_t)SHORT_MS);
    before_ms = (before_ms < ready_ms) ? ready_ms : before_ms;
    plan->engage_ms = is_engaged ? (uint32_t)before_ms : 0;
    plan->cause_ms = (uint32_t)(before_ms + since_ms);
    plan->duration_ms = plan->cause_ms + (uint32_t)DECISION_MAX_MS;
}

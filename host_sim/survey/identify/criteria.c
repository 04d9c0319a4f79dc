#include "survey/identify/criteria.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

#include "agv/codec.h"
#include "common/message_facts.h"
#include "survey/identify/compare.h"
#include "survey/identify/suspect.h"
#include "text/units.h"

enum { MEDIAN = 500, PERCENT = 100, CYCLE_LOWEST_PCT = 80, CYCLE_HIGHEST_PCT = 125 };
enum { FRAMES_MIN = 50, REPEATS_PER_STEP = 2, LEADS_ALONE = 3, TOLERANCE_PARTS = 5 };
enum { THROTTLE_TOLERANCE = 13, ANGLE_TOLERANCE = 50, ANGLE_REST = 50, SPEED_MOVES = 100 };

static const double SAME = 0.9;      /* part of the time in which two values are equal that are the same */
static const double FOLLOWS = 0.8;   /* of one that follows with a delay; also of what goes together */
static const double DIFFERENT = 0.5; /* of two that are not the same */
static const double UNRELATED = 0.2; /* of what does not go together */

verdict_t say(criterion_t *criterion, verdict_t verdict, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(criterion->text, sizeof criterion->text, format, arguments);
    va_end(arguments);
    return verdict;
}

const evidence_id_t *criteria_evidence(const inquiry_t *inquiry, const traffic_id_t *entry) {
    return entry->is_extended ? NULL : evidence_of(inquiry->evidence, entry->side, entry->id);
}

/** Whether the byte at which a message has its alive counter counts. */
static bool has_counter(const evidence_id_t *heard, uint32_t message) {
    const uint8_t at = message_counter_at(message);
    const counter_use_t *use = &heard->counters[(at == 0) ? 0 : 1];
    return (at == MESSAGE_NO_COUNTER) || ((use->steps + use->other_steps) * REPEATS_PER_STEP >= use->frames);
}

/** Whether a message may come from a side: in a gateway, commands come from the AI side alone. */
static bool has_side(const inquiry_t *inquiry, hal_can_side_t side, uint32_t message) {
    const bool is_command = message < AGV_COMMAND_COUNT;
    const bool is_gateway = inquiry->config->topology == AGV_TOPOLOGY_GATEWAY;
    return side == ((is_gateway && is_command) ? HAL_CAN_AI : HAL_CAN_VEHICLE);
}

static bool is_taken(const inquiry_t *inquiry, const evidence_id_t *heard) {
    for (size_t i = 0; i < AGV_MSG_COUNT; i++) {
        if (inquiry->of[i] == heard) {
            return true;
        }
    }
    return false;
}

bool criteria_allow(const inquiry_t *inquiry, const traffic_id_t *entry, uint32_t message) {
    const evidence_id_t *heard = criteria_evidence(inquiry, entry);
    return (heard != NULL) && (entry->message != SIGNALS_STATUS_FRAME) && (heard->frames >= FRAMES_MIN) &&
           (((heard->fits >> message) & 1) != 0) && has_side(inquiry, entry->side, message) &&
           has_counter(heard, message) && !is_taken(inquiry, heard);
}

/* -- criteria of one identifier -- */

static verdict_t judge_cycle(const suspect_t *suspect, criterion_t *criterion) {
    const uint32_t cycle_ms = agv_message_cycle_ms(suspect->message);
    const uint64_t median_us = gaps_quantile_us(&suspect->entry->gaps, MEDIAN);
    const uint64_t percent = (median_us * PERCENT) / ((uint64_t)cycle_ms * US_PER_MS);
    const double ms = ms_of_us(median_us);
    if ((percent >= CYCLE_LOWEST_PCT) && (percent <= CYCLE_HIGHEST_PCT)) {
        return say(criterion, VERDICT_FOR, "comes every %.1f ms, as in the protocol", ms);
    }
    return say(criterion, VERDICT_AGAINST, "comes every %.1f ms, not every %" PRIu32 " ms", ms, cycle_ms);
}

/** Whether a bit beside the alive counter was ever set: a payload of zeros says nothing. */
static verdict_t judge_content(const suspect_t *suspect, criterion_t *criterion) {
    const uint8_t counter_at = message_counter_at(suspect->message);
    uint32_t bits = 0;
    for (uint32_t i = 0; i < AGV_DLC; i++) {
        bits |= (i == counter_at) ? 0 : suspect->entry->bits_ever[i];
    }
    if (bits != 0) {
        return VERDICT_NONE;
    }
    return say(criterion, VERDICT_REFUSES,
               (counter_at == MESSAGE_NO_COUNTER) ? "all its bytes are 0" : "carries a counter and nothing else");
}

static verdict_t judge_other_set(const suspect_t *suspect, criterion_t *criterion) {
    const uint32_t other =
        (suspect->inquiry->config->id_set == AGV_ID_SET_HEADING) ? AGV_ID_SET_TABLE : AGV_ID_SET_HEADING;
    const uint16_t id = agv_message_id(suspect->message, other);
    if ((id == agv_message_id(suspect->message, suspect->inquiry->config->id_set)) || (suspect->entry->id != id)) {
        return VERDICT_NONE;
    }
    return say(criterion, VERDICT_DECIDES, "is its identifier in the ID set %s",
               (other == AGV_ID_SET_TABLE) ? "table" : "heading");
}

/* -- criteria of two identifiers -- */

static const track_t *track_of(const evidence_id_t *heard, field_t field) {
    return (heard != NULL) ? heard->tracks[field] : NULL;
}

static const track_t *mode_of(const inquiry_t *inquiry) {
    return track_of(inquiry->of[AGV_MSG_VEHICLE_STATUS], FIELD_MODE);
}

/** A message and the one with which its values go together. */
typedef struct {
    uint32_t command;
    uint32_t status;
    field_t fields[2];
    const char *what;
} pair_t;

static const pair_t pairs[] = {
    {AGV_MSG_GEAR_COMMAND, AGV_MSG_GEAR_STATUS, {FIELD_BYTE_0, FIELD_BYTE_0}, "gear"},
    {AGV_MSG_THROTTLE_COMMAND, AGV_MSG_THROTTLE_STATUS, {FIELD_BYTE_0, FIELD_BYTE_0}, "throttle"},
    {AGV_MSG_STEERING_COMMAND, AGV_MSG_STEERING_STATUS, {FIELD_WORD_0, FIELD_WORD_2}, "angle"},
};

static const pair_t *pair_of(uint32_t message) {
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        if ((pairs[i].command == message) || (pairs[i].status == message)) {
            return &pairs[i];
        }
    }
    return NULL;
}

/** Set up the comparison of a command with a status. @return false: there is nothing to compare */
static bool compare_begin(const inquiry_t *inquiry, const pair_t *pair, const evidence_id_t *command,
                          const evidence_id_t *status, compare_t *compare) {
    *compare = (compare_t){.first = track_of(command, pair->fields[0]),
                           .second = track_of(status, pair->fields[1]),
                           .mode = mode_of(inquiry)};
    if ((compare->first == NULL) || (compare->second == NULL)) {
        return false;
    }
    const int32_t ranges[2] = {compare->first->highest - compare->first->lowest,
                               compare->second->highest - compare->second->lowest};
    const int32_t range = (ranges[0] < ranges[1]) ? ranges[0] : ranges[1];
    if (pair->command == AGV_MSG_THROTTLE_COMMAND) {
        compare->tolerance =
            (range / TOLERANCE_PARTS < THROTTLE_TOLERANCE) ? range / TOLERANCE_PARTS : THROTTLE_TOLERANCE;
    } else if (pair->command == AGV_MSG_STEERING_COMMAND) {
        compare->tolerance = (range / TOLERANCE_PARTS > ANGLE_TOLERANCE) ? range / TOLERANCE_PARTS : ANGLE_TOLERANCE;
    } else {
        compare->tolerance = 0;
    }
    return true;
}

/** Both angles are at the centre all the time. */
static bool are_at_rest(const compare_t *compare) {
    const track_t *const tracks[2] = {compare->first, compare->second};
    for (size_t i = 0; i < 2; i++) {
        if ((tracks[i]->lowest < AGV_ANGLE_RAW_CENTRE - ANGLE_REST) ||
            (tracks[i]->highest > AGV_ANGLE_RAW_CENTRE + ANGLE_REST)) {
            return false;
        }
    }
    return true;
}

static bool varies(const track_t *track) {
    return track->lowest != track->highest;
}

/** Whether two identifiers show the same gear or throttle, and took it together. */
static bool are_in_step(const compare_t *compare, const agreement_t *found) {
    return varies(compare->first) && varies(compare->second) && (found->equal >= SAME) &&
           (compare_order(compare).together > 0);
}

/** Whether two numbers move together, and are about the same. */
static bool follow(const compare_t *compare, const agreement_t *found) {
    return (found->ranges[0] > compare->tolerance) && (found->ranges[1] > compare->tolerance) &&
           (found->equal >= FOLLOWS) && (found->together >= FOLLOWS);
}

/** Whether a status shows what a command says. */
static verdict_t agreement(const inquiry_t *inquiry, const pair_t *pair, const evidence_id_t *command,
                           const evidence_id_t *status) {
    compare_t compare;
    if (!compare_begin(inquiry, pair, command, status, &compare)) {
        return VERDICT_NONE;
    }
    const agreement_t found = compare_values(&compare);
    const bool is_gear = pair->command == AGV_MSG_GEAR_COMMAND;
    const bool is_angle = pair->command == AGV_MSG_STEERING_COMMAND;
    if ((!is_gear && follow(&compare, &found)) || (!is_angle && are_in_step(&compare, &found)) ||
        (is_angle && (found.samples > 0) && are_at_rest(&compare))) {
        return VERDICT_DECIDES;
    }
    const bool differ = (compare.mode != NULL) && (found.samples > 0) && (found.equal < DIFFERENT);
    return differ ? VERDICT_REFUSES : VERDICT_NONE;
}

static verdict_t agreement_with(const suspect_t *suspect, const pair_t *pair, const evidence_id_t *other) {
    return (pair->command == suspect->message) ? agreement(suspect->inquiry, pair, suspect->heard, other)
                                               : agreement(suspect->inquiry, pair, other, suspect->heard);
}

/** The one identifier that goes together with a suspect as its counterpart. @return NULL: none, or several */
static const evidence_id_t *find_partner(const suspect_t *suspect, const pair_t *pair) {
    const uint32_t counterpart = (pair->command == suspect->message) ? pair->status : pair->command;
    if (suspect->inquiry->of[counterpart] != NULL) {
        return suspect->inquiry->of[counterpart];
    }
    const evidence_id_t *partner = NULL;
    for (size_t i = 0; traffic_at(suspect->inquiry->traffic, i) != NULL; i++) {
        const traffic_id_t *entry = traffic_at(suspect->inquiry->traffic, i);
        const evidence_id_t *other = criteria_evidence(suspect->inquiry, entry);
        if ((other == suspect->heard) || !criteria_allow(suspect->inquiry, entry, counterpart) ||
            (agreement_with(suspect, pair, other) != VERDICT_DECIDES)) {
            continue;
        }
        if (partner != NULL) {
            return NULL;
        }
        partner = other;
    }
    return partner;
}

/** Whether a command is slower than its status in the protocol, and so are these. */
static bool are_cycles_in_order(const suspect_t *suspect, const evidence_id_t *partner) {
    const uint64_t own_us = (suspect->heard->last_us - suspect->heard->first_us) / suspect->heard->frames;
    const uint64_t other_us = (partner->last_us - partner->first_us) / partner->frames;
    return (suspect->message < AGV_COMMAND_COUNT) ? (own_us > other_us) : (own_us < other_us);
}

/** A command changes before its status does. It takes several changes, or one and the order of the cycles. */
static verdict_t judge_order(const suspect_t *suspect, criterion_t *criterion) {
    const bool is_command = suspect->message < AGV_COMMAND_COUNT;
    const pair_t *pair = pair_of(suspect->message);
    const evidence_id_t *partner = suspect->partner;
    compare_t compare;
    if ((pair == NULL) || (partner == NULL) || (pair->fields[0] != pair->fields[1]) ||
        !compare_begin(suspect->inquiry, pair, suspect->heard, partner, &compare)) {
        return VERDICT_NONE;
    }
    const order_t order = compare_order(&compare);
    const uint32_t right = is_command ? order.first_leads : order.second_leads;
    const uint32_t wrong = is_command ? order.second_leads : order.first_leads;
    const bool is_clear = (right == 0) || (wrong == 0);
    const uint32_t needed = are_cycles_in_order(suspect, partner) == (right > 0) ? 1 : (uint32_t)LEADS_ALONE;
    if (!is_clear || (right + wrong < needed)) {
        return VERDICT_NONE;
    }
    return say(criterion, (right > 0) ? VERDICT_FOR : VERDICT_REFUSES, "changes %s %03Xh does",
               ((right > 0) == is_command) ? "before" : "after", partner->id);
}

/** The message that says whether the AI computer is silent. */
static const evidence_id_t *ai_of(const inquiry_t *inquiry, uint32_t *message) {
    for (*message = 0; *message < AGV_COMMAND_COUNT; (*message)++) {
        if (inquiry->of[*message] != NULL) {
            return inquiry->of[*message];
        }
    }
    return NULL;
}

/** All commands are silent together, and nothing else is. */
static verdict_t judge_sender(const suspect_t *suspect, criterion_t *criterion) {
    const bool is_command = suspect->message < AGV_COMMAND_COUNT;
    uint32_t message = 0;
    const evidence_id_t *ai = ai_of(suspect->inquiry, &message);
    const evidence_id_t *vcu = suspect->inquiry->of[AGV_MSG_VEHICLE_STATUS];
    if ((ai == NULL) || (vcu == NULL)) {
        return VERDICT_NONE;
    }
    const silences_t silences = compare_silences(suspect->heard, ai, vcu);
    if ((silences.shared > 0) && (silences.opposed == 0)) {
        return say(criterion, is_command ? VERDICT_FOR : VERDICT_REFUSES, "is silent when %03Xh %s is", ai->id,
                   signals_message_name(message));
    }
    if ((silences.opposed > 0) && (silences.shared == 0)) {
        return say(criterion, is_command ? VERDICT_REFUSES : VERDICT_FOR, "comes while %03Xh %s is silent", ai->id,
                   signals_message_name(message));
    }
    return VERDICT_NONE;
}

/**
 * Whether a counterpart may be the command where it is taken for the status, or the other way round: the two have the same
 * layout, and nothing but its identifier says which it is, on a vehicle that has other identifiers.
 */
static bool may_be_swapped(const suspect_t *suspect, const pair_t *pair) {
    const uint32_t counterpart = (pair->command == suspect->message) ? pair->status : pair->command;
    criterion_t unused;
    return (pair->fields[0] == pair->fields[1]) && suspect->inquiry->is_foreign &&
           (((suspect->inquiry->heard >> counterpart) & 1) != 0) && (judge_order(suspect, &unused) != VERDICT_FOR) &&
           (judge_sender(suspect, &unused) != VERDICT_FOR);
}

static verdict_t judge_counterpart(const suspect_t *suspect, criterion_t *criterion) {
    const pair_t *pair = pair_of(suspect->message);
    const evidence_id_t *partner = suspect->partner;
    if ((pair == NULL) || (partner == NULL)) {
        return VERDICT_NONE;
    }
    verdict_t verdict = agreement_with(suspect, pair, partner);
    if (verdict == VERDICT_NONE) {
        return VERDICT_NONE;
    }
    if ((verdict == VERDICT_DECIDES) && may_be_swapped(suspect, pair)) {
        verdict = VERDICT_FOR;
    }
    return say(criterion, verdict,
               (verdict == VERDICT_REFUSES) ? "does not have the %s of %03Xh" : "has the %s of %03Xh", pair->what,
               partner->id);
}

/** Turn signals are commanded and then on. */
static verdict_t judge_lights(const suspect_t *suspect, criterion_t *criterion) {
    const bool is_command = suspect->message == AGV_MSG_TURN_SIGNAL_COMMAND;
    const evidence_id_t *vcu = suspect->inquiry->of[AGV_MSG_VEHICLE_STATUS];
    const compare_t compare = {.first = track_of(suspect->heard, FIELD_LIGHTS),
                               .second = track_of(vcu, FIELD_SIGNALS),
                               .mode = mode_of(suspect->inquiry)};
    if (!is_command || (compare.first == NULL) || (compare.second == NULL)) {
        return VERDICT_NONE;
    }
    const agreement_t found = compare_values(&compare);
    const bool vary = (found.ranges[0] > 0) && (found.ranges[1] > 0);
    return (vary && (found.equal >= FOLLOWS) && (found.together >= DIFFERENT))
               ? say(criterion, VERDICT_DECIDES, "has the turn signals of %03Xh", vcu->id)
               : VERDICT_NONE;
}

/** The wheels turn as fast as the vehicle moves, in whatever unit. */
static verdict_t judge_speed(const suspect_t *suspect, criterion_t *criterion) {
    const evidence_id_t *vcu = suspect->inquiry->of[AGV_MSG_VEHICLE_STATUS];
    const compare_t compare = {
        .first = track_of(suspect->heard, FIELD_LONG_0), .second = track_of(vcu, FIELD_WORD_0), .is_unsigned = true};
    if ((suspect->message != AGV_MSG_WHEEL_SPEED) || (compare.first == NULL) || (compare.second == NULL)) {
        return VERDICT_NONE;
    }
    const agreement_t found = compare_values(&compare);
    if ((found.ranges[0] < SPEED_MOVES) || (found.ranges[1] < SPEED_MOVES)) {
        return VERDICT_NONE;
    }
    if (found.together >= FOLLOWS) {
        return say(criterion, VERDICT_FOR, "changes with the speed of %03Xh", vcu->id);
    }
    return (found.together < UNRELATED)
               ? say(criterion, VERDICT_REFUSES, "does not change with the speed of %03Xh", vcu->id)
               : VERDICT_NONE;
}

/** Angle control while engaged, and something else in manual mode. */
static verdict_t judge_eps_mode(const suspect_t *suspect, criterion_t *criterion) {
    if ((suspect->message != AGV_MSG_EPS_STATUS) || (suspect->heard->tracks[FIELD_EPS_MODE] == NULL)) {
        return VERDICT_NONE;
    }
    return criteria_eps_mode(suspect, mode_of(suspect->inquiry), criterion);
}

size_t criteria_judge(const inquiry_t *inquiry, const traffic_id_t *entry, uint32_t message,
                      criterion_t criteria[CRITERIA_MAX]) {
    static verdict_t (*const judges[])(const suspect_t *, criterion_t *) = {
        judge_counterpart, judge_lights, judge_eps_mode,  judge_other_set, judge_order,
        judge_sender,      judge_speed,  criteria_values, judge_content,   judge_cycle,
    };
    const pair_t *pair = pair_of(message);
    suspect_t suspect = {
        .inquiry = inquiry, .entry = entry, .heard = criteria_evidence(inquiry, entry), .message = message};
    suspect.partner = (pair != NULL) ? find_partner(&suspect, pair) : NULL;
    size_t count = 0;
    for (size_t i = 0; (i < sizeof judges / sizeof judges[0]) && (count < CRITERIA_MAX); i++) {
        criteria[count].verdict = judges[i](&suspect, &criteria[count]);
        count += (criteria[count].verdict != VERDICT_NONE) ? 1 : 0;
    }
    return count;
}

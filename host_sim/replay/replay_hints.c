#include "replay/replay_hints.h"

#include <inttypes.h>
#include <string.h>

#include "agv/names.h"
#include "agv/recorder.h"
#include "common/message_facts.h"
#include "text/units.h"
#include "why/why_table.h"
#include "why/why_words.h"

/* BURST_US: the other safe commands of a trip come before its first 43Fh, by this time at most. */
enum { SHOWN_IDS = 6, PAUSE_US = US_PER_S, BURST_US = 5 * US_PER_MS };

static bool is_heard(const replay_heard_t *heard, uint32_t id) {
    return (id <= AGV_ID_MAX) && (heard->ids[id] != 0);
}

/** Add identifiers as a list: "201h and 203h". */
static void add_ids(text_t *text, const uint16_t ids[], size_t count) {
    for (size_t i = 0; i < count; i++) {
        const char *between = (i == 0) ? "" : ((i + 1 == count) ? " and " : ", ");
        text_add(text, "%s%03Xh", between, (unsigned)ids[i]);
    }
}

/** The identifiers of the other set are there, those of the configured one are not. */
static bool hint_id_set(text_t *text, const replay_clues_t *clues) {
    const agv_config_t *config = clues->config;
    const replay_heard_t *heard = clues->heard;
    const uint32_t other_set = (uint32_t)AGV_ID_SET_TABLE - config->id_set;
    agv_ids_t ids;
    uint16_t found[AGV_MSG_COUNT];
    uint16_t lacking[AGV_MSG_COUNT];
    size_t count = 0;
    agv_config_ids(config, &ids);
    for (uint32_t m = 0; m < AGV_MSG_COUNT; m++) {
        const uint16_t other = agv_message_id(m, other_set);
        if ((other != ids.of[m]) && is_heard(heard, other) && !is_heard(heard, ids.of[m]) &&
            (agv_message_id(m, config->id_set) == ids.of[m])) {
            found[count] = other;
            lacking[count] = ids.of[m];
            count++;
        }
    }
    if (count == 0) {
        return false;
    }
    add_ids(text, found, count);
    text_add(text, " heard, ");
    add_ids(text, lacking, count);
    text_add(text, " not: --id-set %s", (other_set == AGV_ID_SET_TABLE) ? "table" : "heading");
    return true;
}

static size_t known_heard(const replay_clues_t *clues) {
    agv_ids_t ids;
    size_t count = 0;
    agv_config_ids(clues->config, &ids);
    for (size_t m = 0; m < AGV_MSG_COUNT; m++) {
        count += is_heard(clues->heard, ids.of[m]) ? 1 : 0;
    }
    return count;
}

/** Whether the log is of this vehicle: half of its messages were heard. */
static bool is_this_vehicle(const replay_clues_t *clues) {
    return 2 * known_heard(clues) >= AGV_MSG_COUNT;
}

/** What was heard where no data frame of the right kind was. */
static const char *other_frames(const replay_heard_t *heard) {
    if (heard->fd) {
        return "only CAN FD frames received: the protocol has classic CAN frames";
    }
    return heard->extended ? "only 29-bit identifiers received: the protocol has 11-bit ones"
                           : "no data frame received";
}

/** Add a list of identifiers; of many the first ones. */
static void add_some(text_t *text, const uint16_t ids[], size_t count, bool more) {
    if (!more) {
        add_ids(text, ids, count);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        text_add(text, "%03Xh, ", (unsigned)ids[i]);
    }
    text_add(text, "and others");
}

/** The identifiers that were heard. @param of_protocol also those of the protocol @param more there are more than shown */
static size_t heard_ids(const replay_clues_t *clues, bool of_protocol, uint16_t shown[SHOWN_IDS], bool *more) {
    agv_ids_t ids;
    size_t count = 0;
    agv_config_ids(clues->config, &ids);
    *more = false;
    for (uint32_t id = 0; (id <= AGV_ID_MAX) && !*more; id++) {
        const bool is_known = (agv_ids_find(&ids, id) != AGV_MSG_NONE) || (id == clues->config->status_frame_id);
        if (!is_heard(clues->heard, id) || (is_known && !of_protocol)) {
            continue;
        }
        *more = count == SHOWN_IDS;
        if (!*more) {
            shown[count] = (uint16_t)id;
            count++;
        }
    }
    return count;
}

static bool hint_other_vehicle(text_t *text, const replay_clues_t *clues) {
    uint16_t shown[SHOWN_IDS];
    bool more = false;
    if (is_this_vehicle(clues)) {
        return false;
    }
    const size_t count = heard_ids(clues, true, shown, &more);
    if (count == 0) {
        text_add(text, "%s", other_frames(clues->heard));
        return true;
    }
    add_some(text, shown, count, more);
    text_add(
        text,
        " received, %zu of the %u messages of the protocol: another vehicle? Each identifier is a setting (id_...); "
        "host_sim survey proposes identifiers",
        known_heard(clues), (unsigned)AGV_MSG_COUNT);
    return true;
}

/** The identifiers of a node of which nothing was heard. @return how many; 0: something was */
static size_t ids_of_silent(const replay_clues_t *clues, message_sender_t sender, uint16_t lacking[AGV_MSG_COUNT]) {
    agv_ids_t ids;
    size_t count = 0;
    agv_config_ids(clues->config, &ids);
    for (uint32_t m = 0; m < AGV_MSG_COUNT; m++) {
        if ((message_sender(m) == sender) && is_heard(clues->heard, ids.of[m])) {
            return 0;
        }
        if (message_sender(m) == sender) {
            lacking[count] = ids.of[m];
            count++;
        }
    }
    return count;
}

/** All messages of a node are missing: VCU, EPS, AI computer. */
static bool hint_node(text_t *text, const replay_clues_t *clues) {
    static const struct {
        message_sender_t sender;
        const char *name;
    } nodes[] = {{MESSAGE_FROM_EPS, "EPS"}, {MESSAGE_FROM_VCU, "VCU"}, {MESSAGE_FROM_AI, "AI computer"}};
    for (size_t n = 0; is_this_vehicle(clues) && (n < sizeof nodes / sizeof nodes[0]); n++) {
        uint16_t lacking[AGV_MSG_COUNT];
        const size_t count = ids_of_silent(clues, nodes[n].sender, lacking);
        if (count > 0) {
            add_ids(text, lacking, count);
            text_add(text, " never received: is the %s on this bus?", nodes[n].name);
            return true;
        }
    }
    return false;
}

/** Some messages are missing, and there are identifiers that the protocol does not know. */
static bool hint_ids(text_t *text, const replay_clues_t *clues) {
    uint16_t unknown[SHOWN_IDS];
    uint16_t lacking[AGV_MSG_COUNT];
    size_t count = 0;
    bool more = false;
    text_t other = {.used = 0};
    agv_ids_t ids;
    agv_config_ids(clues->config, &ids);
    for (size_t m = 0; m < AGV_MSG_COUNT; m++) {
        if (!is_heard(clues->heard, ids.of[m])) {
            lacking[count] = ids.of[m];
            count++;
        }
    }
    const size_t unknown_count = heard_ids(clues, false, unknown, &more);
    if ((count == 0) || (unknown_count == 0) || !is_this_vehicle(clues) || hint_id_set(&other, clues) ||
        hint_node(&other, clues)) {
        return false;
    }
    add_ids(text, lacking, count);
    text_add(text, " never received, but ");
    add_some(text, unknown, unknown_count, more);
    text_add(text, ", which the protocol does not know: other identifiers? host_sim survey proposes them");
    return true;
}

/** The vehicle drives by itself from the first frame on. */
static bool hint_begin(text_t *text, const replay_clues_t *clues) {
    if ((why_supervised_us(clues->why) > 0) || ((why_missing(clues->why) & AGV_MISSING_MANUAL) == 0) ||
        !why_began_in_autopilot(clues->why)) {
        return false;
    }
    text_add(text, "supervision begins in manual, at standstill: start the recording before the autopilot is engaged");
    return true;
}

/** The interfaces on which commands or status messages were heard, as bits. */
static uint32_t interfaces_of(const replay_clues_t *clues, bool commands) {
    uint32_t interfaces = 0;
    agv_ids_t ids;
    agv_config_ids(clues->config, &ids);
    for (size_t m = 0; m < AGV_MSG_COUNT; m++) {
        interfaces |= ((m < AGV_COMMAND_COUNT) == commands) ? clues->heard->ids[ids.of[m]] : 0;
    }
    return interfaces;
}

static void add_interfaces(text_t *text, const replay_heard_t *heard, uint32_t interfaces) {
    const char *between = "";
    for (size_t i = 0; i < heard->name_count; i++) {
        if (((interfaces >> i) & 1) != 0) {
            text_add(text, "%s%s", between, heard->names[i]);
            between = " and ";
        }
    }
}

static bool is_single(uint32_t bits) {
    return (bits != 0) && ((bits & (bits - 1)) == 0);
}

/** The AI side as a bit; 0: nothing was heard there. */
static uint32_t ai_side_of(const replay_clues_t *clues) {
    const replay_heard_t *heard = clues->heard;
    for (size_t i = 0; (clues->ai_interface != NULL) && (i < heard->name_count); i++) {
        if (strcmp(heard->names[i], clues->ai_interface) == 0) {
            return 1u << i;
        }
    }
    return 0;
}

/** A gateway's log that keeps it in INIT: the sides are swapped, or the commands that the gateway sent are in it. */
static bool hint_sides(text_t *text, const replay_clues_t *clues) {
    const uint32_t ai_side = ai_side_of(clues);
    const uint32_t status = interfaces_of(clues, false);
    const uint32_t other_commands = interfaces_of(clues, true) & ~ai_side;
    if ((clues->config->topology != AGV_TOPOLOGY_GATEWAY) || (why_supervised_us(clues->why) > 0) ||
        ((other_commands | (status & ai_side)) == 0)) {
        return false;
    }
    if (other_commands == 0) {
        text_add(text,
                 "status messages come on %s, which is the AI side: for the log of a shared bus leave out --ai-if",
                 clues->ai_interface);
    } else if ((status != 0) && (status == ai_side) && is_single(other_commands)) {
        text_add(text, "the sides are swapped (status messages come on %s): --ai-if ", clues->ai_interface);
        add_interfaces(text, clues->heard, other_commands);
    } else {
        text_add(text, "commands come on the vehicle side (");
        add_interfaces(text, clues->heard, other_commands);
        text_add(text, "): recorded on the vehicle side of a gateway? Remove the frames that the gateway sent");
    }
    return true;
}

/** Several interfaces in the log of a shared bus: a gateway, or two vehicles. */
static bool hint_interfaces(text_t *text, const replay_clues_t *clues) {
    const uint32_t commands = interfaces_of(clues, true);
    const uint32_t status = interfaces_of(clues, false);
    if ((clues->config->topology == AGV_TOPOLOGY_GATEWAY) || is_single(commands | status) ||
        ((commands | status) == 0)) {
        return false;
    }
    if (is_single(commands) && ((commands & status) == 0)) {
        text_add(text, "commands come on ");
        add_interfaces(text, clues->heard, commands);
        text_add(text, ", status messages on ");
        add_interfaces(text, clues->heard, status);
        text_add(text, ": a gateway? --ai-if ");
        add_interfaces(text, clues->heard, commands);
    } else {
        text_add(text, "the messages come on ");
        add_interfaces(text, clues->heard, commands | status);
        text_add(text, ": a gateway (--ai-if names its AI side), or two vehicles in one log?");
    }
    return true;
}

/** Nothing at all was heard for some time. */
static bool hint_pause(text_t *text, const replay_clues_t *clues) {
    const replay_heard_t *heard = clues->heard;
    if (heard->pause_us < PAUSE_US) {
        return false;
    }
    text_add(text, "no frame at all from ");
    why_words_time(text, heard->pause_at_us);
    text_add(text, " to ");
    why_words_time(text, heard->pause_at_us + heard->pause_us);
    text_add(text, ": was the recording interrupted, or its clock set?");
    return true;
}

/** Whether a command stayed away, or its counter stood still. A safe command hides that. */
static bool is_about_a_command(agv_fault_t reason) {
    const why_row_t *row = why_row(reason);
    return ((row->kind == WHY_SILENCE) || (row->kind == WHY_STUCK)) && (row->message < AGV_COMMAND_COUNT);
}

/** Add how to replay a log up to a trip that was recorded. */
static void add_until(text_t *text, const replay_recorded_t *recorded) {
    if (!is_about_a_command(recorded->reason)) {
        text_add(text, "--until %" PRIu64 "ms", (recorded->trip_us / US_PER_MS) + 1);
    } else if (recorded->commands_us > BURST_US) {
        text_add(text, "--until %" PRIu64 "ms --tail 200ms", (recorded->commands_us - BURST_US) / US_PER_MS);
    } else {
        text_add(text, "record again, and begin earlier");
    }
}

/** A supervisor was on the recorded bus: its commands replace those that did not come, so they hide why it tripped. */
static bool hint_supervisor(text_t *text, const replay_clues_t *clues) {
    const replay_recorded_t *recorded = &clues->heard->recorded;
    const char *reason = agv_fault_name(recorded->reason);
    if (recorded->state == 0) {
        return false;
    }
    text_add(text, "%03Xh received: a supervisor was active, and its commands are in this log",
             (unsigned)clues->config->status_frame_id);
    if (recorded->began_tripped && (reason != NULL)) {
        text_add(text, ". It had tripped by %s before the log began", reason);
    } else if ((recorded->trip_us > 0) && (reason != NULL)) {
        text_add(text, ". It tripped by %s, reported at ", reason);
        why_words_time(text, recorded->trip_us);
        text_add(text, ". To see the cause: ");
        add_until(text, recorded);
    }
    return true;
}

bool replay_hint(text_t *text, replay_hint_t hint, const replay_clues_t *clues) {
    static bool (*const hints[REPLAY_HINTS])(text_t *, const replay_clues_t *) = {
        [REPLAY_HINT_ID_SET] = hint_id_set,
        [REPLAY_HINT_OTHER_VEHICLE] = hint_other_vehicle,
        [REPLAY_HINT_NODE] = hint_node,
        [REPLAY_HINT_IDS] = hint_ids,
        [REPLAY_HINT_BEGIN] = hint_begin,
        [REPLAY_HINT_SIDES] = hint_sides,
        [REPLAY_HINT_INTERFACES] = hint_interfaces,
        [REPLAY_HINT_PAUSE] = hint_pause,
        [REPLAY_HINT_SUPERVISOR] = hint_supervisor,
    };
    return hints[hint](text, clues);
}

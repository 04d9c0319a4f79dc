#include "replay/replay_hints.h"

#include "agv/names.h"

enum { SHOWN_IDS = 6 };

static bool is_heard(const replay_heard_t *heard, uint32_t id) {
    return (id <= AGV_ID_MAX) && (heard->ids[id] != 0u);
}

/** Add identifiers as a list: "201h and 203h". */
static void add_ids(text_t *text, const uint16_t ids[], size_t count) {
    for (size_t i = 0u; i < count; i++) {
        const char *between = (i == 0u) ? "" : ((i + 1u == count) ? " and " : ", ");
        text_add(text, "%s%03Xh", between, (unsigned)ids[i]);
    }
}

/** The identifiers of the other set are there, those of the configured one are not. */
static bool hint_id_set(text_t *text, const agv_config_t *config, const replay_heard_t *heard) {
    const uint32_t other_set = (uint32_t)AGV_ID_SET_TABLE - config->id_set;
    agv_ids_t ids;
    uint16_t found[AGV_MSG_COUNT];
    uint16_t lacking[AGV_MSG_COUNT];
    size_t count = 0u;
    agv_config_ids(config, &ids);
    for (uint32_t m = 0u; m < (uint32_t)AGV_MSG_COUNT; m++) {
        const uint16_t other = agv_message_id(m, other_set);
        if ((other != ids.of[m]) && is_heard(heard, other) && !is_heard(heard, ids.of[m]) &&
            (agv_message_id(m, config->id_set) == ids.of[m])) {
            found[count] = other;
            lacking[count] = ids.of[m];
            count++;
        }
    }
    if (count == 0u) {
        return false;
    }
    add_ids(text, found, count);
    text_add(text, " heard, ");
    add_ids(text, lacking, count);
    text_add(text, " not: --id-set %s", (other_set == (uint32_t)AGV_ID_SET_TABLE) ? "table" : "heading");
    return true;
}

static size_t known_heard(const agv_config_t *config, const replay_heard_t *heard) {
    agv_ids_t ids;
    size_t count = 0u;
    agv_config_ids(config, &ids);
    for (size_t m = 0u; m < (size_t)AGV_MSG_COUNT; m++) {
        count += is_heard(heard, ids.of[m]) ? 1u : 0u;
    }
    return count;
}

/** Add the first identifiers that were heard. */
static void add_heard(text_t *text, const replay_heard_t *heard) {
    uint16_t shown[SHOWN_IDS];
    size_t count = 0u;
    bool more = false;
    for (uint32_t id = 0u; id <= AGV_ID_MAX; id++) {
        if (heard->ids[id] != 0u) {
            more = count == (size_t)SHOWN_IDS;
            if (more) {
                break;
            }
            shown[count] = (uint16_t)id;
            count++;
        }
    }
    if (more) {
        for (size_t i = 0u; i < count; i++) {
            text_add(text, "%03Xh, ", (unsigned)shown[i]);
        }
        text_add(text, "and others heard");
    } else if (count > 0u) {
        add_ids(text, shown, count);
        text_add(text, " heard");
    } else {
        text_add(text, heard->extended ? "only 29-bit identifiers heard" : "no data frame heard");
    }
}

static bool hint_other_vehicle(text_t *text, const agv_config_t *config, const replay_heard_t *heard) {
    const size_t known = known_heard(config, heard);
    if (2u * known >= (size_t)AGV_MSG_COUNT) {
        return false;
    }
    add_heard(text, heard);
    text_add(text, ", %zu of the %u messages of the protocol: another vehicle? Each identifier is a setting (id_...)",
             known, (unsigned)AGV_MSG_COUNT);
    return true;
}

/** All messages of a node are missing: VCU, EPS, AI computer. */
static bool hint_node(text_t *text, const agv_config_t *config, const replay_heard_t *heard) {
    static const agv_message_t eps[] = {AGV_MSG_STEERING_STATUS, AGV_MSG_EPS_STATUS, AGV_MSG_STEERING_POSITION};
    static const agv_message_t vcu[] = {AGV_MSG_VEHICLE_STATUS, AGV_MSG_GEAR_STATUS, AGV_MSG_THROTTLE_STATUS,
                                        AGV_MSG_WHEEL_SPEED};
    static const agv_message_t ai[] = {AGV_MSG_TURN_SIGNAL_COMMAND, AGV_MSG_GEAR_COMMAND, AGV_MSG_THROTTLE_COMMAND,
                                       AGV_MSG_STEERING_COMMAND};
    static const struct {
        const char *name;
        const agv_message_t *messages;
        size_t count;
    } nodes[] = {{"EPS", eps, sizeof eps / sizeof eps[0]},
                 {"VCU", vcu, sizeof vcu / sizeof vcu[0]},
                 {"AI computer", ai, sizeof ai / sizeof ai[0]}};
    agv_ids_t ids;
    agv_config_ids(config, &ids);
    for (size_t n = 0u; n < sizeof nodes / sizeof nodes[0]; n++) {
        uint16_t lacking[AGV_MSG_COUNT];
        size_t count = 0u;
        for (size_t i = 0u; i < nodes[n].count; i++) {
            const uint16_t id = ids.of[nodes[n].messages[i]];
            if (!is_heard(heard, id)) {
                lacking[count] = id;
                count++;
            }
        }
        if (count == nodes[n].count) {
            add_ids(text, lacking, count);
            text_add(text, " never heard: is the %s on this bus?", nodes[n].name);
            return true;
        }
    }
    return false;
}

bool replay_hint(text_t *text, replay_hint_t hint, const agv_config_t *config, const replay_heard_t *heard) {
    switch (hint) {
    case REPLAY_HINT_ID_SET:
        return hint_id_set(text, config, heard);
    case REPLAY_HINT_OTHER_VEHICLE:
        return hint_other_vehicle(text, config, heard);
    default:
        return (2u * known_heard(config, heard) >= (size_t)AGV_MSG_COUNT) && hint_node(text, config, heard);
    }
}

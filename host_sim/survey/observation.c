#include "survey/observation.h"

#include <stdio.h>
#include <string.h>

#include "common/report.h"
#include "text/units.h"

enum { BACK_US = 10 * US_PER_MS };

_Static_assert(OBSERVATION_NAMES_SIZE >=
                   (OBSERVATION_INTERFACES_MAX * (CANDUMP_INTERFACE_MAX + sizeof ",")) + sizeof " and others",
               "too many interfaces, or their names are too long");

bool observation_begin(observation_t *observation, const agv_config_t *config) {
    (void)memset(observation, 0, sizeof *observation);
    observation->configs[OBSERVATION_GIVEN] = *config;
    observation->configs[OBSERVATION_OTHER] = *config;
    observation->configs[OBSERVATION_OTHER].id_set =
        (config->id_set == AGV_ID_SET_HEADING) ? AGV_ID_SET_TABLE : AGV_ID_SET_HEADING;
    for (unsigned set = 0; set < OBSERVATION_SETS; set++) {
        observation->sets[set] = traffic_new(&observation->configs[set]);
        if (observation->sets[set] == NULL) {
            return report("out of memory");
        }
    }
    observation->evidence = evidence_new(observation->configs, OBSERVATION_SETS);
    return (observation->evidence != NULL) || report("out of memory");
}

static void note_backward(observation_t *observation, uint64_t back_us) {
    observation->backward_stamps++;
    if (back_us > observation->back_us) {
        observation->back_us = back_us;
        observation->back_at_us = observation->last_us - observation->first_us;
    }
}

bool observation_goes_back(const observation_t *observation, text_t *text) {
    text_clear(text);
    if (observation->back_us < BACK_US) {
        return false;
    }
    text_add(text, "time goes back by %.3f s at %.3f s: gaps and load are wrong; cut or sort the log there",
             s_of_us(observation->back_us), s_of_us(observation->back_at_us));
    return true;
}

void observation_frame(observation_t *observation, hal_can_side_t side, const hal_can_frame_t *frame,
                       uint64_t stamp_us) {
    if (observation->frames == 0) {
        observation->first_us = stamp_us;
        observation->last_us = stamp_us;
    }
    if (stamp_us < observation->last_us) {
        note_backward(observation, observation->last_us - stamp_us);
    } else {
        observation->last_us = stamp_us;
    }
    const uint64_t t_us = observation->last_us - observation->first_us;
    observation->frames++;
    bus_load_frame(&observation->loads[side], frame, t_us);
    evidence_frame(observation->evidence, side, frame, t_us);
    for (unsigned set = 0; set < OBSERVATION_SETS; set++) {
        traffic_frame(observation->sets[set], side, frame, t_us);
    }
}

void observation_interface(observation_t *observation, const char *name, size_t length, bool is_named) {
    for (uint32_t i = 0; i < observation->interface_count; i++) {
        if ((strncmp(observation->interfaces[i], name, length) == 0) && (observation->interfaces[i][length] == '\0')) {
            return;
        }
    }
    const bool is_full = observation->interface_count == OBSERVATION_INTERFACES_MAX;
    observation->more_interfaces = observation->more_interfaces || is_full;
    if (!is_full) {
        observation->interface_count++;
    }
    if (!is_full || is_named) {
        (void)snprintf(observation->interfaces[observation->interface_count - 1], CANDUMP_INTERFACE_MAX + 1, "%.*s",
                       (int)length, name);
    }
}

void observation_interfaces(const observation_t *observation, char text[OBSERVATION_NAMES_SIZE]) {
    size_t used = 0;
    for (uint32_t i = 0; i < observation->interface_count; i++) {
        used += (size_t)snprintf(&text[used], OBSERVATION_NAMES_SIZE - used, "%s%s", (i > 0) ? ", " : "",
                                 observation->interfaces[i]);
    }
    (void)snprintf(&text[used], OBSERVATION_NAMES_SIZE - used, "%s", observation->more_interfaces ? " and others" : "");
}

uint64_t observation_us(const observation_t *observation) {
    return observation->last_us - observation->first_us;
}

void observation_end(observation_t *observation, uint64_t last_us) {
    observation->last_us = (last_us > observation->last_us) ? last_us : observation->last_us;
    for (unsigned set = 0; set < OBSERVATION_SETS; set++) {
        traffic_end(observation->sets[set], observation_us(observation));
    }
}

/** Frames of a message; none if its identifier carries something else. */
static uint64_t count_of(const observation_t *observation, unsigned set, uint32_t message) {
    const traffic_id_t *entry = traffic_message(observation->sets[set], message);
    const evidence_id_t *heard = (entry != NULL) ? evidence_of(observation->evidence, entry->side, entry->id) : NULL;
    return ((heard != NULL) && !evidence_contradicts(heard)) ? entry->count : 0;
}

unsigned observation_heard_set(const observation_t *observation) {
    uint64_t counts[OBSERVATION_SETS];
    for (unsigned set = 0; set < OBSERVATION_SETS; set++) {
        counts[set] = count_of(observation, set, AGV_MSG_VEHICLE_STATUS) +
                      count_of(observation, set, AGV_MSG_TURN_SIGNAL_COMMAND);
    }
    return (counts[OBSERVATION_OTHER] > counts[OBSERVATION_GIVEN]) ? OBSERVATION_OTHER : OBSERVATION_GIVEN;
}

void observation_set_counts(const observation_t *observation, uint32_t id_set, uint64_t counts[2]) {
    const uint32_t messages[2] = {AGV_MSG_TURN_SIGNAL_COMMAND, AGV_MSG_VEHICLE_STATUS};
    for (size_t i = 0; i < 2; i++) {
        const uint16_t id = agv_message_id(messages[i], id_set);
        counts[i] = 0;
        for (size_t at = 0; traffic_at(observation->sets[0], at) != NULL; at++) {
            const traffic_id_t *entry = traffic_at(observation->sets[0], at);
            counts[i] += (!entry->is_extended && (entry->id == id)) ? entry->count : 0;
        }
    }
}

void observation_free(observation_t *observation) {
    for (unsigned set = 0; set < OBSERVATION_SETS; set++) {
        traffic_free(observation->sets[set]);
        observation->sets[set] = NULL;
    }
    evidence_free(observation->evidence);
    observation->evidence = NULL;
}

#include "survey/identify/track.h"

#include <stdlib.h>

enum { ROOM_FIRST = 16, ROOM_MAX = 20000, BITS_PER_BYTE = 8, NEVER = INT32_MAX };

/** Where a field is, and the smallest change that counts. */
static const struct {
    uint8_t at;
    uint8_t bytes;
    uint32_t mask;
    int32_t step;
} fields[FIELD_COUNT] = {
    [FIELD_BYTE_0] = {0, 1, 0xFFu, 1},        [FIELD_BYTE_1] = {1, 1, 0xFFu, NEVER},
    [FIELD_WORD_0] = {0, 2, 0xFFFFu, 5},      [FIELD_WORD_2] = {2, 2, 0xFFFFu, 5},
    [FIELD_LONG_0] = {0, 4, 0xFFFFFFFFu, 20}, [FIELD_LONG_4] = {4, 4, 0xFFFFFFFFu, 20},
    [FIELD_EPS_MODE] = {3, 1, 0xFFu, 1},      [FIELD_LIGHTS] = {4, 1, 0x30u, 1},
    [FIELD_SIGNALS] = {6, 1, 0x30u, 1},       [FIELD_MODE] = {6, 1, 0xC0u, 1},
};

/** The fields of each message; one without needs no track. */
static const uint32_t of_message[AGV_MSG_COUNT] = {
    [AGV_MSG_TURN_SIGNAL_COMMAND] = 1u << FIELD_LIGHTS,
    [AGV_MSG_GEAR_COMMAND] = 1u << FIELD_BYTE_0,
    [AGV_MSG_THROTTLE_COMMAND] = 1u << FIELD_BYTE_0,
    [AGV_MSG_STEERING_COMMAND] = 1u << FIELD_WORD_0,
    [AGV_MSG_VEHICLE_STATUS] = (1u << FIELD_WORD_0) | (1u << FIELD_SIGNALS) | (1u << FIELD_MODE),
    [AGV_MSG_GEAR_STATUS] = 1u << FIELD_BYTE_0,
    [AGV_MSG_THROTTLE_STATUS] = 1u << FIELD_BYTE_0,
    [AGV_MSG_STEERING_STATUS] = (1u << FIELD_BYTE_1) | (1u << FIELD_WORD_2),
    [AGV_MSG_EPS_STATUS] = 1u << FIELD_EPS_MODE,
    [AGV_MSG_WHEEL_SPEED] = (1u << FIELD_LONG_0) | (1u << FIELD_LONG_4),
};

uint32_t field_of_message(uint32_t message) {
    return of_message[message];
}

static int32_t field_read(field_t field, const uint8_t data[AGV_DLC]) {
    uint32_t raw = 0;
    for (uint32_t i = 0; i < fields[field].bytes; i++) {
        raw |= (uint32_t)data[fields[field].at + i] << (i * (uint32_t)BITS_PER_BYTE);
    }
    return (int32_t)(raw & fields[field].mask);
}

/** Make room for one more change. @return false: there is none */
static bool grow(track_t *track) {
    if (track->count < track->room) {
        return true;
    }
    const size_t room = (track->room == 0) ? (size_t)ROOM_FIRST : track->room * 2;
    track_change_t *changes = (track->count < ROOM_MAX) ? realloc(track->changes, room * sizeof *changes) : NULL;
    if (changes == NULL) {
        return false;
    }
    track->changes = changes;
    track->room = room;
    return true;
}

static bool is_change(const track_t *track, int32_t step, int32_t value) {
    if (track->count == 0) {
        return true;
    }
    return llabs((long long)value - track->changes[track->count - 1].value) >= step;
}

void track_add(track_t *track, field_t field, const uint8_t data[AGV_DLC], uint64_t t_us) {
    const int32_t value = field_read(field, data);
    const bool is_first = track->count == 0;
    track->lowest = (is_first || (value < track->lowest)) ? value : track->lowest;
    track->highest = (is_first || (value > track->highest)) ? value : track->highest;
    if (!track->is_full && is_change(track, fields[field].step, value)) {
        if (grow(track)) {
            track->changes[track->count] =
                (track_change_t){.before_us = is_first ? t_us : track->frame_us, .at_us = t_us, .value = value};
            track->count++;
        } else {
            track->is_full = true;
        }
    }
    track->frame_us = t_us;
    track->until_us = track->is_full ? track->until_us : t_us;
}

int32_t track_value(const track_t *track, size_t *at, uint64_t t_us) {
    while ((*at + 1 < track->count) && (track->changes[*at + 1].at_us <= t_us)) {
        (*at)++;
    }
    return track->changes[*at].value;
}

void track_free(track_t *track) {
    if (track != NULL) {
        free(track->changes);
        free(track);
    }
}

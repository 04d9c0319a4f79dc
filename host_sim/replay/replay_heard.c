#include "replay/replay_heard.h"

#include <string.h>

static bool is_named(const char *name, const candump_record_t *record) {
    return (strlen(name) == record->interface_length) &&
           (memcmp(name, record->interface, record->interface_length) == 0);
}

static void add_name(replay_heard_t *heard, const candump_record_t *record) {
    for (size_t i = 0u; i < heard->name_count; i++) {
        if (is_named(heard->names[i], record)) {
            heard->last_name = i;
            return;
        }
    }
    if (heard->name_count == (size_t)REPLAY_INTERFACES_MAX) {
        heard->more_names = true;
        return;
    }
    memcpy(heard->names[heard->name_count], record->interface, record->interface_length);
    heard->last_name = heard->name_count;
    heard->name_count++;
}

void replay_heard_add(replay_heard_t *heard, const candump_record_t *record) {
    const hal_can_frame_t *frame = &record->frame;
    if ((heard->name_count == 0u) || !is_named(heard->names[heard->last_name], record)) {
        add_name(heard, record);
    }
    if ((frame->flags & (HAL_CAN_ERROR | HAL_CAN_REMOTE)) != 0u) {
        return;
    }
    if ((frame->flags & HAL_CAN_EXTENDED) != 0u) {
        heard->extended = true;
    } else {
        heard->ids[frame->id & AGV_ID_MAX] = 1u;
    }
}

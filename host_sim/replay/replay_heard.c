#include "replay/replay_heard.h"

#include <string.h>

static void add_name(replay_heard_t *heard, const candump_record_t *record) {
    for (size_t i = 0; i < heard->name_count; i++) {
        if (candump_is_from(record, heard->names[i])) {
            heard->last_name = i;
            return;
        }
    }
    if (heard->name_count == REPLAY_INTERFACES_MAX) {
        heard->more_names = true;
        return;
    }
    memcpy(heard->names[heard->name_count], record->interface, record->interface_length);
    heard->last_name = heard->name_count;
    heard->name_count++;
}

void replay_heard_back(replay_heard_t *heard, uint64_t back_us, uint64_t line, uint64_t t_us) {
    if (back_us > heard->back_us) {
        heard->back_us = back_us;
        heard->back_line = line;
        heard->back_at_us = t_us;
    }
}

static void note_pause(replay_heard_t *heard, uint64_t t_us) {
    if (t_us - heard->last_us > heard->pause_us) {
        heard->pause_us = t_us - heard->last_us;
        heard->pause_at_us = heard->last_us;
    }
    heard->last_us = t_us;
}

void replay_heard_add(replay_heard_t *heard, const candump_record_t *record, uint64_t t_us) {
    const hal_can_frame_t *frame = &record->frame;
    note_pause(heard, t_us);
    if ((heard->name_count == 0) || !candump_is_from(record, heard->names[heard->last_name])) {
        add_name(heard, record);
    }
    if ((frame->flags & (HAL_CAN_ERROR | HAL_CAN_REMOTE)) != 0) {
        return;
    }
    if ((frame->flags & HAL_CAN_FD) != 0) {
        heard->fd = true;
    } else if ((frame->flags & HAL_CAN_EXTENDED) != 0) {
        heard->extended = true;
    } else {
        heard->ids[frame->id & AGV_ID_MAX] |= (uint8_t)(1u << heard->last_name);
    }
}

#include "replay/replay_heard.h"

#include <string.h>

#include "agv/codec.h"
#include "agv/names.h"

/** The status frame (docs/protocol.md, 7F0h). */
enum { STATE_AT = 0, REASON_AT = 1 };

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

static void take_lights(replay_recorded_t *recorded, const hal_can_frame_t *frame, uint64_t t_us) {
    agv_turn_signal_command_t lights;
    const bool is_off = agv_unpack_turn_signal_command(&lights, frame->data) && lights.autopilot_off;
    recorded->off_us = (is_off && !recorded->is_off) ? t_us : recorded->off_us;
    recorded->is_off = is_off;
}

/** The status frame reports a trip later than the safe commands begin, by its period at most. */
static void take_status(replay_recorded_t *recorded, const hal_can_frame_t *frame, uint64_t t_us) {
    const agv_state_t state = (agv_state_t)frame->data[STATE_AT];
    if (agv_state_name(state) == NULL) {
        return;
    }
    if (agv_state_is_latched(state) && (recorded->trip_us == 0) && !recorded->began_tripped) {
        recorded->began_tripped = recorded->state == 0;
        recorded->reason = (agv_fault_t)frame->data[REASON_AT];
        recorded->trip_us = t_us;
        recorded->commands_us = (recorded->is_off && (recorded->off_us > recorded->state_us)) ? recorded->off_us : t_us;
    }
    recorded->state = state;
    recorded->state_us = t_us;
}

void replay_heard_recorded(replay_recorded_t *recorded, const hal_can_frame_t *frame, uint64_t t_us) {
    if ((frame->flags != 0) || (frame->length != AGV_DLC)) {
        return;
    }
    if (frame->id == recorded->lights_id) {
        take_lights(recorded, frame, t_us);
    } else if ((frame->id == recorded->status_id) && (recorded->status_id != 0)) {
        take_status(recorded, frame, t_us);
    } else {
        /* not a frame of a supervisor that tells of a trip */
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

#include "monitor/inputs/monitor_can.h"

#include <string.h>

#include "common/report.h"
#include "text/units.h"

/** Frames that are passed on at once; the rest with the next call, so that keys are answered in a flood. */
enum { FRAMES_AT_ONCE = 4000, AGAIN_MS = 200, RECEIVE_SIZE = 4 << 20 };

static bool open_side(monitor_can_side_t *side, char *error) {
    const linux_can_options_t options = {.error_frames = true, .receive_size = RECEIVE_SIZE};
    side->is_open = linux_can_open(&side->can, side->interface, &options, error);
    side->has_next = false;
    side->lost = 0;
    return side->is_open;
}

bool monitor_can_open(monitor_can_t *bus, const char *const interfaces[HAL_CAN_SIDES]) {
    char error[LINUX_CAN_ERROR_SIZE];
    memset(bus, 0, sizeof *bus);
    linux_clock_start(&bus->clock);
    for (int i = 0; i < HAL_CAN_SIDES; i++) {
        bus->sides[i].interface = interfaces[i];
        if ((interfaces[i] != NULL) && !open_side(&bus->sides[i], error)) {
            monitor_can_close(bus);
            return report("%s", error);
        }
    }
    return true;
}

static void close_side(monitor_can_side_t *side) {
    if (side->is_open) {
        linux_can_close(&side->can);
        side->is_open = false;
    }
}

/** An interface that is gone is opened when it is back. */
static void try_again(monitor_can_side_t *side, uint64_t now_us) {
    char error[LINUX_CAN_ERROR_SIZE];
    if (!side->is_open && (now_us >= side->again_us)) {
        side->again_us = now_us + ((uint64_t)AGAIN_MS * US_PER_MS);
        (void)open_side(side, error);
    }
}

/** The time of a stamp. The clocks are read once a pass: in a flood it would cost more than all the rest. */
static uint64_t time_of(monitor_can_t *bus, uint64_t stamp_us) {
    const bool is_near = (bus->stamp_us != 0) && (stamp_us >= bus->stamp_us) && (stamp_us - bus->stamp_us < US_PER_S);
    if (!is_near) {
        bus->stamp_us = stamp_us;
        bus->stamp_at_us = linux_clock_of_stamp(&bus->clock, stamp_us);
    }
    return bus->stamp_at_us + (stamp_us - bus->stamp_us);
}

/** Read the next frame of a side, unless one is waiting. */
static void look(monitor_can_t *bus, monitor_can_side_t *side) {
    while (side->is_open && !side->has_next) {
        switch (linux_can_read(&side->can, &side->next)) {
        case LINUX_CAN_RECORD:
            side->has_next = true;
            side->next_us = time_of(bus, side->next.stamp_us);
            return;
        case LINUX_CAN_IS_GONE:
            close_side(side);
            return;
        case LINUX_CAN_IS_DOWN:
            break;
        default:
            return;
        }
    }
}

static void pass_on(monitor_can_t *bus, hal_can_side_t number, monitor_t *monitor, monitor_record_t *record) {
    monitor_can_side_t *side = &bus->sides[number];
    side->has_next = false;
    if (side->next.lost != side->lost) {
        monitor_lost(monitor, number, side->next.lost - side->lost, side->next_us);
        side->lost = side->next.lost;
    }
    if (record != NULL) {
        monitor_record_add(record, side->interface, side->next.stamp_us, &side->next.frame);
    }
    monitor_frame(monitor, number, &side->next.frame, side->next_us);
}

/** Pass on the earliest frame. @return false: there is none */
static bool pass_one(monitor_can_t *bus, monitor_t *monitor, monitor_record_t *record) {
    monitor_can_side_t *sides = bus->sides;
    for (int i = 0; i < HAL_CAN_SIDES; i++) {
        look(bus, &sides[i]);
    }
    const bool vehicle = sides[HAL_CAN_VEHICLE].has_next;
    const bool ai = sides[HAL_CAN_AI].has_next;
    if (!vehicle && !ai) {
        return false;
    }
    const bool ai_first = ai && (!vehicle || (sides[HAL_CAN_AI].next_us < sides[HAL_CAN_VEHICLE].next_us));
    pass_on(bus, ai_first ? HAL_CAN_AI : HAL_CAN_VEHICLE, monitor, record);
    return true;
}

void monitor_can_pass(monitor_can_t *bus, monitor_t *monitor, monitor_record_t *record) {
    const uint64_t now_us = linux_clock_now_us(&bus->clock);
    bus->stamp_us = 0;
    for (int i = 0; i < HAL_CAN_SIDES; i++) {
        monitor_can_side_t *side = &bus->sides[i];
        if (side->interface != NULL) {
            try_again(side, now_us);
            monitor_link(monitor, (hal_can_side_t)i, !side->is_open || !linux_can_is_up(&side->can), now_us);
        }
    }
    int passed = 0;
    while ((passed < FRAMES_AT_ONCE) && pass_one(bus, monitor, record)) {
        passed++;
    }
    if (passed < FRAMES_AT_ONCE) {
        monitor_time(monitor, now_us); /* all frames until then were passed on */
    }
}

void monitor_can_close(monitor_can_t *bus) {
    for (int i = 0; i < HAL_CAN_SIDES; i++) {
        close_side(&bus->sides[i]);
    }
}

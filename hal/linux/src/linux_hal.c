/* The port: opening, closing, receiving, and the work of every millisecond. */
#include "hal_linux/linux_hal.h"

#include <poll.h>
#include <stdio.h>

#include "linux_hal_internal.h"

enum { US_PER_MS = 1000, LOOK_EVERY_US = 100000 };

/* Records read in one call: more than all echoes that can come in a row (the waiting frames and the one in flight). */
#define RECORDS_AT_ONCE_MAX (2u * LINUX_HAL_QUEUE_SIZE)

/* Records read at the end: more than a socket's queue usually holds. */
#define RECORDS_AT_END_MAX 4096u

linux_hal_side_t *linux_hal_side(hal_t *hal, hal_can_side_t side) {
    const bool exists = (unsigned)side < HAL_CAN_SIDES && hal->sides[side].interface != NULL;
    return exists ? &hal->sides[side] : NULL;
}

uint64_t linux_hal_now_us(const hal_t *hal) {
    return linux_clock_now_us(&hal->clock);
}

static void look_whether_up(linux_hal_side_t *side) {
    const bool is_up = linux_can_is_up(&side->can);
    if (is_up && !side->is_up) {
        linux_hal_controller_up(side);
    } else if (!is_up && side->is_up) {
        linux_hal_controller_down(side);
    }
    linux_hal_controller_look(side);
}

static bool open_side(hal_t *hal, linux_hal_side_t *side, char *error) {
    const linux_can_options_t options = {
        .ids = hal->config.ids, .id_count = hal->config.id_count, .error_frames = true, .own_frames = true};
    if (!linux_can_open(&side->can, side->interface, &options, error)) {
        return false;
    }
    side->is_open = true;
    side->fd_changed = true;
    side->lost = 0;
    look_whether_up(side);
    return true;
}

/* An adapter was unplugged: the socket cannot be used any more, even if an interface with the same name appears. */
static void mark_side_lost(linux_hal_side_t *side, uint64_t now_us) {
    linux_hal_controller_down(side);
    linux_can_close(&side->can);
    side->is_open = false;
    side->fd_changed = true;
    side->look_again_us = now_us + LOOK_EVERY_US;
}

/* The indexes are compared, because an interface may have several names. */
static bool check_sides(const hal_t *hal, char *error) {
    const linux_hal_side_t *vehicle = &hal->sides[HAL_CAN_VEHICLE];
    const linux_hal_side_t *ai = &hal->sides[HAL_CAN_AI];
    if (!ai->is_open || ai->can.index != vehicle->can.index) {
        return true;
    }
    (void)snprintf(error, LINUX_CAN_ERROR_SIZE, "%s: both sides on one interface: a gateway needs two", ai->interface);
    return false;
}

static bool open_sides(hal_t *hal, char *error) {
    for (size_t i = 0; i < HAL_CAN_SIDES; i++) {
        linux_hal_side_t *side = &hal->sides[i];
        if (side->interface != NULL && !open_side(hal, side, error)) {
            return false;
        }
        if (!side->is_up && side->interface != NULL) {
            linux_hal_controller_down(side);
        }
        side->fd_changed = false;
    }
    return check_sides(hal, error);
}

bool linux_hal_open(hal_t *hal, const linux_hal_config_t *config, char *error) {
    *hal = (hal_t){.ops = &linux_hal_ops, .config = *config};
    error[0] = '\0';
    linux_clock_start(&hal->clock);
    for (size_t i = 0; i < HAL_CAN_SIDES; i++) {
        hal->sides[i].interface = config->interfaces[i];
        hal->sides[i].can.fd = -1;
    }
    if (config->interfaces[HAL_CAN_VEHICLE] == NULL) {
        (void)snprintf(error, LINUX_CAN_ERROR_SIZE, "the interface of the vehicle side is missing");
        return false;
    }
    if (!open_sides(hal, error)) {
        linux_hal_close(hal);
        return false;
    }
    return true;
}

int linux_hal_fd(const hal_t *hal, hal_can_side_t side) {
    return ((unsigned)side < HAL_CAN_SIDES) ? hal->sides[side].can.fd : -1;
}

/* A lost frame may have been the echo of the frame in flight. That frame then counts as sent, because its echo would
 * never come. */
static void count_lost(linux_hal_side_t *side, const linux_can_record_t *record, uint64_t at_us) {
    const uint32_t lost = record->lost - side->lost;
    side->lost = record->lost;
    side->overruns = (uint16_t)(side->overruns + lost);
    if (lost > 0 && at_us >= side->given_us) {
        side->in_flight = false;
    }
}

static void frame_left(hal_t *hal, hal_can_side_t which, const linux_can_record_t *record, uint64_t at_us) {
    linux_hal_side_t *side = &hal->sides[which];
    linux_hal_queue_left(side, &record->frame);
    linux_hal_queue_give(side, linux_hal_now_us(hal));
    if (hal->config.on_left != NULL) {
        hal_can_frame_t frame = record->frame;
        frame.time_ms = (uint32_t)(at_us / US_PER_MS);
        frame.time_us = (uint16_t)(at_us % US_PER_MS);
        hal->config.on_left(hal->config.ctx, which, &frame, at_us);
    }
}

static uint64_t time_of(const hal_t *hal, const linux_can_record_t *record) {
    return linux_clock_of_stamp_after(&hal->clock, record->stamp_us, hal->handed_us);
}

/* Read the echoes of frames that were sent, also those behind a report that the interface went down. Frames of other
 * senders are discarded. */
static void read_echoes(hal_t *hal, hal_can_side_t which) {
    linux_hal_side_t *side = &hal->sides[which];
    linux_can_record_t record;
    for (unsigned i = 0; i < RECORDS_AT_END_MAX; i++) {
        const linux_can_read_t result = linux_can_read(&side->can, &record);
        if (result == LINUX_CAN_NOTHING || result == LINUX_CAN_IS_GONE) {
            return;
        }
        if (result == LINUX_CAN_RECORD && record.own) {
            frame_left(hal, which, &record, time_of(hal, &record));
        }
    }
}

static bool is_sending(const linux_hal_side_t *side) {
    return side->is_up && (side->in_flight || side->waiting_count > 0);
}

void linux_hal_finish(hal_t *hal) {
    const uint64_t end_us = linux_hal_now_us(hal) + (uint64_t)LINUX_HAL_FINISH_MS * US_PER_MS;
    linux_hal_side_t *vehicle = &hal->sides[HAL_CAN_VEHICLE];
    linux_hal_side_t *ai = &hal->sides[HAL_CAN_AI];
    while ((is_sending(vehicle) || is_sending(ai)) && linux_hal_now_us(hal) < end_us) {
        struct pollfd files[HAL_CAN_SIDES] = {{.fd = vehicle->can.fd, .events = POLLIN},
                                              {.fd = ai->can.fd, .events = POLLIN}};
        (void)poll(files, HAL_CAN_SIDES, 1); /* 1 ms: no event reports room in a full kernel queue */
        for (size_t i = 0; i < HAL_CAN_SIDES; i++) {
            read_echoes(hal, (hal_can_side_t)i);
            linux_hal_queue_give(&hal->sides[i], linux_hal_now_us(hal));
        }
    }
}

static void close_side(hal_t *hal, hal_can_side_t which) {
    linux_hal_side_t *side = &hal->sides[which];
    linux_hal_queue_discard(side);
    read_echoes(hal, which);
    linux_can_close(&side->can);
    side->is_open = false;
    side->is_up = false;
    side->has_next = false;
}

/* The vehicle side is closed last: when a gateway ends, the commands stop before the vehicle's status does. */
void linux_hal_close(hal_t *hal) {
    close_side(hal, HAL_CAN_AI);
    close_side(hal, HAL_CAN_VEHICLE);
}

static void take_record(hal_t *hal, hal_can_side_t which, const linux_can_record_t *record) {
    linux_hal_side_t *side = &hal->sides[which];
    const uint64_t at_us = time_of(hal, record);
    if (record->lost != side->lost) {
        count_lost(side, record, at_us);
    }
    if (record->own) {
        frame_left(hal, which, record, at_us);
        return;
    }
    if ((record->frame.flags & HAL_CAN_ERROR) != 0) {
        linux_hal_controller_error(side, &record->frame);
    }
    side->next = *record;
    side->next_us = at_us;
    side->has_next = true;
}

/* Read until a received frame is found, or nothing is left. */
static void read_ahead(hal_t *hal, hal_can_side_t which) {
    linux_hal_side_t *side = &hal->sides[which];
    for (unsigned i = 0; i < RECORDS_AT_ONCE_MAX && side->is_open && !side->has_next; i++) {
        linux_can_record_t record;
        switch (linux_can_read(&side->can, &record)) {
        case LINUX_CAN_RECORD:
            take_record(hal, which, &record);
            break;
        case LINUX_CAN_IS_DOWN:
            linux_hal_controller_down(side);
            break;
        case LINUX_CAN_IS_GONE:
            mark_side_lost(side, linux_hal_now_us(hal));
            break;
        case LINUX_CAN_NOTHING:
            return;
        }
    }
}

/* The side whose frame arrived first. The kernel's stamps are compared, because the times computed from them have
 * jitter. */
static bool find_first(const hal_t *hal, hal_can_side_t *first) {
    const linux_hal_side_t *vehicle = &hal->sides[HAL_CAN_VEHICLE];
    const linux_hal_side_t *ai = &hal->sides[HAL_CAN_AI];
    const bool ai_is_first = ai->has_next && (!vehicle->has_next || ai->next.stamp_us < vehicle->next.stamp_us);
    *first = ai_is_first ? HAL_CAN_AI : HAL_CAN_VEHICLE;
    return ai->has_next || vehicle->has_next;
}

bool linux_hal_receive(hal_t *hal, hal_can_side_t *side, hal_can_frame_t *frame, uint64_t *at_us) {
    hal->looked_us = linux_hal_now_us(hal);
    read_ahead(hal, HAL_CAN_VEHICLE);
    read_ahead(hal, HAL_CAN_AI);
    if (hal->sides[HAL_CAN_AI].has_next) {
        read_ahead(hal, HAL_CAN_VEHICLE); /* a frame that arrived between the two calls may be older */
    }
    if (!find_first(hal, side)) {
        return false;
    }
    linux_hal_side_t *first = &hal->sides[*side];
    first->has_next = false;
    hal->handed_us = (first->next_us > hal->handed_us) ? first->next_us : hal->handed_us;
    *at_us = hal->handed_us;
    *frame = first->next.frame;
    frame->time_ms = (uint32_t)(*at_us / US_PER_MS);
    frame->time_us = (uint16_t)(*at_us % US_PER_MS);
    return true;
}

/* An interface that is down is checked at every tick, so that it is used again as soon as it is up. */
static void check_link(hal_t *hal, linux_hal_side_t *side, uint64_t now_us) {
    const bool is_due = now_us >= side->look_again_us;
    if (is_due) {
        side->look_again_us = now_us + LOOK_EVERY_US;
    }
    if (side->is_open && (is_due || !side->is_up)) {
        look_whether_up(side);
    } else if (!side->is_open && is_due) {
        char error[LINUX_CAN_ERROR_SIZE];
        (void)open_side(hal, side, error);
    }
}

bool linux_hal_tick(hal_t *hal) {
    const uint64_t now_us = linux_hal_now_us(hal);
    bool changed = false;
    for (size_t i = 0; i < HAL_CAN_SIDES; i++) {
        linux_hal_side_t *side = &hal->sides[i];
        if (side->interface == NULL) {
            continue;
        }
        check_link(hal, side, now_us);
        linux_hal_queue_look(side, hal->looked_us);
        linux_hal_queue_give(side, now_us);
        changed = changed || side->fd_changed;
        side->fd_changed = false;
    }
    return changed;
}

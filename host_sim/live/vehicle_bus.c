#include "live/vehicle_bus.h"

#include <string.h>

#include "common/report.h"
#include "text/units.h"

enum { RECORDS_AT_ONCE = 1000 };

static hal_can_side_t side_of_file(const vehicle_bus_t *bus, unsigned file) {
    return (file < VEHICLE_NODES) ? vehicle_side_of(&bus->vehicle, (vehicle_node_t)file)
                                  : (hal_can_side_t)(file - (unsigned)VEHICLE_NODES);
}

static linux_can_t *can_of_file(vehicle_bus_t *bus, unsigned file) {
    return (file < VEHICLE_NODES) ? &bus->nodes[file] : &bus->rogues[file - (unsigned)VEHICLE_NODES];
}

/** The time by the clock; not before what the vehicle has seen. */
static uint64_t advance_clock(vehicle_bus_t *bus, uint64_t now_us) {
    const uint64_t now_ms = now_us / US_PER_MS;

    bus->now_ms = (now_ms > bus->now_ms) ? now_ms : bus->now_ms;
    return bus->now_ms;
}

uint64_t vehicle_bus_now_ms(vehicle_bus_t *bus) {
    return advance_clock(bus, linux_clock_now_us(bus->config.clock));
}

static void send_frame(void *ctx, vehicle_node_t from, hal_can_side_t side, const hal_can_frame_t *frame) {
    vehicle_bus_t *bus = ctx;
    linux_can_t *can = (from == VEHICLE_ROGUE) ? &bus->rogues[side] : &bus->nodes[from];

    if (linux_can_write(can, frame) == LINUX_CAN_TAKEN) {
        bus->sent++;
    } else {
        bus->unsent++;
    }
}

static bool open_file(vehicle_bus_t *bus, unsigned file) {
    static const uint16_t nothing[1] = {0};
    const char *interface = bus->config.interfaces[side_of_file(bus, file)];
    linux_can_options_t options = {.own_frames = bus->config.on_sent != NULL};
    char error[LINUX_CAN_ERROR_SIZE];

    if ((file >= VEHICLE_NODES) && !options.own_frames) {
        options.ids = nothing; /* a rogue node does not listen */
    }
    if ((file >= VEHICLE_NODES) && (interface == NULL)) {
        return true; /* no AI side, no rogue node there */
    }
    return linux_can_open(can_of_file(bus, file), interface, &options, error) || report("%s", error);
}

bool vehicle_bus_open(vehicle_bus_t *bus, const vehicle_bus_config_t *config) {
    memset(bus, 0, sizeof *bus);
    bus->config = *config;
    for (unsigned file = 0; file < VEHICLE_BUS_FILES; file++) {
        can_of_file(bus, file)->fd = -1;
    }
    vehicle_init(&bus->vehicle, &config->vehicle, send_frame, bus);
    for (unsigned file = 0; file < VEHICLE_BUS_FILES; file++) {
        if (!open_file(bus, file)) {
            vehicle_bus_close(bus);
            return false;
        }
    }
    return true;
}

int vehicle_bus_fd(const vehicle_bus_t *bus, unsigned file) {
    return (file < VEHICLE_NODES) ? bus->nodes[file].fd : bus->rogues[file - (unsigned)VEHICLE_NODES].fd;
}

/** A frame for a node; or one that has left it. */
static void take(vehicle_bus_t *bus, unsigned file, const linux_can_record_t *record) {
    const vehicle_bus_config_t *config = &bus->config;
    const uint64_t at_us = linux_clock_of_stamp_after(config->clock, record->stamp_us, bus->now_ms * US_PER_MS);

    if (!record->own) {
        vehicle_receive(&bus->vehicle, (vehicle_node_t)file, advance_clock(bus, at_us), &record->frame);
    } else if (config->on_sent != NULL) {
        config->on_sent(config->ctx, (vehicle_node_t)((file < VEHICLE_NODES) ? file : VEHICLE_ROGUE),
                        side_of_file(bus, file), &record->frame, at_us);
    }
}

/** Read one socket empty, but for a flood that leaves no time for the rest. @return false: its interface is gone. */
static bool receive_file(vehicle_bus_t *bus, unsigned file) {
    linux_can_t *can = can_of_file(bus, file);
    const hal_can_side_t side = side_of_file(bus, file);
    linux_can_record_t record;

    if (can->fd < 0) {
        return true;
    }
    for (int i = 0; i < RECORDS_AT_ONCE; i++) {
        switch (linux_can_read(can, &record)) {
        case LINUX_CAN_RECORD:
            take(bus, file, &record);
            break;
        case LINUX_CAN_IS_DOWN:
            bus->is_down[side] = true;
            break;
        case LINUX_CAN_IS_GONE:
            return report("%s: the interface is gone", bus->config.interfaces[side]);
        default:
            return true;
        }
    }
    return true;
}

bool vehicle_bus_receive(vehicle_bus_t *bus) {
    for (unsigned side = 0; side < HAL_CAN_SIDES; side++) {
        bus->is_down[side] = bus->is_down[side] && !linux_can_is_up(&bus->rogues[side]);
    }
    for (unsigned file = 0; file < VEHICLE_BUS_FILES; file++) {
        if (!receive_file(bus, file)) {
            return false;
        }
    }
    return true;
}

/** The tick's time is read before the frames: none that has arrived by then is unread when deadlines are judged. */
bool vehicle_bus_tick(vehicle_bus_t *bus) {
    const uint64_t tick_us = linux_clock_now_us(bus->config.clock);
    const bool good = vehicle_bus_receive(bus);

    if (good) {
        vehicle_tick(&bus->vehicle, advance_clock(bus, tick_us));
    }
    return good;
}

void vehicle_bus_view(vehicle_bus_t *bus, vehicle_view_t *view) {
    vehicle_view(&bus->vehicle, vehicle_bus_now_ms(bus), view);
}

bool vehicle_bus_do(vehicle_bus_t *bus, const vehicle_action_t *action) {
    return vehicle_do(&bus->vehicle, vehicle_bus_now_ms(bus), action);
}

void vehicle_bus_close(vehicle_bus_t *bus) {
    for (unsigned file = 0; file < VEHICLE_BUS_FILES; file++) {
        linux_can_close(can_of_file(bus, file));
        can_of_file(bus, file)->fd = -1;
    }
}

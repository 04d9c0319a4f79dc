/**
 * @file vehicle_bus.h
 * A simulated vehicle (vehicle.h) on SocketCAN: each of its nodes has a socket of its own, so it hears the others and
 * not itself. Frames of a rogue node go out through a fourth and fifth socket, one a side.
 */
#ifndef HOST_SIM_VEHICLE_BUS_H
#define HOST_SIM_VEHICLE_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_linux/linux_can.h"
#include "hal_linux/linux_clock.h"
#include "vehicle/vehicle.h"

/** A frame of the vehicle has left. @param from the node, or VEHICLE_ROGUE @param at_us by the kernel's stamp */
typedef void vehicle_bus_sent_fn(void *ctx, vehicle_node_t from, hal_can_side_t side, const hal_can_frame_t *frame,
                                 uint64_t at_us);

/** How it is made. */
typedef struct {
    vehicle_config_t vehicle;
    const char *interfaces[HAL_CAN_SIDES]; /**< the AI side: NULL on the shared bus */
    const linux_clock_t *clock;            /**< time of the run; stays the caller's */
    vehicle_bus_sent_fn *on_sent;          /**< or NULL: own frames are not read back then */
    void *ctx;
} vehicle_bus_config_t;

/** A vehicle on a bus. Read the members freely, change them through the functions. */
typedef struct {
    vehicle_t vehicle;
    vehicle_bus_config_t config;
    linux_can_t nodes[VEHICLE_NODES];
    linux_can_t rogues[HAL_CAN_SIDES];
    uint64_t now_ms;             /**< how far the vehicle has come: its time never goes back */
    uint64_t sent;               /**< frames that the kernel took */
    uint64_t unsent;             /**< frames that it did not: they are lost, as on a bus without acknowledge */
    bool is_down[HAL_CAN_SIDES]; /**< the interface is down: nothing is sent or received */
} vehicle_bus_t;

/** How many files vehicle_bus_fd() knows. */
#define VEHICLE_BUS_FILES ((unsigned)VEHICLE_NODES + (unsigned)HAL_CAN_SIDES)

/** Open it; the vehicle stands in manual, gear P, at the clock's present time. @return false: was reported */
bool vehicle_bus_open(vehicle_bus_t *bus, const vehicle_bus_config_t *config);

/** The files to wait for (linux_loop.h), 0 .. VEHICLE_BUS_FILES - 1; -1: this one is not open. */
int vehicle_bus_fd(const vehicle_bus_t *bus, unsigned file);

/**
 * Pass received frames to the nodes, and report the frames that have left.
 * @return false: an interface is gone; was reported. The vehicle cannot go on.
 */
bool vehicle_bus_receive(vehicle_bus_t *bus);

/** vehicle_bus_receive(), and send what was due before it. @return as vehicle_bus_receive() */
bool vehicle_bus_tick(vehicle_bus_t *bus);

/** The present time of the vehicle: the clock's, in milliseconds. */
uint64_t vehicle_bus_now_ms(vehicle_bus_t *bus);

/** The vehicle at the present time (vehicle_view()). */
void vehicle_bus_view(vehicle_bus_t *bus, vehicle_view_t *view);

/** Do something now (vehicle_do()); frames of it go out with the next tick. */
bool vehicle_bus_do(vehicle_bus_t *bus, const vehicle_action_t *action);

/** Close. Nothing where vehicle_bus_open() failed. */
void vehicle_bus_close(vehicle_bus_t *bus);

#endif

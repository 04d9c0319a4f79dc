/**
 * @file vehicle.h
 * A healthy vehicle and AI computer.
 */
#ifndef VEHICLE_H
#define VEHICLE_H

#include <stdbool.h>
#include <stdint.h>

#include <zephyr/drivers/can.h>

/** The reported values. */
typedef struct {
    bool autopilot;
    bool park;
    bool ai_is_silent;
    bool button_1;
    int32_t speed_mm_s;
} vehicle_t;

extern vehicle_t vehicle;

/** Called for each of their frames; defined by the part that simulates the bus. */
void vehicle_sends(const struct can_frame *frame);

/** Run for this time, in real time of the kernel. */
void vehicle_run(uint32_t ms);

#endif

/**
 * @file vehicle.h
 * A vehicle and an AI computer that send what they should.
 */
#ifndef VEHICLE_H
#define VEHICLE_H

#include <stdbool.h>
#include <stdint.h>

#include <zephyr/drivers/can.h>

/** What it reports. */
typedef struct {
    bool autopilot;
    bool park;
    bool ai_is_silent;
    bool button_1;
    uint8_t eps_faults;
    int32_t speed_mm_s;
} vehicle_t;

extern vehicle_t vehicle;

/** A frame of theirs; what stands for the bus defines it. */
void vehicle_sends(const struct can_frame *frame);

/** A millisecond of it: the frames that are due. */
void vehicle_millisecond(uint32_t now_ms);

/** Let it run on for so long, in real time of the kernel. */
void vehicle_run(uint32_t ms);

#endif

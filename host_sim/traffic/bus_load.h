/**
 * @file bus_load.h
 * How much of a bus's time frames take.
 *
 * How many stuff bits a frame has depends on its bits. The load is stated without any and with the most that there can
 * be; the true one lies between. Every bit counts at the nominal bit rate, also those of a CAN FD frame that are faster.
 */
#ifndef HOST_SIM_BUS_LOAD_H
#define HOST_SIM_BUS_LOAD_H

#include <stdint.h>

#include "hal/can.h"

/** All zero: nothing yet. */
typedef struct {
    uint64_t bits;           /**< without stuff bits, with the space between frames */
    uint64_t stuffed_bits;   /**< with the most stuff bits */
    uint64_t second;         /**< the second in hand, since the start */
    uint64_t second_bits;    /**< its `stuffed_bits` */
    uint64_t busiest_bits;   /**< of the busiest second so far */
    uint64_t busiest_second; /**< which one that was */
} bus_load_t;

/** Take a frame. Error frames have no length. */
void bus_load_frame(bus_load_t *load, const hal_can_frame_t *frame, uint64_t t_us);

/** Percent of the time. @param bits within @p us @return 0 for no time */
double bus_load_percent(uint64_t bits, uint64_t us, uint32_t bit_rate);

/** `stuffed_bits` of the busiest second. */
uint64_t bus_load_busiest(const bus_load_t *load);

#endif

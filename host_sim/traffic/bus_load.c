#include "traffic/bus_load.h"

#include <stdbool.h>

#include "text/units.h"

enum { BYTE_BITS = 8, BITS_BETWEEN_STUFF_BITS = 4, PERCENT = 100 };

/** Bits of a frame beside its data: those that may be stuffed, and the others (delimiters, end, space). */
enum { STANDARD_STUFFABLE = 34, EXTENDED_STUFFABLE = 54, FD_MORE = 13, NOT_STUFFABLE = 13 };

void bus_load_frame(bus_load_t *load, const hal_can_frame_t *frame, uint64_t t_us) {
    if ((frame->flags & HAL_CAN_ERROR) != 0) {
        return;
    }
    const bool is_remote = (frame->flags & HAL_CAN_REMOTE) != 0;
    const uint32_t header = ((frame->flags & HAL_CAN_EXTENDED) != 0) ? EXTENDED_STUFFABLE : STANDARD_STUFFABLE;
    const uint32_t more = ((frame->flags & HAL_CAN_FD) != 0) ? FD_MORE : 0;
    const uint32_t stuffable = header + more + (is_remote ? 0 : ((uint32_t)frame->length * BYTE_BITS));
    const uint64_t bits = (uint64_t)stuffable + NOT_STUFFABLE;
    const uint64_t stuffed_bits = bits + ((stuffable - 1) / BITS_BETWEEN_STUFF_BITS);
    if (t_us / US_PER_S != load->second) {
        load->busiest_second = (load->second_bits > load->busiest_bits) ? load->second : load->busiest_second;
        load->busiest_bits = bus_load_busiest(load);
        load->second = t_us / US_PER_S;
        load->second_bits = 0;
    }
    load->bits += bits;
    load->stuffed_bits += stuffed_bits;
    load->second_bits += stuffed_bits;
}

uint64_t bus_load_busiest(const bus_load_t *load) {
    return (load->second_bits > load->busiest_bits) ? load->second_bits : load->busiest_bits;
}

double bus_load_percent(uint64_t bits, uint64_t us, uint32_t bit_rate) {
    return (us == 0) ? 0.0 : ((double)bits * (double)PERCENT * (double)US_PER_S) / ((double)us * (double)bit_rate);
}

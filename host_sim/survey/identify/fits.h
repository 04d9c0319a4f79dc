/**
 * @file fits.h
 * Which messages of the protocol an unknown payload could be: for vehicles that use other identifiers.
 */
#ifndef HOST_SIM_FITS_H
#define HOST_SIM_FITS_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/protocol.h"

/** Every message. */
#define FITS_ALL ((1u << AGV_MSG_COUNT) - 1u)

/**
 * Take away the messages that a payload cannot be: a reserved bit is set, a value is invalid, no mode is reported, or
 * (wheels and steering position) its values do not belong together.
 * @param fits bits of the messages that are still possible @return what is left of them
 */
uint32_t fits_frame(uint32_t fits, const uint8_t data[AGV_DLC]);

/** Whether a payload has no reserved bit and no invalid value of a message, and reports a mode if it is 363h. */
bool fits_protocol(uint32_t message, const uint8_t data[AGV_DLC]);

#endif

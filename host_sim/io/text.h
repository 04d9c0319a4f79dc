/**
 * @file text.h
 * Hexadecimal digits.
 */
#ifndef HOST_SIM_TEXT_H
#define HOST_SIM_TEXT_H

#include <stdint.h>

enum { TEXT_NO_DIGIT = 16 };

/** One more than the value of a hexadecimal digit; 0 for what is none. */
extern const uint8_t TEXT_DIGIT_PLUS_1[256];

/** Value of a hexadecimal digit in either case; TEXT_NO_DIGIT or more for what is none. */
static inline uint32_t text_hex_digit(char character) {
    return (TEXT_DIGIT_PLUS_1[(unsigned char)character] + 255u) & 0xFFu;
}

#endif

/**
 * @file hex.h
 * Hexadecimal digits.
 */
#ifndef HOST_SIM_HEX_H
#define HOST_SIM_HEX_H

#include <stddef.h>
#include <stdint.h>

enum { HEX_NO_DIGIT = 16 };

/** The digits as they are written. */
extern const char HEX_DIGITS[];

/** One more than the value of a hexadecimal digit; 0 for other characters. */
extern const uint8_t HEX_DIGIT_PLUS_1[256];

/** Value of a hexadecimal digit in either case; HEX_NO_DIGIT or more for other characters. */
static inline uint32_t hex_digit(char character) {
    return (HEX_DIGIT_PLUS_1[(unsigned char)character] + 255) & 0xFFu;
}

/** Read hexadecimal bytes. @return how many; 0: none, more than @p most, half a byte, or another character */
size_t hex_bytes(const char *text, size_t length, uint8_t *bytes, size_t most);

#endif

#include "text/hex.h"

const char HEX_DIGITS[] = "0123456789ABCDEF";

const uint8_t HEX_DIGIT_PLUS_1[256] = {
    ['0'] = 1,  ['1'] = 2,  ['2'] = 3,  ['3'] = 4,  ['4'] = 5,  ['5'] = 6,  ['6'] = 7,  ['7'] = 8,
    ['8'] = 9,  ['9'] = 10, ['A'] = 11, ['B'] = 12, ['C'] = 13, ['D'] = 14, ['E'] = 15, ['F'] = 16,
    ['a'] = 11, ['b'] = 12, ['c'] = 13, ['d'] = 14, ['e'] = 15, ['f'] = 16,
};

size_t hex_bytes(const char *text, size_t length, uint8_t *bytes, size_t most) {
    if (((length % 2) != 0) || (length / 2 > most)) {
        return 0;
    }
    for (size_t i = 0; i < length / 2; i++) {
        const uint32_t high = hex_digit(text[2 * i]);
        const uint32_t low = hex_digit(text[(2 * i) + 1]);
        if ((high >= HEX_NO_DIGIT) || (low >= HEX_NO_DIGIT)) {
            return 0;
        }
        bytes[i] = (uint8_t)((high << 4) | low);
    }
    return length / 2;
}

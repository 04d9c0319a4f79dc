#include "common/missing.h"

#include <stdio.h>
#include <string.h>

#include "agv/names.h"

const char *missing_text(uint16_t missing, char text[MISSING_TEXT_SIZE]) {
    text[0] = '\0';
    for (uint8_t bit = 0; bit < MISSING_BITS; bit++) {
        if ((missing & (1u << bit)) != 0) {
            const size_t used = strlen(text);
            (void)snprintf(&text[used], MISSING_TEXT_SIZE - used, "%s%s", (used > 0) ? ", " : "",
                           agv_missing_name(bit));
        }
    }
    return text;
}

uint16_t missing_bit(const char *word) {
    for (uint8_t bit = 0; bit < MISSING_BITS; bit++) {
        if (strcmp(word, agv_missing_name(bit)) == 0) {
            return (uint16_t)(1u << bit);
        }
    }
    return 0;
}

#include "common/missing.h"

#include <stdio.h>
#include <string.h>

#include "agv/names.h"

/** The word of a bit; NULL: there are no further bits. */
typedef const char *name_fn(uint8_t bit);

static const char *text_of(name_fn *name, uint16_t bits, char text[MISSING_TEXT_SIZE]) {
    text[0] = '\0';
    for (uint8_t bit = 0; name(bit) != NULL; bit++) {
        if ((bits & (1u << bit)) != 0) {
            const size_t used = strlen(text);
            (void)snprintf(&text[used], MISSING_TEXT_SIZE - used, "%s%s", (used > 0) ? ", " : "", name(bit));
        }
    }
    return text;
}

static uint16_t bit_of(name_fn *name, const char *word) {
    for (uint8_t bit = 0; name(bit) != NULL; bit++) {
        if (strcmp(word, name(bit)) == 0) {
            return (uint16_t)(1u << bit);
        }
    }
    return 0;
}

const char *missing_text(uint16_t missing, char text[MISSING_TEXT_SIZE]) {
    return text_of(agv_missing_name, missing, text);
}

uint16_t missing_bit(const char *word) {
    return bit_of(agv_missing_name, word);
}

const char *parts_text(uint16_t parts, char text[MISSING_TEXT_SIZE]) {
    return text_of(agv_self_test_part_name, parts, text);
}

uint16_t part_bit(const char *word) {
    return bit_of(agv_self_test_part_name, word);
}

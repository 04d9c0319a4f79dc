/*
 * The bytes of a fuzzer, read from the front. After their end all values are 0.
 */
#ifndef INPUT_H
#define INPUT_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef struct {
    const uint8_t *at;
    size_t left;
} input_t;

static inline uint8_t input_byte(input_t *input) {
    if (input->left == 0) {
        return 0;
    }
    input->left--;
    return *input->at++;
}

static inline uint16_t input_word(input_t *input) {
    const unsigned low = input_byte(input);
    return (uint16_t)(low | ((unsigned)input_byte(input) << 8));
}

static inline void input_bytes(input_t *input, uint8_t *to, size_t count) {
    for (size_t i = 0; i < count; i++) {
        to[i] = input_byte(input);
    }
}

/* Called by libFuzzer, or by replay.c without it. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#endif

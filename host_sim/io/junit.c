#include "io/junit.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { NUMBER_TEXT_SIZE = 128 };

static void put(output_t *output, const char *text) {
    (void)output_write(output, text, strlen(text));
}

/** Length of the UTF-8 sequence at this place; 0: malformed, or a character that XML forbids. */
static size_t sequence_length(const uint8_t *at) {
    size_t length = 0u;
    uint32_t lowest = 0u;
    uint32_t value = at[0];

    if (at[0] < 0x80u) {
        return ((at[0] >= 0x20u) || (at[0] == '\t') || (at[0] == '\n')) ? 1u : 0u;
    }
    if ((at[0] & 0xE0u) == 0xC0u) {
        length = 2u;
        lowest = 0x80u;
        value &= 0x1Fu;
    } else if ((at[0] & 0xF0u) == 0xE0u) {
        length = 3u;
        lowest = 0x800u;
        value &= 0x0Fu;
    } else if ((at[0] & 0xF8u) == 0xF0u) {
        length = 4u;
        lowest = 0x10000u;
        value &= 0x07u;
    } else {
        return 0u;
    }
    for (size_t i = 1u; i < length; i++) {
        if ((at[i] & 0xC0u) != 0x80u) { /* the terminating zero, too */
            return 0u;
        }
        value = (value << 6) | (at[i] & 0x3Fu);
    }
    const bool forbidden = ((value >= 0xD800u) && (value <= 0xDFFFu)) || (value == 0xFFFEu) || (value == 0xFFFFu);
    return ((value >= lowest) && (value <= 0x10FFFFu) && !forbidden) ? length : 0u;
}

void junit_text(output_t *output, const char *text) {
    static const struct {
        char plain;
        const char *escaped;
    } escapes[] = {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&apos;"}, {'\n', "&#10;"}};
    const uint8_t *at = (const uint8_t *)text;

    while (*at != 0u) {
        const size_t length = sequence_length(at);
        const char *escaped = (length == 0u) ? "?" : NULL;
        for (size_t i = 0u; i < sizeof escapes / sizeof escapes[0]; i++) {
            if (*at == (uint8_t)escapes[i].plain) {
                escaped = escapes[i].escaped;
            }
        }
        if (escaped != NULL) {
            put(output, escaped);
        } else {
            (void)output_write(output, at, length);
        }
        at += (length == 0u) ? 1u : length;
    }
}

void junit_begin(output_t *output, const char *suite, size_t tests, size_t failures, size_t errors) {
    char numbers[NUMBER_TEXT_SIZE];

    (void)snprintf(numbers, sizeof numbers, "\" tests=\"%zu\" failures=\"%zu\" errors=\"%zu\" skipped=\"0\">\n", tests,
                   failures, errors);
    put(output, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"");
    junit_text(output, suite);
    put(output, numbers);
}

static void begin_test(output_t *output, const char *class_name, const char *name) {
    put(output, "  <testcase classname=\"");
    junit_text(output, class_name);
    put(output, "\" name=\"");
    junit_text(output, name);
}

void junit_test(output_t *output, const char *class_name, const char *name, const char *failures, size_t count,
                size_t stride) {
    begin_test(output, class_name, name);
    if (count == 0u) {
        put(output, "\"/>\n");
        return;
    }
    put(output, "\">\n    <failure message=\"");
    junit_text(output, failures);
    put(output, "\">");
    for (size_t i = 0u; i < count; i++) {
        junit_text(output, &failures[i * stride]);
        put(output, "\n");
    }
    put(output, "</failure>\n  </testcase>\n");
}

void junit_error(output_t *output, const char *class_name, const char *name, const char *message) {
    begin_test(output, class_name, name);
    put(output, "\">\n    <error message=\"");
    junit_text(output, message);
    put(output, "\"/>\n  </testcase>\n");
}

void junit_end(output_t *output) {
    put(output, "</testsuite>\n");
}

#include "io/junit.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "text/text.h"

enum { NUMBER_TEXT_SIZE = 128 };

static void put(output_t *output, const char *text) {
    (void)output_write(output, text, strlen(text));
}

/** Length of the UTF-8 sequence at this place; 0: malformed, or a character that XML forbids. */
static size_t sequence_length(const char *at) {
    uint32_t value = 0;
    const size_t length = text_character(at, &value);
    const bool is_control = (value < 0x20u) && (value != (uint32_t)'\t') && (value != (uint32_t)'\n');
    const bool is_none =
        ((value >= 0xD800u) && (value <= 0xDFFFu)) || (value == 0xFFFEu) || (value == 0xFFFFu) || (value > 0x10FFFFu);
    return (is_control || is_none) ? 0 : length;
}

void junit_text(output_t *output, const char *text) {
    static const struct {
        char plain;
        const char *escaped;
    } escapes[] = {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&apos;"}, {'\n', "&#10;"}};
    const char *at = text;

    while (*at != '\0') {
        const size_t length = sequence_length(at);
        const char *escaped = (length == 0) ? "?" : NULL;
        for (size_t i = 0; i < sizeof escapes / sizeof escapes[0]; i++) {
            if (*at == escapes[i].plain) {
                escaped = escapes[i].escaped;
            }
        }
        if (escaped != NULL) {
            put(output, escaped);
        } else {
            (void)output_write(output, at, length);
        }
        at += (length == 0) ? 1 : length;
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
    if (count == 0) {
        put(output, "\"/>\n");
        return;
    }
    put(output, "\">\n    <failure message=\"");
    junit_text(output, failures);
    put(output, "\">");
    for (size_t i = 0; i < count; i++) {
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

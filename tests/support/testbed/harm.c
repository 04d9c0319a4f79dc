#include "harm.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "testbed.h"

enum { PRINTED_MAX = 20 };

uint64_t harm_count;

static char harm[240];

void harm_begin(void) {
    harm[0] = '\0';
}

void harm_note(const char *what) {
    if (harm[0] == '\0') {
        (void)snprintf(harm, sizeof harm, "%s", what);
    }
}

bool harm_is_noted(void) {
    return harm[0] != '\0';
}

bool harm_rule_is(const char *text) {
    return strncmp(testbed.rules.broken, text, strlen(text)) == 0;
}

void harm_take_rule(bool expected) {
    if (!expected) {
        harm_note(testbed.rules.broken);
    }
    testbed.rules.broken[0] = '\0';
}

void harm_report(const char *format, ...) {
    va_list arguments;
    if (harm[0] == '\0') {
        return;
    }
    harm_count++;
    if (harm_count <= PRINTED_MAX) {
        (void)printf("HARM: ");
        va_start(arguments, format);
        (void)vprintf(format, arguments);
        va_end(arguments);
        (void)printf(": %s\n", harm);
    }
}

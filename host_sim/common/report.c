#include "common/report.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "text/text.h"

enum { LINE_SIZE = 1024 };

__attribute__((format(printf, 2, 0))) static void print_line(const char *prefix, const char *format,
                                                             va_list arguments) {
    char line[LINE_SIZE];
    size_t used = (size_t)snprintf(line, sizeof line, "%s", prefix);
    if (used < sizeof line) {
        (void)vsnprintf(&line[used], sizeof line - used, format, arguments);
    }
    text_mask(line);
    /* One call, so that lines of several processes on one terminal do not mix. */
    (void)fprintf(stderr, "%s\n", line);
}

bool report(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    print_line("host_sim: ", format, arguments);
    va_end(arguments);
    return false;
}

bool report_at(const char *file, size_t line, const char *format, ...) {
    char prefix[LINE_SIZE / 2];
    (void)snprintf(prefix, sizeof prefix, "%.400s:%zu: ", file, line);
    va_list arguments;
    va_start(arguments, format);
    print_line(prefix, format, arguments);
    va_end(arguments);
    return false;
}

void note(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    print_line("host_sim: ", format, arguments);
    va_end(arguments);
}

const char *report_input_name(const char *path) {
    return (strcmp(path, "-") == 0) ? "standard input" : path;
}

bool report_stdout(void) {
    /* An error of an earlier write is remembered by the stream, its errno is not. */
    bool failed = ferror(stdout) != 0;
    errno = 0;
    if (fflush(stdout) != 0) {
        return report("standard output: %s", strerror(errno));
    }
    if (!failed) {
        return true;
    }
    clearerr(stdout); /* the output is incomplete anyway: writing once more tells the reason, unless that is gone */
    const bool fails_again = (putchar('\n') == EOF) || (fflush(stdout) != 0);
    return report("standard output: %s", (fails_again && (errno != 0)) ? strerror(errno) : "write error");
}

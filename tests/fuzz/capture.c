#include "capture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { KEPT_MAX = 1 << 16 };

static FILE *true_stderr;
static FILE *true_stdout;
static FILE *kept_stderr;
static FILE *kept_stdout;
static char err_text[KEPT_MAX];
static char out_text[KEPT_MAX];
static size_t out_size;

const char *capture_file(const uint8_t *data, size_t size) {
    static int fd = -1;
    static char path[40];
    if (fd < 0) {
        fd = memfd_create("fuzz", MFD_CLOEXEC);
    }
    if ((fd < 0) || (ftruncate(fd, 0) != 0) || (pwrite(fd, data, size, 0) != (ssize_t)size)) {
        perror("memfd");
        exit(2);
    }
    (void)snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    return path;
}

void capture_begin(void) {
    memset(err_text, 0, 1);
    memset(out_text, 0, 1);
    true_stderr = stderr;
    true_stdout = stdout;
    kept_stderr = fmemopen(err_text, sizeof err_text, "w");
    kept_stdout = fmemopen(out_text, sizeof out_text, "w");
    if ((kept_stderr == NULL) || (kept_stdout == NULL)) {
        perror("fmemopen");
        exit(2);
    }
    stderr = kept_stderr;
    stdout = kept_stdout;
}

const char *capture_end(void) {
    (void)fflush(kept_stdout);
    out_size = (size_t)ftell(kept_stdout);
    (void)fclose(kept_stderr);
    (void)fclose(kept_stdout);
    stderr = true_stderr;
    stdout = true_stdout;
    return err_text;
}

const char *capture_out(size_t *size) {
    *size = out_size;
    return out_text;
}

void capture_fail(const char *what, const char *detail) {
    (void)fprintf(stderr, "%s: %s\n", what, detail);
    abort();
}

void capture_one_line(const char *text) {
    const size_t length = strlen(text);
    if ((length < 2) || (text[length - 1] != '\n')) {
        capture_fail("no line says what is wrong", text);
    }
    for (size_t i = 0; i < length - 1; i++) {
        if (((unsigned char)text[i] < 0x20u) || (text[i] == 0x7F)) {
            capture_fail("more than a line, or a control character", text);
        }
    }
}

size_t capture_line(const char *text, const char *path, size_t highest) {
    const size_t length = strlen(path);
    char *end = NULL;
    capture_one_line(text);
    if ((strncmp(text, path, length) != 0) || (text[length] != ':')) {
        capture_fail("the file is not named", text);
    }
    const unsigned long line = strtoul(&text[length + 1], &end, 10);
    if ((line == 0) || (line > highest) || (end[0] != ':') || (end[1] != ' ') || (end[2] == '\n')) {
        capture_fail("no line of the file is named, or not what is wrong", text);
    }
    return line;
}

size_t capture_yaml_lines(const uint8_t *data, size_t size) {
    static const char BREAKS[] = "\n\r\x85\xA8\xA9\x28\x29"; /* each byte that may be part of a break */
    size_t lines = 2;
    for (size_t i = 0; i < size; i++) {
        lines += (memchr(BREAKS, data[i], sizeof BREAKS - 1) != NULL) ? 1 : 0;
    }
    return lines;
}

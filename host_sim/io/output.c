#include "io/output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/interrupt.h"
#include "common/report.h"

/* A pipe takes that many bytes without blocking after poll() reports that it is writable. */
enum { SLOW_CHUNK = 4096 };

bool output_is_stdout(const char *path) {
    return (path != NULL) && ((strcmp(path, "-") == 0) || (strcmp(path, "/dev/stdout") == 0));
}

/** The permissions of the file that is replaced, or those of a new one. */
static mode_t permissions(const char *path) {
    struct stat existing;
    if (stat(path, &existing) == 0) {
        return existing.st_mode & 0777;
    }
    mode_t mask = umask(0);
    (void)umask(mask);
    return 0666 & ~mask;
}

/**
 * Where a path leads to: a link is followed, so that it stays one; of a file that is not there, its folder is resolved.
 * The caller frees it. NULL: see errno.
 */
static char *destination(const char *path) {
    struct stat there;
    char *real = realpath(path, NULL);
    if ((real != NULL) || (errno != ENOENT) || (lstat(path, &there) == 0)) {
        return real; /* NULL for a link to nothing, too: it is not replaced by a file */
    }
    const char *slash = strrchr(path, '/');
    const char *name = (slash != NULL) ? &slash[1] : path;
    size_t folder_length = (size_t)(name - path);
    char *folder = (folder_length > 0) ? strndup(path, folder_length) : strdup(".");
    char *real_folder = (folder != NULL) ? realpath(folder, NULL) : NULL;
    free(folder);
    if (real_folder == NULL) {
        return NULL;
    }
    size_t size = strlen(real_folder) + strlen(name) + 2;
    real = malloc(size);
    if (real != NULL) {
        (void)snprintf(real, size, "%s/%s", real_folder, name);
    }
    free(real_folder);
    return real;
}

static bool open_temporary(output_t *output, const char *path) {
    static const char suffix[] = ".XXXXXX";
    interrupt_hold();
    output->path = destination(path);
    size_t length = (output->path != NULL) ? strlen(output->path) : 0;
    output->temporary = malloc(length + sizeof suffix);
    if ((output->path == NULL) || (output->temporary == NULL)) {
        output->fd = -1;
        return false;
    }
    (void)memcpy(output->temporary, output->path, length);
    (void)memcpy(&output->temporary[length], suffix, sizeof suffix);
    output->fd = mkstemp(output->temporary);
    if (output->fd < 0) {
        return false;
    }
    (void)fchmod(output->fd, permissions(path));
    return true;
}

static void forget(output_t *output) {
    free(output->path);
    free(output->temporary);
    output->path = NULL;
    output->temporary = NULL;
    output->is_open = false;
}

static void begin(output_t *output, const char *path) {
    output->name = output_is_stdout(path) ? "standard output" : path;
    output->path = NULL;
    output->temporary = NULL;
    output->is_slow = false;
    output->error = 0;
    output->used = 0;
}

bool output_open_in_place(output_t *output, const char *path) {
    begin(output, path);
    output->fd = open(path, O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    output->is_open = output->fd >= 0;
    return output->is_open || report("%s: %s", path, strerror(errno));
}

bool output_empty(output_t *output) {
    return (ftruncate(output->fd, 0) == 0) || report("%s: %s", output->name, strerror(errno));
}

bool output_open_pipe(output_t *output, const char *path) {
    begin(output, path);
    output->is_slow = true;
    output->fd = open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC); /* for reading, too: open() does not wait for a reader */
    output->is_open = output->fd >= 0;
    return output->is_open || report("%s: %s", path, strerror(errno));
}

bool output_open(output_t *output, const char *path) {
    struct stat existing;
    bool exists = stat(path, &existing) == 0;
    bool opened = false;
    begin(output, path);
    if (output_is_stdout(path)) {
        output->fd = STDOUT_FILENO;
        opened = true;
    } else if (exists && !S_ISREG(existing.st_mode)) {
        output->fd = open(path, O_WRONLY | O_CLOEXEC);
        opened = output->fd >= 0;
    } else if (exists && (access(path, W_OK) != 0)) {
        opened = false;
    } else {
        opened = open_temporary(output, path);
    }
    if (!opened) {
        (void)report("%s: %s", output->name, strerror(errno));
        forget(output);
        return false;
    }
    output->is_slow = (fstat(output->fd, &existing) != 0) || !S_ISREG(existing.st_mode);
    output->is_open = true;
    return true;
}

static bool write_all(output_t *output, const char *bytes, size_t size) {
    size_t done = 0;
    while ((done < size) && (output->error == 0)) {
        size_t left = size - done;
        if (output->is_slow) {
            left = (left < SLOW_CHUNK) ? left : SLOW_CHUNK;
            if (!interrupt_wait(output->fd, INTERRUPT_WRITE)) {
                output->error = EINTR;
                break;
            }
        }
        ssize_t count = write(output->fd, &bytes[done], left);
        if (count >= 0) {
            done += (size_t)count;
        } else if ((errno != EINTR) && (errno != EAGAIN)) {
            output->error = errno;
        }
    }
    return output->error == 0;
}

bool output_flush(output_t *output) {
    size_t used = output->used;
    output->used = 0;
    return write_all(output, output->buffer, used);
}

bool output_write(output_t *output, const void *bytes, size_t size) {
    if ((size > OUTPUT_BUFFER_SIZE - output->used) && !output_flush(output)) {
        return false;
    }
    if (size > OUTPUT_BUFFER_SIZE) {
        return write_all(output, bytes, size);
    }
    (void)memcpy(&output->buffer[output->used], bytes, size);
    output->used += size;
    return output->error == 0;
}

bool output_commit(output_t *output) {
    if (!output->is_open) {
        return true;
    }
    (void)output_flush(output);
    bool closes = output->fd != STDOUT_FILENO;
    if (closes && (close(output->fd) != 0) && (output->error == 0)) {
        output->error = errno;
    }
    if ((output->temporary != NULL) && (output->error == 0) && (rename(output->temporary, output->path) != 0)) {
        output->error = errno;
    }
    int error = output->error;
    if ((output->temporary != NULL) && (error != 0)) {
        (void)unlink(output->temporary);
    }
    forget(output);
    return (error == 0) ? true : report("%s: %s", output->name, strerror(error));
}

bool output_flush_all(output_t outputs[], size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (outputs[i].is_open && !output_flush(&outputs[i])) {
            return output_commit(&outputs[i]);
        }
    }
    return true;
}

bool output_commit_all(output_t outputs[], size_t count) {
    bool good = output_flush_all(outputs, count);
    for (size_t i = 0; good && (i < count); i++) {
        good = output_commit(&outputs[i]);
    }
    return good;
}

void output_discard(output_t *output) {
    if (output->is_open) {
        if (output->fd != STDOUT_FILENO) {
            (void)close(output->fd);
        }
        if (output->temporary != NULL) {
            (void)unlink(output->temporary);
        }
        forget(output);
    }
}

static bool find(const output_role_t *role, struct stat *found) {
    if (role->is_written && output_is_stdout(role->path)) {
        return fstat(STDOUT_FILENO, found) == 0;
    }
    if (!role->is_written && (strcmp(role->path, "-") == 0)) {
        return fstat(STDIN_FILENO, found) == 0;
    }
    return stat(role->path, found) == 0;
}

/** Whether two roles are one file, be it there or not. */
static bool is_same_file(const output_role_t *a, const output_role_t *b) {
    struct stat of_a;
    struct stat of_b;
    bool has_a = find(a, &of_a);
    bool has_b = find(b, &of_b);
    if (has_a && has_b) {
        return S_ISREG(of_a.st_mode) && (of_a.st_dev == of_b.st_dev) && (of_a.st_ino == of_b.st_ino);
    }
    char *real_a = destination(a->path);
    char *real_b = destination(b->path);
    bool same = (real_a != NULL) && (real_b != NULL) && (strcmp(real_a, real_b) == 0);
    free(real_a);
    free(real_b);
    return same;
}

static bool is_conflict(const output_role_t *a, const output_role_t *b) {
    if ((a->path == NULL) || (b->path == NULL) || !(a->is_written || b->is_written)) {
        return false;
    }
    if (a->is_written && b->is_written && output_is_stdout(a->path) && output_is_stdout(b->path)) {
        return true;
    }
    return is_same_file(a, b);
}

bool output_check_distinct(const output_role_t *roles, size_t count) {
    for (size_t a = 0; a < count; a++) {
        for (size_t b = a + 1; b < count; b++) {
            if (is_conflict(&roles[a], &roles[b])) {
                return report("%s and %s are the same file, '%s'", roles[a].role, roles[b].role, roles[b].path);
            }
        }
    }
    return true;
}

bool output_check_folder(const char *role, const char *path) {
    static const char name[] = "/.host_sim.XXXXXX";
    struct stat about;
    if ((stat(path, &about) != 0) || !S_ISDIR(about.st_mode)) {
        return report("%s: '%s' is not a folder", role, path);
    }
    const size_t size = strlen(path) + sizeof name;
    char *file = malloc(size);
    if (file == NULL) {
        return report("out of memory");
    }
    (void)snprintf(file, size, "%s%s", path, name);
    const int fd = mkstemp(file);
    const int error = errno;
    if (fd >= 0) {
        (void)unlink(file);
        (void)close(fd);
    }
    free(file);
    return (fd >= 0) || report("%s: the folder '%s' cannot be written: %s", role, path, strerror(error));
}

bool output_put(output_t *output, const char *path, const void *bytes, size_t size) {
    if (!output_open(output, path)) {
        return false;
    }
    (void)output_write(output, bytes, size);
    return output_commit(output);
}

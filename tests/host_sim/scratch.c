#include "scratch.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "unity.h"

#define SAID "said"

static char folder[32];
static char said[SCRATCH_TEXT_MAX];
static char content[SCRATCH_TEXT_MAX];
static int real_stderr = -1;
static int said_fd = -1;

const char *scratch_path(const char *name) {
    static char paths[4][512];
    static unsigned next;
    char *path = paths[next++ % 4];
    (void)snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

static void close_folder(void) {
    if (real_stderr < 0) {
        return;
    }
    (void)fflush(stderr);
    (void)dup2(real_stderr, STDERR_FILENO);
    (void)close(real_stderr);
    real_stderr = -1;
    (void)close(said_fd);
    DIR *all = opendir(folder);
    for (struct dirent *entry = readdir(all); entry != NULL; entry = readdir(all)) {
        (void)unlink(scratch_path(entry->d_name));
    }
    (void)closedir(all);
    (void)rmdir(folder);
}

void scratch_open(void) {
    static bool is_open;
    close_folder();
    if (!is_open) {
        (void)atexit(close_folder);
        is_open = true;
    }
    (void)snprintf(folder, sizeof folder, "/tmp/host_sim_test.XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    said_fd = open(scratch_path(SAID), O_RDWR | O_CREAT | O_TRUNC, 0600);
    TEST_ASSERT_TRUE(said_fd >= 0);
    (void)fflush(stderr);
    real_stderr = dup(STDERR_FILENO);
    (void)dup2(said_fd, STDERR_FILENO);
}

const char *scratch_write(const char *name, const void *bytes, size_t size) {
    const char *path = scratch_path(name);
    FILE *file = fopen(path, "wb");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL_UINT(size, fwrite(bytes, 1, size, file));
    TEST_ASSERT_EQUAL_INT(0, fclose(file));
    return path;
}

const char *scratch_read(const char *name) {
    FILE *file = fopen(scratch_path(name), "rb");
    size_t size = 0;
    if (file != NULL) {
        size = fread(content, 1, sizeof content - 1, file);
        (void)fclose(file);
    }
    content[size] = '\0';
    return content;
}

size_t scratch_count(void) {
    size_t count = 0;
    DIR *all = opendir(folder);
    for (struct dirent *entry = readdir(all); entry != NULL; entry = readdir(all)) {
        count += (entry->d_name[0] != '.' && strcmp(entry->d_name, SAID) != 0) ? 1 : 0;
    }
    (void)closedir(all);
    return count;
}

const char *scratch_said(void) {
    (void)fflush(stderr);
    (void)lseek(said_fd, 0, SEEK_SET);
    ssize_t size = read(said_fd, said, sizeof said - 1);
    said[size > 0 ? size : 0] = '\0';
    (void)ftruncate(said_fd, 0);
    (void)lseek(said_fd, 0, SEEK_SET);
    return said;
}

const char *scratch_said_line(const char *text) {
    const char *line = scratch_said();
    const char *found = strstr(line, text);
    TEST_ASSERT_NOT_NULL_MESSAGE(found, line);
    TEST_ASSERT_EQUAL_PTR_MESSAGE(&line[strlen(line) - 1], strchr(line, '\n'), line);
    return found;
}

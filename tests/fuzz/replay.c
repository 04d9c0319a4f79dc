/*
 * Runs a fuzz target on files, for compilers without libFuzzer: on every named file, and every file in every named
 * folder. Fails if there is no file.
 */
#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "input.h"

enum { SIZE_MAX_BYTES = 1 << 20, PATH_SIZE = 4096 };

static bool run_file(const char *path) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        perror(path);
        return false;
    }
    uint8_t *bytes = malloc(SIZE_MAX_BYTES);
    const size_t size = (bytes != NULL) ? fread(bytes, 1, SIZE_MAX_BYTES, file) : 0;
    (void)fclose(file);
    /* Allocated with its exact size, so that the sanitizers detect reads beyond it. */
    uint8_t *exact = malloc((size > 0) ? size : 1);
    if ((bytes == NULL) || (exact == NULL)) {
        exit(2);
    }
    memcpy(exact, bytes, size);
    free(bytes);
    (void)LLVMFuzzerTestOneInput(exact, size);
    free(exact);
    return true;
}

static unsigned run_folder(const char *path) {
    char inside[PATH_SIZE];
    unsigned count = 0;
    DIR *folder = opendir(path);
    if (folder == NULL) {
        perror(path);
        exit(2);
    }
    for (const struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
        if (entry->d_name[0] != '.') {
            (void)snprintf(inside, sizeof inside, "%s/%s", path, entry->d_name);
            count += run_file(inside) ? 1 : 0;
        }
    }
    (void)closedir(folder);
    return count;
}

int main(int argc, char **argv) {
    unsigned count = 0;
    for (int i = 1; i < argc; i++) {
        struct stat status;
        if (stat(argv[i], &status) != 0) {
            perror(argv[i]);
            return 2;
        }
        count += S_ISDIR(status.st_mode) ? run_folder(argv[i]) : (run_file(argv[i]) ? 1 : 0);
    }
    (void)printf("%u inputs\n", count);
    return (count > 0) ? 0 : 2;
}

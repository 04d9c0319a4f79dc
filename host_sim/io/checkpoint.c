#include "io/checkpoint.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "agv/checksum.h"
#include "common/report.h"

#define DAMAGED "%s: a damaged checkpoint; remove it to start over"

/** The header. */
typedef struct {
    char magic[24];
    char version[16];
    uint64_t numbers[CHECKPOINT_NUMBERS];
    uint64_t size; /**< of all parts */
} head_t;

static head_t head_of(const checkpoint_t *checkpoint, const checkpoint_part_t parts[], size_t count) {
    head_t head;
    memset(&head, 0, sizeof head);
    (void)snprintf(head.magic, sizeof head.magic, "agv %s 2", checkpoint->kind);
    (void)snprintf(head.version, sizeof head.version, "%s", HOST_SIM_VERSION);
    memcpy(head.numbers, checkpoint->numbers, sizeof head.numbers);
    for (size_t i = 0; i < count; i++) {
        head.size += parts[i].size;
    }
    return head;
}

static uint32_t checksum_of(const checkpoint_part_t parts[], size_t count) {
    uint32_t checksum = AGV_CRC32_START;
    for (size_t i = 0; i < count; i++) {
        checksum = agv_crc32(checksum, parts[i].bytes, parts[i].size);
    }
    return checksum;
}

bool checkpoint_check_path(const char *path) {
    return !output_is_stdout(path) || report("--checkpoint: give a file; standard output cannot be read");
}

bool checkpoint_may_save(const char *path, output_t *file) {
    const bool may = (path == NULL) || output_open(file, path);
    output_discard(file);
    return may;
}

bool checkpoint_save(const checkpoint_t *checkpoint, output_t *file, const checkpoint_part_t parts[], size_t count) {
    const head_t head = head_of(checkpoint, parts, count);
    const uint32_t checksum = checksum_of(parts, count);

    if (checkpoint->path == NULL) {
        return true;
    }
    if (!output_open(file, checkpoint->path)) {
        return false;
    }
    (void)output_write(file, &head, sizeof head);
    for (size_t i = 0; i < count; i++) {
        (void)output_write(file, parts[i].bytes, parts[i].size);
    }
    (void)output_write(file, &checksum, sizeof checksum);
    return output_commit(file);
}

/** The magic without its number: a file that begins otherwise is something else. */
static bool is_kind(const checkpoint_t *checkpoint, const head_t *head, size_t size) {
    char begin[sizeof head->magic];
    const int length = snprintf(begin, sizeof begin, "agv %s ", checkpoint->kind);
    return (length > 0) && (size >= (size_t)length) && (memcmp(head, begin, (size_t)length) == 0);
}

static bool read_all(const checkpoint_t *checkpoint, const checkpoint_part_t parts[], size_t count, FILE *stream) {
    const head_t expected = head_of(checkpoint, parts, count);
    const char *path = checkpoint->path;
    uint32_t checksum = 0;
    bool whole = true;
    head_t head;

    const size_t size = fread(&head, 1, sizeof head, stream);
    if (!is_kind(checkpoint, &head, size)) {
        return report("%s: not a %s checkpoint", path, checkpoint->kind);
    }
    if (size < sizeof head) {
        return report(DAMAGED, path);
    }
    if (memcmp(&head, &expected, sizeof head) != 0) {
        return report("%s: the checkpoint of another %s or another build; remove it to start over", path,
                      checkpoint->kind);
    }
    for (size_t i = 0; whole && (i < count); i++) {
        whole = fread(parts[i].bytes, parts[i].size, 1, stream) == 1;
    }
    whole = whole && (fread(&checksum, sizeof checksum, 1, stream) == 1) && (fgetc(stream) == EOF);
    return (whole && (checksum == checksum_of(parts, count))) || report(DAMAGED, path);
}

bool checkpoint_load(const checkpoint_t *checkpoint, const checkpoint_part_t parts[], size_t count, bool *loaded) {
    *loaded = false;
    if (checkpoint->path == NULL) {
        return true;
    }
    FILE *stream = fopen(checkpoint->path, "rb");
    if (stream == NULL) {
        return (errno == ENOENT) || report("%s: %s", checkpoint->path, strerror(errno));
    }
    *loaded = read_all(checkpoint, parts, count, stream);
    (void)fclose(stream);
    return *loaded;
}

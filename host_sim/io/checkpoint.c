#include "io/checkpoint.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "agv/checksum.h"
#include "common/report.h"

#define DAMAGED "%s: a damaged checkpoint; remove it to start over"

/* A file that is replaced or removed between two calls is opened again. */
enum { CHUNK_SIZE = 65536, TRIES = 100 };

/** The header. */
typedef struct {
    char magic[24];
    uint64_t program;
    uint64_t numbers[CHECKPOINT_NUMBERS];
    uint64_t size; /**< of all parts */
} head_t;

static head_t head_of(const checkpoint_t *checkpoint, const checkpoint_part_t parts[], size_t count) {
    head_t head;
    memset(&head, 0, sizeof head);
    (void)snprintf(head.magic, sizeof head.magic, "agv %s 3", checkpoint->kind);
    head.program = checkpoint->program;
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

/** The checksum of the program's file: another build may do other things, and lay out its memory in another way. */
static bool identify_program(checkpoint_t *checkpoint) {
    static const char path[] = "/proc/self/exe";
    uint8_t chunk[CHUNK_SIZE];
    FILE *stream = fopen(path, "rb");

    if (stream == NULL) {
        return report("--checkpoint: %s: %s", path, strerror(errno));
    }
    checkpoint->program = AGV_CRC32_START;
    while ((feof(stream) == 0) && (ferror(stream) == 0)) {
        const size_t length = fread(chunk, 1, sizeof chunk, stream);
        checkpoint->program = agv_crc32(checkpoint->program, chunk, length);
    }
    const bool good = ferror(stream) == 0;
    (void)fclose(stream);
    return good || report("--checkpoint: %s cannot be read", path);
}

/** Whether its path still leads to the file that is locked. */
static bool is_in_place(const checkpoint_t *checkpoint, struct stat *locked) {
    struct stat there;
    return (fstat(checkpoint->lock, locked) == 0) && (stat(checkpoint->path, &there) == 0) &&
           (locked->st_dev == there.st_dev) && (locked->st_ino == there.st_ino);
}

/** Open its file, and make it if it is not there. @return false: see errno */
static bool open_or_make(checkpoint_t *checkpoint) {
    checkpoint->lock = open(checkpoint->path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    checkpoint->is_made = checkpoint->lock >= 0;
    if ((checkpoint->lock < 0) && (errno == EEXIST)) {
        checkpoint->lock = open(checkpoint->path, O_RDWR | O_CLOEXEC);
    }
    return checkpoint->lock >= 0;
}

/** @return false: another run has it */
static bool lock_file(const checkpoint_t *checkpoint) {
    if (flock(checkpoint->lock, LOCK_EX | LOCK_NB) == 0) {
        return true;
    }
    if (errno == EWOULDBLOCK) {
        return false;
    }
    note("%s: no lock (%s): see to it that no other run uses this file", checkpoint->path, strerror(errno));
    return true;
}

/** Open and lock the file, which may be replaced or removed meanwhile by the run that has the lock. */
static bool open_locked(checkpoint_t *checkpoint) {
    struct stat locked;
    bool mine = true;

    for (int i = 0; mine && (i < TRIES); i++) {
        if (open_or_make(checkpoint)) {
            mine = lock_file(checkpoint);
            checkpoint->is_open = mine && is_in_place(checkpoint, &locked);
            if (checkpoint->is_open) {
                return true;
            }
            (void)close(checkpoint->lock);
        } else if (errno != ENOENT) {
            return report("%s: %s", checkpoint->path, strerror(errno));
        }
    }
    return report("%s: another hunt or soak is using it; wait until that one ends, or give another file",
                  checkpoint->path);
}

/** Whether it could be written. */
static bool may_save(const checkpoint_t *checkpoint, output_t *file) {
    struct stat existing;

    if ((stat(checkpoint->path, &existing) == 0) && !S_ISREG(existing.st_mode)) {
        return report("%s: not a %s checkpoint", checkpoint->path, checkpoint->kind);
    }
    const bool may = output_open(file, checkpoint->path);
    output_discard(file);
    return may;
}

bool checkpoint_open(checkpoint_t *checkpoint, output_t *file) {
    return (checkpoint->path == NULL) ||
           (identify_program(checkpoint) && may_save(checkpoint, file) && open_locked(checkpoint));
}

void checkpoint_close(checkpoint_t *checkpoint) {
    struct stat locked;

    if (!checkpoint->is_open) {
        return;
    }
    if (checkpoint->is_made && is_in_place(checkpoint, &locked) && (locked.st_size == 0)) {
        (void)unlink(checkpoint->path);
    }
    (void)close(checkpoint->lock);
    checkpoint->is_open = false;
}

bool checkpoint_save(checkpoint_t *checkpoint, output_t *file, const checkpoint_part_t parts[], size_t count) {
    const head_t head = head_of(checkpoint, parts, count);
    const uint32_t checksum = checksum_of(parts, count);

    if (checkpoint->path == NULL) {
        return true;
    }
    if (!output_open(file, checkpoint->path)) {
        return false;
    }
    /* The new file is locked before it replaces the old one. The lock lasts until its last descriptor is closed. */
    const int new_lock = fcntl(file->fd, F_DUPFD_CLOEXEC, 0);
    (void)flock(new_lock, LOCK_EX | LOCK_NB);
    (void)output_write(file, &head, sizeof head);
    for (size_t i = 0; i < count; i++) {
        (void)output_write(file, parts[i].bytes, parts[i].size);
    }
    (void)output_write(file, &checksum, sizeof checksum);
    const bool saved = output_commit(file);
    (void)close(saved ? checkpoint->lock : new_lock);
    checkpoint->lock = saved ? new_lock : checkpoint->lock;
    return saved;
}

/** The magic without its number: a file that begins otherwise is something else. */
static bool is_kind(const checkpoint_t *checkpoint, const head_t *head, size_t size) {
    char begin[sizeof head->magic];
    const int length = snprintf(begin, sizeof begin, "agv %s ", checkpoint->kind);
    return (length > 0) && (size >= (size_t)length) && (memcmp(head, begin, (size_t)length) == 0);
}

/** Whether a header is the expected one. The size of the parts is that of the program. */
static bool check_head(const checkpoint_t *checkpoint, const head_t *head, size_t size, const head_t *expected) {
    const char *path = checkpoint->path;
    const char *kind = checkpoint->kind;

    if (!is_kind(checkpoint, head, size)) {
        return report("%s: not a %s checkpoint", path, kind);
    }
    if (size < sizeof *head) {
        return report(DAMAGED, path);
    }
    if ((memcmp(head->magic, expected->magic, sizeof head->magic) != 0) || (head->program != expected->program)) {
        return report(
            "%s: the checkpoint of another build of host_sim; go on with that one, or remove it to start over", path);
    }
    if (memcmp(head->numbers, expected->numbers, sizeof head->numbers) != 0) {
        return report("%s: the checkpoint of another %s; remove it to start over", path, kind);
    }
    return (head->size == expected->size) || report(DAMAGED, path);
}

static bool read_all(const checkpoint_t *checkpoint, const checkpoint_part_t parts[], size_t count, FILE *stream) {
    const head_t expected = head_of(checkpoint, parts, count);
    uint32_t checksum = 0;
    head_t head;

    const size_t size = fread(&head, 1, sizeof head, stream);
    if (!check_head(checkpoint, &head, size, &expected)) {
        return false;
    }
    bool whole = size == sizeof head;
    for (size_t i = 0; whole && (i < count); i++) {
        whole = fread(parts[i].bytes, parts[i].size, 1, stream) == 1;
    }
    whole = whole && (fread(&checksum, sizeof checksum, 1, stream) == 1) && (fgetc(stream) == EOF);
    return (whole && (checksum == checksum_of(parts, count))) || report(DAMAGED, checkpoint->path);
}

/** Whether nothing was saved: its file was made just now, or by a run that was killed before it saved. */
static bool is_empty(const checkpoint_t *checkpoint) {
    struct stat locked;
    return (fstat(checkpoint->lock, &locked) == 0) && (locked.st_size == 0);
}

bool checkpoint_load(const checkpoint_t *checkpoint, const checkpoint_part_t parts[], size_t count, bool *loaded) {
    *loaded = false;
    if ((checkpoint->path == NULL) || is_empty(checkpoint)) {
        return true;
    }
    FILE *stream = fopen(checkpoint->path, "rb");
    if (stream == NULL) {
        return report("%s: %s", checkpoint->path, strerror(errno));
    }
    *loaded = read_all(checkpoint, parts, count, stream);
    (void)fclose(stream);
    return *loaded;
}

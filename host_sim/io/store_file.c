#include "io/store_file.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "agv/checksum.h"
#include "common/report.h"
#include "text/hex.h"

#define FILE_SIZE_MAX 1048576u
#define FIRST_WORD "agv-store "
#define FIRST_LINE FIRST_WORD "1\n"
#define LATCH "latch "
#define RECORD "record "
#define RECORDER "recorder "
#define CHECK "check "

/* Bytes that no latch record is: neither its size nor its checksum fits. */
enum { DAMAGED_LATCH_SIZE = HAL_STORE_LATCH_SIZE_MAX, DAMAGED_BYTE = 0xA5 };

/** Read what is there, FILE_SIZE_MAX at most. @return its size; -1: reported. */
static ssize_t read_up_to_limit(int fd, const char *path, char *text) {
    size_t size = 0;
    while (size < FILE_SIZE_MAX) {
        ssize_t count = read(fd, &text[size], FILE_SIZE_MAX - size);
        if (count < 0) {
            (void)report("%s: %s", path, strerror(errno));
            return -1;
        }
        if (count == 0) {
            break;
        }
        size += (size_t)count;
    }
    return (ssize_t)size;
}

/** Read hexadecimal bytes in capital letters, as they are written here. @return how many; 0: none, or damaged */
static size_t read_hex(const char *text, size_t length, uint8_t *bytes, size_t most) {
    for (size_t i = 0; i < length; i++) {
        if (islower((unsigned char)text[i]) != 0) {
            return 0;
        }
    }
    return hex_bytes(text, length, bytes, most);
}

/** The rest of a line that begins with a word; NULL: it begins with another. */
static const char *after(const char *line, size_t length, const char *word) {
    size_t size = strlen(word);
    return ((length > size) && (memcmp(line, word, size) == 0)) ? &line[size] : NULL;
}

/** Take one line. @return false: damaged. */
static bool take_line(const char *line, size_t length, sim_store_t *store, agv_recorder_t *recorder) {
    const char *text = after(line, length, LATCH);
    if (text != NULL) {
        store->latch_size = (uint8_t)read_hex(text, length - (size_t)(text - line), store->latch, sizeof store->latch);
        return store->latch_size > 0;
    }
    text = after(line, length, RECORD);
    if (text != NULL) {
        uint8_t record[SIM_STORE_RECORD_SIZE_MAX];
        size_t size = read_hex(text, length - (size_t)(text - line), record, sizeof record);
        return (size > 0) && sim_store_append(store, record, size);
    }
    text = after(line, length, RECORDER);
    if (text != NULL) {
        uint8_t *image = (uint8_t *)recorder;
        bool fits = read_hex(text, length - (size_t)(text - line), image, sizeof *recorder) == sizeof *recorder;
        if (!fits) {
            (void)memset(recorder, 0, sizeof *recorder);
        }
        return fits;
    }
    return false;
}

/** Whether a line is the checksum over the text before it. */
static bool is_check(const char *line, size_t length, const char *text) {
    char expected[32];
    uint32_t checksum = ~agv_crc32(AGV_CRC32_START, text, (size_t)(line - text));
    int size = snprintf(expected, sizeof expected, CHECK "%08" PRIX32, checksum);
    return ((size_t)size == length) && (memcmp(line, expected, length) == 0);
}

/** Take all lines. @return false: damaged. */
static bool take_text(const char *text, size_t size, sim_store_t *store, agv_recorder_t *recorder) {
    bool whole = (size > strlen(FIRST_LINE)) && (memcmp(text, FIRST_LINE, strlen(FIRST_LINE)) == 0);
    const char *line = whole ? &text[strlen(FIRST_LINE)] : text;
    bool checked = false;
    while (line < &text[size]) {
        size_t left = (size_t)(&text[size] - line);
        const char *end = memchr(line, '\n', left);
        size_t length = (end != NULL) ? (size_t)(end - line) : left;
        whole = whole && !checked && (end != NULL);
        checked = is_check(line, length, text);
        if (!checked && !take_line(line, length, store, recorder)) {
            whole = false;
        }
        line = (end != NULL) ? &end[1] : &text[size];
    }
    return whole && checked;
}

static void clear(sim_store_t *store, agv_recorder_t *recorder) {
    sim_store_init(store);
    store->keep_latch = true; /* the supervisor reads it after any reset, and decides itself what it means */
    (void)memset(recorder, 0, sizeof *recorder);
}

bool store_file_is(const char *text, size_t size) {
    return (size >= strlen(FIRST_WORD)) && (memcmp(text, FIRST_WORD, strlen(FIRST_WORD)) == 0);
}

bool store_file_may_replace(const char *path) {
    struct stat about;
    if ((stat(path, &about) != 0) || !S_ISREG(about.st_mode)) {
        return true;
    }
    char begin[sizeof FIRST_WORD - 1];
    FILE *stream = fopen(path, "rb");
    const size_t size = (stream != NULL) ? fread(begin, 1, sizeof begin, stream) : 0;
    if (stream != NULL) {
        (void)fclose(stream);
    }
    return (memcmp(begin, FIRST_WORD, size) == 0) ||
           report("%s: not a store file (it does not begin with '" FIRST_WORD "'), so it is not overwritten; "
                  "give a store or a new file",
                  path);
}

void store_file_take(const char *text, size_t size, sim_store_t *store, agv_recorder_t *recorder) {
    clear(store, recorder);
    if (!take_text(text, size, store, recorder)) {
        (void)memset(store->latch, DAMAGED_BYTE, sizeof store->latch);
        store->latch_size = DAMAGED_LATCH_SIZE;
    }
}

bool store_file_load(const char *path, sim_store_t *store, agv_recorder_t *recorder) {
    clear(store, recorder);
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        return (errno == ENOENT) ? true : report("%s: %s", path, strerror(errno));
    }
    char *text = malloc(FILE_SIZE_MAX);
    ssize_t size = -1;
    if (text == NULL) {
        (void)report("%s: out of memory", path);
    } else {
        size = read_up_to_limit(fd, path, text);
    }
    (void)close(fd);
    if (size >= 0) {
        store_file_take(text, (size_t)size, store, recorder);
    }
    free(text);
    return size >= 0;
}

static void put_summed(output_t *output, uint32_t *checksum, const char *text, size_t length) {
    *checksum = agv_crc32(*checksum, text, length);
    (void)output_write(output, text, length);
}

static void put_item(output_t *output, uint32_t *checksum, const char *word, const uint8_t *bytes, size_t size) {
    put_summed(output, checksum, word, strlen(word));
    for (size_t i = 0; i < size; i++) {
        const char pair[2] = {HEX_DIGITS[bytes[i] >> 4], HEX_DIGITS[bytes[i] & 0xFu]};
        put_summed(output, checksum, pair, sizeof pair);
    }
    put_summed(output, checksum, "\n", 1);
}

void store_file_save(output_t *output, const sim_store_t *store, const agv_recorder_t *recorder) {
    uint32_t checksum = AGV_CRC32_START;
    put_summed(output, &checksum, FIRST_LINE, strlen(FIRST_LINE));
    if (store->latch_size > 0) {
        put_item(output, &checksum, LATCH, store->latch, store->latch_size);
    }
    for (uint32_t i = 0; i < store->count; i++) {
        uint8_t record[SIM_STORE_RECORD_SIZE_MAX];
        size_t size = sim_store_read_record(store, i, record, sizeof record);
        put_item(output, &checksum, RECORD, record, size);
    }
    put_item(output, &checksum, RECORDER, (const uint8_t *)recorder, sizeof *recorder);
    char check[32];
    int length = snprintf(check, sizeof check, CHECK "%08" PRIX32 "\n", ~checksum);
    (void)output_write(output, check, (size_t)length);
}

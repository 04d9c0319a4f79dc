/*
 * The reader of logs of any format. A log is refused in one line, or its frames are possible ones; the same log compressed
 * with gzip gives the same frames. Byte 1, bit 0: bad lines are skipped; then the log.
 */
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "capture.h"
#include "input.h"
#include "logs/candump_log.h"

/* What reading a log came to. */
typedef struct {
    candump_result_t end;
    uint64_t frames;
    uint64_t skipped;
    uint32_t sum; /* of times and frames */
} outcome_t;

/* @return what is wrong with a frame; NULL: nothing */
static const char *wrong_with(const candump_record_t *record) {
    const hal_can_frame_t *frame = &record->frame;
    const bool is_standard = (frame->flags & (HAL_CAN_EXTENDED | HAL_CAN_ERROR)) == 0;
    const uint32_t longest = ((frame->flags & HAL_CAN_FD) != 0) ? 64 : 8;
    if ((frame->id > (is_standard ? 0x7FFu : 0x1FFFFFFFu)) || (frame->length > longest)) {
        return "a frame that no bus has";
    }
    const bool has_name = (record->interface_length > 0) && (record->interface_length <= CANDUMP_INTERFACE_MAX);
    return has_name ? NULL : "an interface without a name";
}

static uint32_t add(uint32_t sum, const void *bytes, size_t size) {
    return (uint32_t)crc32(sum, bytes, (uInt)size);
}

/* An ASC log may lack its header. That is noted in a line, before anything else. */
static const char *without_note(const char *printed) {
    static const char note[] = " before the first frame: read as hexadecimal with absolute time stamps\n";
    const char *const found = strstr(printed, note);
    return ((found == NULL) || (found > strchr(printed, '\n'))) ? printed : found + strlen(note);
}

/* A compressed log that is cut off is read up to there with --skip-bad-lines. That is noted in a line, and a second one says
 * that its last line is left out. */
static bool is_note_of_cut(const char *printed) {
    static const char cut[] = ": the gzip file is cut off; read up to there\n";
    static const char left_out[] = ": the last line may be cut off; it is left out\n";
    const char *const first = strstr(printed, cut);
    if ((first == NULL) || (strchr(printed, '\n') != first + strlen(cut) - 1)) {
        return false;
    }
    const char *const next = first + strlen(cut);
    const char *const second = strstr(next, left_out);
    return (*next == '\0') || ((second != NULL) && (strchr(next, '\n') == second + strlen(left_out) - 1) &&
                               (second[strlen(left_out)] == '\0'));
}

static outcome_t read_log(const uint8_t *bytes, size_t size, bool skip) {
    candump_log_t *log = calloc(1, sizeof *log);
    candump_record_t record;
    outcome_t outcome = {.end = CANDUMP_FAILED};
    const char *wrong = NULL;
    capture_begin();
    if (candump_open(log, capture_file(bytes, size), skip)) {
        outcome.end = candump_next(log, &record);
        for (; outcome.end == CANDUMP_RECORD; outcome.end = candump_next(log, &record)) {
            wrong = (wrong == NULL) ? wrong_with(&record) : wrong;
            outcome.frames++;
            outcome.sum = add(outcome.sum, &record.stamp_us, sizeof record.stamp_us);
            outcome.sum = add(outcome.sum, record.frame.data, sizeof record.frame.data);
            outcome.sum = add(outcome.sum, record.interface, record.interface_length);
        }
    }
    outcome.skipped = log->skipped;
    candump_close(log);
    free(log);
    const char *printed = without_note(capture_end());
    if (wrong != NULL) {
        capture_fail(wrong, printed);
    }
    if (outcome.end == CANDUMP_FAILED) {
        capture_one_line(printed);
    } else if ((printed[0] != '\0') && !(skip && is_note_of_cut(printed))) {
        capture_fail("read to its end, and something was printed", printed);
    } else {
        /* as it should be */
    }
    return outcome;
}

/* Compress. @return the bytes, to be freed */
static uint8_t *pack(const uint8_t *bytes, size_t size, size_t *packed_size) {
    z_stream stream = {0};
    (void)deflateInit2(&stream, 1, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    const uLong most = deflateBound(&stream, (uLong)size);
    uint8_t *packed = malloc(most);
    uint8_t *copy = malloc(size + 1);
    memcpy(copy, bytes, size);
    stream.next_in = copy;
    stream.avail_in = (uInt)size;
    stream.next_out = packed;
    stream.avail_out = (uInt)most;
    (void)deflate(&stream, Z_FINISH);
    *packed_size = stream.total_out;
    (void)deflateEnd(&stream);
    free(copy);
    return packed;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    input_t input = {.at = data, .left = size};
    const bool skip = (input_byte(&input) & 1) != 0;
    const outcome_t plain = read_log(input.at, input.left, skip);
    const bool is_packed = (input.left >= 3) && (memcmp(input.at, "\x1F\x8B\x08", 3) == 0);
    if (is_packed) {
        return 0; /* compressed twice is not read */
    }
    size_t packed_size = 0;
    uint8_t *packed = pack(input.at, input.left, &packed_size);
    const outcome_t unpacked = read_log(packed, packed_size, skip);
    free(packed);
    if ((unpacked.end != plain.end) || (unpacked.frames != plain.frames) || (unpacked.sum != plain.sum) ||
        (unpacked.skipped != plain.skipped)) {
        capture_fail("compressed it is another log", "");
    }
    return 0;
}

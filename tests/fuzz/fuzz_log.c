/*
 * The reader of candump logs (of the other formats: fuzz_formats.c). A frame comes first, which tells the format. Two regular expressions, written from the page of the format, decide which lines are
 * frames. Every other line that is not blank is refused with its number (byte 1 even), or skipped and counted (odd). A
 * classic frame is written and read again.
 */
#include <limits.h>
#include <regex.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "capture.h"
#include "input.h"
#include "logs/candump_log.h"

#define HEX "[0-9A-Fa-f]"
#define BYTES8 "(" HEX HEX "){8}"
/* Classic and remote frames, or FD frames. Error frames have bit 29 of the identifier set, and are neither remote nor
 * FD. */
#define DATA "((" HEX HEX "){0,7}|" BYTES8 "(_[9A-Fa-f])?)"
#define REMOTE "R([0-7]|8(_[9A-Fa-f])?)?"
#define FD "#" HEX "(" HEX HEX "){0,64}"
#define FRAME "([0-7]" HEX HEX "|[01]" HEX HEX HEX HEX HEX HEX HEX ")#(" DATA "|" REMOTE "|" FD ")"
#define ERROR "[23]" HEX HEX HEX HEX HEX HEX HEX "#" DATA
#define LINE "^\\([0-9]{1,12}\\.([0-9]{6}|[0-9]{9})\\) +[!-~]{1,15} (" FRAME "|" ERROR ")( [RT])?\r?$"

enum { LINE_MAX_CHARACTERS = 255 };

static candump_log_t *log_file;
static regex_t grammar;

static void prepare(void) {
    if (log_file == NULL) {
        log_file = malloc(sizeof *log_file);
        if ((log_file == NULL) || (regcomp(&grammar, LINE, REG_EXTENDED | REG_NOSUB) != 0)) {
            capture_fail("regcomp", LINE);
        }
    }
}

static bool is_blank(const char *line, size_t length) {
    for (size_t i = 0; i < length; i++) {
        if ((line[i] != ' ') && (line[i] != '\t') && (line[i] != '\r')) {
            return false;
        }
    }
    return true;
}

/* 'f': a frame, 'b': blank, 'x': any other line. */
static char kind_of(const char *line, size_t length) {
    char text[LINE_MAX_CHARACTERS + 1];
    if (length > LINE_MAX_CHARACTERS) {
        return 'x';
    }
    if (is_blank(line, length)) {
        return 'b';
    }
    if (memchr(line, '\0', length) != NULL) {
        return 'x';
    }
    memcpy(text, line, length);
    text[length] = '\0';
    return (regexec(&grammar, text, 0, NULL, 0) == 0) ? 'f' : 'x';
}

static void check_record(const candump_record_t *record) {
    const hal_can_frame_t *frame = &record->frame;
    const bool is_long = (frame->flags & HAL_CAN_FD) != 0;
    const bool is_standard = (frame->flags & (HAL_CAN_EXTENDED | HAL_CAN_ERROR)) == 0;
    if ((frame->id > (is_standard ? 0x7FFu : 0x1FFFFFFFu)) || (frame->length > (is_long ? 64u : 8u))) {
        capture_fail("a frame that no bus has", log_file->name);
    }
    for (unsigned i = ((frame->flags & HAL_CAN_REMOTE) != 0) ? 0 : frame->length; i < 8; i++) {
        if (frame->data[i] != 0) {
            capture_fail("bytes beyond the length of a frame", log_file->name);
        }
    }
}

/* Only classic data frames, because candump_write() writes no others. */
static void write_and_read(const candump_record_t *record) {
    char interface[CANDUMP_INTERFACE_MAX + 1] = {0};
    char *line = malloc(CANDUMP_WRITE_MAX);
    candump_record_t again;
    if ((record->frame.flags & (uint8_t)~HAL_CAN_EXTENDED) == 0) {
        memcpy(interface, record->interface, record->interface_length);
        const size_t length = candump_write(line, record->stamp_us, interface, &record->frame);
        if ((length > CANDUMP_WRITE_MAX) || (line[length - 1] != '\n')) {
            capture_fail("written without an end", interface);
        }
        if ((candump_parse(line, length - 1, &again) != NULL) || (again.stamp_us != record->stamp_us) ||
            (memcmp(&again.frame, &record->frame, sizeof again.frame) != 0) ||
            (again.interface_length != record->interface_length)) {
            capture_fail("written and read it is another frame", interface);
        }
    }
    free(line);
}

/* Check the reader's result for a line that is not blank. @return whether the reader continues */
static bool check_line(char kind, size_t number, bool skip) {
    candump_record_t record;
    const uint64_t skipped = log_file->skipped;
    if (kind == 'x') {
        return skip;
    }
    const candump_result_t result = candump_next(log_file, &record);
    if ((result != CANDUMP_RECORD) || (log_file->line != number) || (log_file->skipped < skipped)) {
        capture_fail("a frame was not read", log_file->name);
    }
    check_record(&record);
    write_and_read(&record);
    return true;
}

/* Compare text and reader line by line. @return number of the line that ends the reading; 0: none */
static size_t walk(const char *text, size_t size, bool skip, uint64_t *bad) {
    size_t number = 0;
    for (size_t at = 0; at < size;) {
        const char *end = memchr(&text[at], '\n', size - at);
        const size_t length = (end != NULL) ? (size_t)(end - &text[at]) : (size - at);
        const char kind = kind_of(&text[at], length);
        number++;
        at += length + 1;
        *bad += (kind == 'x') ? 1 : 0;
        if ((kind != 'b') && !check_line(kind, number, skip)) {
            return number;
        }
    }
    return 0;
}

/* What is left of the input, behind a line that tells the format, and with an end of its last line: one that may be cut off
 * is left out, which test_candump_log tests. Valid until the next call. */
static const char *with_first_line(const input_t *input, size_t *length) {
    static const char first[] = "(1700000000.000000) can0 43F#\n";
    static char *text;
    *length = sizeof first + input->left;
    text = realloc(text, *length);
    memcpy(text, first, sizeof first - 1);
    memcpy(&text[sizeof first - 1], input->at, input->left);
    text[*length - 1] = '\n';
    return text;
}

/* Whether the time stamps ever jump 100 days ahead, which ends the reading: test_candump_log tests that. */
static bool has_jump(const char *text, size_t size) {
    enum { LONGEST_S = 100 * 24 * 3600 };
    unsigned long long newest_s = ULLONG_MAX - LONGEST_S;
    for (size_t at = 0; at < size;) {
        const char *end = memchr(&text[at], '\n', size - at);
        const size_t length = (end != NULL) ? (size_t)(end - &text[at]) : (size - at);
        if (kind_of(&text[at], length) == 'f') {
            const unsigned long long now_s = strtoull(&text[at + 1], NULL, 10);
            if (now_s >= newest_s + LONGEST_S) {
                return true;
            }
            newest_s = ((at == 0) || (now_s > newest_s)) ? now_s : newest_s;
        }
        at += length + 1;
    }
    return false;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    input_t input = {.at = data, .left = size};
    const bool skip = (input_byte(&input) & 1) != 0;
    size_t length = 0;
    const char *text = with_first_line(&input, &length);
    prepare();
    if (has_jump(text, length)) {
        return 0;
    }
    const char *path = capture_file((const uint8_t *)text, length);
    uint64_t bad = 0;
    candump_record_t record;
    capture_begin();
    const bool opened = candump_open(log_file, path, skip);
    const size_t wrong = opened ? walk(text, length, skip, &bad) : 0;
    const candump_result_t last = candump_next(log_file, &record);
    candump_close(log_file);
    const char *printed = capture_end();
    if (!opened || (last != ((wrong != 0) ? CANDUMP_FAILED : CANDUMP_END))) {
        capture_fail("the log does not end where it ends", printed);
    }
    if (wrong != 0) {
        if (capture_line(printed, path, wrong) != wrong) {
            capture_fail("the wrong line is named", printed);
        }
    } else if ((printed[0] != '\0') || (log_file->skipped != bad)) {
        capture_fail("nothing was wrong, or it was counted wrongly", printed);
    } else {
        return 0;
    }
    return 0;
}

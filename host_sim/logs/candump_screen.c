#include "logs/candump_screen.h"

#include <stdbool.h>
#include <string.h>

#include "logs/log_token.h"
#include "text/civil.h"
#include "text/units.h"

enum { HEX = 16, DECIMAL = 10, ID_DIGITS = 3, LONG_ID_DIGITS = 8, DATA_MAX = 8, FD_DATA_MAX = 64, BYTE_MAX = 255 };
enum { DATE_LENGTH = 10, TIME_LENGTH = 8, FIRST_LINES = 200, BACKWARD_MAX = 40 };

#define LONG_ID_MAX 0x3FFFFFFFu

/** Read part of a word as a decimal number. */
static bool part(log_token_t token, size_t at, size_t length, uint32_t *number) {
    const log_token_t digits = {.at = &token.at[at], .length = length};
    return log_token_number(digits, DECIMAL, UINT32_MAX, number);
}

/** Read "2026-11-20" and "10:32:04.100000". */
static bool date_us(log_token_t date, log_token_t time, uint64_t *us) {
    civil_t civil;
    uint64_t seconds = 0;
    uint64_t fraction_us = 0;
    if ((date.length != DATE_LENGTH) || (time.length <= TIME_LENGTH) || (date.at[4] != '-') || (date.at[7] != '-') ||
        (time.at[2] != ':') || (time.at[5] != ':')) {
        return false;
    }
    const log_token_t fraction = {.at = &time.at[6], .length = time.length - 6};
    if (!part(date, 0, 4, &civil.year) || !part(date, 5, 2, &civil.month) || !part(date, 8, 2, &civil.day) ||
        !part(time, 0, 2, &civil.hour) || !part(time, 3, 2, &civil.minute) || !part(time, 6, 2, &civil.second) ||
        !log_token_seconds(fraction, &fraction_us) || !civil_seconds(&civil, &seconds)) {
        return false;
    }
    *us = (seconds * US_PER_S) + (fraction_us % US_PER_S);
    return true;
}

/** Read the time stamp, "(1700000000.000000)" or "(2026-11-20 10:32:04.100000)". */
static const char *parse_stamp(const char **cursor, const char *end, uint64_t *stamp_us) {
    const char *open = memchr(*cursor, '(', (size_t)(end - *cursor));
    const char *close = memchr(*cursor, ')', (size_t)(end - *cursor));
    if ((open == NULL) || (close == NULL) || (close < open)) {
        return "the line does not begin with a time stamp in parentheses";
    }
    const char *at = &open[1];
    const log_token_t first = log_token_next(&at, close);
    const log_token_t second = log_token_next(&at, close);
    *cursor = &close[1];
    const bool good = (second.length == 0) ? log_token_seconds(first, stamp_us) : date_us(first, second, stamp_us);
    return good ? NULL : "the time stamp is neither seconds nor a date and a time";
}

static const char *parse_interface(const char **cursor, const char *end, candump_record_t *record) {
    const log_token_t name = log_token_next(cursor, end);
    if (name.length == 0) {
        return "the interface name is missing, or nothing follows it";
    }
    record->interface = name.at;
    record->interface_length = name.length;
    return (name.length > CANDUMP_INTERFACE_MAX) ? "the interface name is longer than 15 characters" : NULL;
}

/** Read the identifier, behind the columns of -x if they are there. */
static const char *parse_id(const char **cursor, const char *end, hal_can_frame_t *frame) {
    log_token_t token = log_token_next(cursor, end);
    if (log_token_is(token, "RX") || log_token_is(token, "TX")) {
        (void)log_token_next(cursor, end);
        (void)log_token_next(cursor, end);
        token = log_token_next(cursor, end);
    }
    uint32_t id = 0;
    if (!log_token_number(token, HEX, LONG_ID_MAX, &id) ||
        ((token.length != ID_DIGITS) && (token.length != LONG_ID_DIGITS))) {
        return "an identifier of 3 or 8 hexadecimal digits is missing";
    }
    if (token.length == ID_DIGITS) {
        frame->id = id;
        return (id <= CANDUMP_ID_MAX) ? NULL : "the identifier is above 7FF";
    }
    const bool is_error = (id & CANDUMP_ERROR_FLAG) != 0;
    frame->flags = is_error ? HAL_CAN_ERROR : HAL_CAN_EXTENDED;
    frame->id = id & ~CANDUMP_ERROR_FLAG;
    return NULL;
}

/** Read the length, "[8]" or, of CAN FD, "[08]". */
static const char *parse_length(const char **cursor, const char *end, hal_can_frame_t *frame) {
    const log_token_t token = log_token_next(cursor, end);
    const bool is_bracketed = (token.length >= 3) && (token.length <= 4) &&
                              (((token.at[0] == '[') && (token.at[token.length - 1] == ']')) ||
                               ((token.at[0] == '{') && (token.at[token.length - 1] == '}')));
    uint32_t length = 0;
    if (!is_bracketed || !part(token, 1, token.length - 2, &length) || (length > FD_DATA_MAX)) {
        return "the length in brackets is missing";
    }
    const bool is_fd = (token.at[0] == '[') && (token.length > 3);
    frame->flags |= is_fd ? HAL_CAN_FD : 0;
    frame->length = (uint8_t)((!is_fd && (length > DATA_MAX)) ? (uint32_t)DATA_MAX : length);
    return NULL;
}

/** What may follow the data: nothing, "ERRORFRAME", the text of -a. */
static const char *parse_rest(const char *at, const char *end) {
    const log_token_t token = log_token_next(&at, end);
    const bool is_text = (token.length > 0) && (token.at[0] == '\'');
    return ((token.length == 0) || is_text || log_token_is(token, "ERRORFRAME")) ? NULL
                                                                                 : "unexpected text after the frame";
}

static const char *parse_data(const char *at, const char *end, hal_can_frame_t *frame) {
    const char *rest = at;
    if (log_token_is(log_token_next(&rest, end), "remote")) {
        frame->flags |= HAL_CAN_REMOTE;
        return log_token_is(log_token_next(&rest, end), "request") ? parse_rest(rest, end) : "the data is not readable";
    }
    for (uint32_t i = 0; i < frame->length; i++) {
        const log_token_t token = log_token_next(&at, end);
        uint32_t byte = 0;
        if ((token.length != 2) || !log_token_number(token, HEX, BYTE_MAX, &byte)) {
            return "the data is shorter than its length says";
        }
        if (i < DATA_MAX) {
            frame->data[i] = (uint8_t)byte;
        }
    }
    return parse_rest(at, end);
}

/** Time stamps that keep going backwards are differences. */
static const char *check_order(candump_screen_t *screen, uint64_t stamp_us) {
    if (screen->lines < FIRST_LINES) {
        screen->lines++;
        screen->backward += (stamp_us < screen->last_us) ? 1 : 0;
        screen->last_us = stamp_us;
    }
    return (screen->backward > BACKWARD_MAX)
               ? "the time stamps are differences (candump -t d): record it with candump -t a or candump -l"
               : NULL;
}

const char *candump_screen_parse(candump_screen_t *screen, const char *line, size_t length, candump_record_t *record) {
    if (line[0] == '\t') {
        return LOG_NO_FRAME;
    }
    const char *at = line;
    const char *end = &line[length];
    (void)memset(&record->frame, 0, sizeof record->frame);
    const char *wrong = parse_stamp(&at, end, &record->stamp_us);
    if (wrong == NULL) {
        wrong = parse_interface(&at, end, record);
    }
    if (wrong == NULL) {
        wrong = parse_id(&at, end, &record->frame);
    }
    if (wrong == NULL) {
        wrong = parse_length(&at, end, &record->frame);
    }
    if (wrong == NULL) {
        wrong = parse_data(at, end, &record->frame);
    }
    return (wrong == NULL) ? check_order(screen, record->stamp_us) : wrong;
}

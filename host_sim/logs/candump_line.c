#include "logs/candump_line.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "text/hex.h"
#include "text/units.h"

/*
 * Every scan stops at the line feed after the line: it belongs to no class of characters below, so no scan needs a
 * bound.
 */

#define SECONDS_DIGITS_MAX 12u
#define DATA_MAX 8u
#define FD_DATA_MAX 64u

const char LOG_NO_FRAME[] = "no frame";

static inline bool is_decimal(char character) {
    return (character >= '0') && (character <= '9');
}

static const char *parse_fraction(const char **cursor, uint64_t *us) {
    const char *at = *cursor;
    uint32_t value = 0;
    uint32_t count = 0;
    for (; is_decimal(*at); at++) {
        value = (count < 6) ? ((value * 10) + (uint32_t)(*at - '0')) : value;
        count++;
    }
    if ((count != 6) && (count != 9)) {
        return "the time stamp has neither 6 nor 9 decimals";
    }
    *us = value;
    *cursor = at;
    return NULL;
}

static const char *parse_stamp(const char **cursor, uint64_t *stamp_us) {
    const char *at = *cursor;
    if (*at != '(') {
        return "the line does not begin with a time stamp in parentheses";
    }
    at++;
    const char *seconds_at = at;
    uint64_t seconds = 0;
    for (; is_decimal(*at) && ((size_t)(at - seconds_at) < SECONDS_DIGITS_MAX); at++) {
        seconds = (seconds * 10) + (uint64_t)(*at - '0');
    }
    if ((at == seconds_at) || (*at != '.')) {
        return "the time stamp is not a number of seconds with decimals";
    }
    at++;
    uint64_t us = 0;
    const char *wrong = parse_fraction(&at, &us);
    if (wrong != NULL) {
        return wrong;
    }
    if ((at[0] != ')') || (at[1] != ' ')) {
        return "the time stamp is not closed by a parenthesis and a blank";
    }
    *stamp_us = (seconds * (uint64_t)US_PER_S) + us;
    *cursor = &at[2];
    return NULL;
}

static const char *parse_interface(const char **cursor, candump_record_t *record) {
    const char *at = *cursor;
    while (*at == ' ') {
        at++;
    }
    record->interface = at;
    while ((*at > ' ') && (*at < 0x7F)) {
        at++;
    }
    record->interface_length = (size_t)(at - record->interface);
    if ((record->interface_length == 0) || (*at != ' ')) {
        return "the interface name is missing, or nothing follows it";
    }
    if (record->interface_length > CANDUMP_INTERFACE_MAX) {
        return "the interface name is longer than 15 characters";
    }
    *cursor = &at[1];
    return NULL;
}

static const char *parse_id(const char **cursor, hal_can_frame_t *frame) {
    const char *at = *cursor;
    uint32_t id = 0;
    size_t count = 0;
    for (uint32_t value = hex_digit(*at); (value < HEX_NO_DIGIT) && (count < 9); value = hex_digit(*at)) {
        id = (id << 4) | value;
        count++;
        at++;
    }
    if (*at != '#') {
        return "a hexadecimal identifier followed by # is missing";
    }
    *cursor = &at[1];
    if (count == 3) {
        frame->id = id;
        return (id <= CANDUMP_ID_MAX) ? NULL : "the identifier is above 7FF";
    }
    if (count != 8) {
        return (count == 5) ? "CAN XL frames are not supported" : "the identifier has neither 3 nor 8 digits";
    }
    bool is_error = (id & CANDUMP_ERROR_FLAG) != 0;
    frame->flags = is_error ? HAL_CAN_ERROR : HAL_CAN_EXTENDED;
    frame->id = is_error ? (id & ~CANDUMP_ERROR_FLAG) : id;
    return (frame->id <= CANDUMP_EXTENDED_ID_MAX) ? NULL : "the identifier is above 1FFFFFFF";
}

/** Skip a raw DLC, "_9" to "_F". */
static void skip_raw_dlc(const char **cursor) {
    const char *at = *cursor;
    if (at[0] == '_') {
        uint32_t dlc = hex_digit(at[1]);
        *cursor = ((dlc > DATA_MAX) && (dlc < HEX_NO_DIGIT)) ? &at[2] : at;
    }
}

static void parse_remote(const char **cursor, hal_can_frame_t *frame) {
    frame->flags |= HAL_CAN_REMOTE;
    uint32_t length = hex_digit(**cursor);
    if (length <= DATA_MAX) {
        frame->length = (uint8_t)length;
        (*cursor)++;
    }
    if (frame->length == DATA_MAX) {
        skip_raw_dlc(cursor);
    }
}

static const char *parse_data(const char **cursor, hal_can_frame_t *frame, uint32_t most) {
    const char *at = *cursor;
    uint32_t length = 0;
    for (;;) {
        uint32_t high = hex_digit(at[0]);
        if (high >= HEX_NO_DIGIT) {
            break;
        }
        uint32_t low = hex_digit(at[1]);
        if (low >= HEX_NO_DIGIT) {
            return (at[1] > ' ') ? "the data is not hexadecimal" : "the data has an odd number of digits";
        }
        if (length >= most) {
            return (most == DATA_MAX) ? "the data is longer than 8 bytes" : "the data is longer than 64 bytes";
        }
        if (length < DATA_MAX) {
            frame->data[length] = (uint8_t)((high << 4) | low);
        }
        length++;
        at += 2;
    }
    frame->length = (uint8_t)length;
    *cursor = at;
    return NULL;
}

static const char *parse_payload(const char **cursor, hal_can_frame_t *frame) {
    const char *at = *cursor;
    if ((*at == 'R') && ((frame->flags & HAL_CAN_ERROR) == 0)) {
        (*cursor)++;
        parse_remote(cursor, frame);
        return NULL;
    }
    if (*at != '#') {
        const char *wrong = parse_data(cursor, frame, DATA_MAX);
        if ((wrong == NULL) && (frame->length == DATA_MAX)) {
            skip_raw_dlc(cursor);
        }
        return wrong;
    }
    if ((frame->flags & HAL_CAN_ERROR) != 0) {
        return "an error frame is not CAN FD";
    }
    if (hex_digit(at[1]) >= HEX_NO_DIGIT) {
        return "the flags of a CAN FD frame are missing";
    }
    frame->flags |= HAL_CAN_FD;
    *cursor = &at[2];
    return parse_data(cursor, frame, FD_DATA_MAX);
}

bool candump_is_from(const candump_record_t *record, const char *interface) {
    return (interface != NULL) && (strlen(interface) == record->interface_length) &&
           (memcmp(record->interface, interface, record->interface_length) == 0);
}

const char *candump_id_text(char text[CANDUMP_ID_SIZE], uint32_t id, uint8_t flags) {
    const bool is_error = (flags & HAL_CAN_ERROR) != 0;
    const bool is_long = is_error || ((flags & HAL_CAN_EXTENDED) != 0);
    (void)snprintf(text, CANDUMP_ID_SIZE, "%0*" PRIX32, is_long ? 8 : 3, id | (is_error ? CANDUMP_ERROR_FLAG : 0));
    return text;
}

const char *candump_parse(const char *line, size_t length, candump_record_t *record) {
    const char *at = line;
    (void)memset(&record->frame, 0, sizeof record->frame);
    const char *wrong = parse_stamp(&at, &record->stamp_us);
    if (wrong == NULL) {
        wrong = parse_interface(&at, record);
    }
    if (wrong == NULL) {
        wrong = parse_id(&at, &record->frame);
    }
    if (wrong == NULL) {
        wrong = parse_payload(&at, &record->frame);
    }
    if (wrong != NULL) {
        return wrong;
    }
    if ((at[0] == ' ') && ((at[1] == 'R') || (at[1] == 'T'))) {
        at += 2;
    }
    at += (*at == '\r') ? 1 : 0;
    return (at == &line[length]) ? NULL : "unexpected text after the frame";
}

static char *put_decimal(char *to, uint64_t value, uint32_t least_digits) {
    char digits[20];
    uint32_t count = 0;
    do {
        digits[count] = (char)('0' + (char)(value % 10));
        value /= 10;
        count++;
    } while (value != 0);
    while (count < least_digits) {
        digits[count] = '0';
        count++;
    }
    while (count > 0) {
        count--;
        *to = digits[count];
        to++;
    }
    return to;
}

static char *put_hex(char *to, uint32_t value, uint32_t digits) {
    for (uint32_t left = digits; left > 0; left--) {
        *to = HEX_DIGITS[(value >> (4 * (left - 1))) & 0xFu];
        to++;
    }
    return to;
}

size_t candump_write(char *line, uint64_t stamp_us, const char *interface, const hal_can_frame_t *frame) {
    char *to = line;
    *to++ = '(';
    to = put_decimal(to, stamp_us / US_PER_S, 10);
    *to++ = '.';
    to = put_decimal(to, stamp_us % US_PER_S, 6);
    *to++ = ')';
    *to++ = ' ';
    size_t length = strlen(interface);
    (void)memcpy(to, interface, length);
    to += length;
    *to++ = ' ';
    to = put_hex(to, frame->id, ((frame->flags & HAL_CAN_EXTENDED) != 0) ? 8 : 3);
    *to++ = '#';
    for (uint32_t i = 0; (i < frame->length) && (i < DATA_MAX); i++) {
        to = put_hex(to, frame->data[i], 2);
    }
    *to++ = '\n';
    return (size_t)(to - line);
}

#include "logs/vector_asc.h"

#include <stdio.h>
#include <string.h>

#include "text/civil.h"
#include "text/units.h"

enum { HEX = 16, DECIMAL = 10, DATA_MAX = 8, FD_DATA_MAX = 64, BYTE_MAX = 255, CHANNEL_MAX = 255, DLC_MAX = 15 };
enum { MONTHS = 12, MONTH_LENGTH = 3, NOON = 12, CONTROLLER_STATE_AT = 1 };

/** The rest of a line. */
typedef struct {
    const char *at;
    const char *end;
} rest_t;

static log_token_t next(rest_t *rest) {
    return log_token_next(&rest->at, rest->end);
}

static log_token_t peek(const rest_t *rest) {
    rest_t copy = *rest;
    return next(&copy);
}

/** The number of a month, from its first letters in English or German; 0: none. */
static uint32_t month_of(log_token_t token) {
    static const char names[MONTHS][2][MONTH_LENGTH + 1] = {
        {"Jan", "Jan"}, {"Feb", "Feb"}, {"Mar", "Mrz"}, {"Apr", "Apr"}, {"May", "Mai"}, {"Jun", "Jun"},
        {"Jul", "Jul"}, {"Aug", "Aug"}, {"Sep", "Sep"}, {"Oct", "Okt"}, {"Nov", "Nov"}, {"Dec", "Dez"}};
    for (uint32_t i = 0; i < MONTHS; i++) {
        if (log_token_begins(token, names[i][0]) || log_token_begins(token, names[i][1])) {
            return i + 1;
        }
    }
    const bool is_maerz = (token.length >= 3) && (token.at[0] == 'M') && ((token.at[1] & '\x80') != 0);
    return is_maerz ? 3 : 0;
}

/** Read "10:32:04" or "10:32:04.100". */
static bool time_of_day(log_token_t token, civil_t *civil, uint64_t *fraction_us) {
    const char *first = memchr(token.at, ':', token.length);
    const char *end = &token.at[token.length];
    const char *second = (first != NULL) ? memchr(&first[1], ':', (size_t)(end - &first[1])) : NULL;
    if (second == NULL) {
        return false;
    }
    const log_token_t hour = {.at = token.at, .length = (size_t)(first - token.at)};
    const log_token_t minute = {.at = &first[1], .length = (size_t)(second - &first[1])};
    const log_token_t rest = {.at = &second[1], .length = (size_t)(end - &second[1])};
    uint64_t us = 0;
    const bool good = log_token_number(hour, DECIMAL, BYTE_MAX, &civil->hour) &&
                      log_token_number(minute, DECIMAL, BYTE_MAX, &civil->minute) && log_token_seconds(rest, &us);
    civil->second = (uint32_t)(us / US_PER_S);
    *fraction_us = us % US_PER_S;
    return good && (us / US_PER_S <= BYTE_MAX);
}

/** Read "Fri Nov 20 10:32:04.100 am 2026"; what is no date leaves @p date_us as it is. */
static void take_date(rest_t rest, uint64_t *date_us) {
    civil_t civil = {0};
    uint64_t fraction_us = 0;
    uint64_t seconds = 0;
    (void)next(&rest); /* the day of the week */
    civil.month = month_of(next(&rest));
    bool good = log_token_number(next(&rest), DECIMAL, BYTE_MAX, &civil.day);
    good = good && time_of_day(next(&rest), &civil, &fraction_us);
    log_token_t token = next(&rest);
    const bool is_pm = log_token_is(token, "pm");
    if (is_pm || log_token_is(token, "am")) {
        civil.hour = (civil.hour % NOON) + (is_pm ? (uint32_t)NOON : 0);
        token = next(&rest);
    }
    if (good && log_token_number(token, DECIMAL, UINT16_MAX, &civil.year) && civil_seconds(&civil, &seconds)) {
        *date_us = (seconds * US_PER_S) + fraction_us;
    }
}

/** Read "hex  timestamps absolute". @return LOG_NO_FRAME; or what is wrong */
static const char *take_base(vector_asc_t *asc, rest_t rest) {
    const log_token_t base = next(&rest);
    asc->is_decimal = log_token_is(base, "dec");
    if (!asc->is_decimal && !log_token_is(base, "hex")) {
        return "the base is neither hex nor dec";
    }
    asc->has_base = true;
    if (log_token_is(next(&rest), "timestamps")) {
        const log_token_t kind = next(&rest);
        asc->is_relative = log_token_is(kind, "relative");
        return (asc->is_relative || log_token_is(kind, "absolute")) ? LOG_NO_FRAME
                                                                    : "timestamps are neither absolute nor relative";
    }
    return LOG_NO_FRAME;
}

/** The lines that have no time stamp. */
typedef enum { LINE_DATE, LINE_BLOCK, LINE_BASE, LINE_OTHER, LINE_UNKNOWN } header_t;

static header_t header_of(log_token_t first, log_token_t second) {
    static const struct {
        const char *first;
        const char *second; /**< NULL: any */
        header_t header;
    } headers[] = {{"date", NULL, LINE_DATE},      {"base", NULL, LINE_BASE},   {"no", "internal", LINE_OTHER},
                   {"internal", NULL, LINE_OTHER}, {"Begin", NULL, LINE_BLOCK}, {"End", NULL, LINE_OTHER},
                   {"previous", "log", LINE_OTHER}};
    for (size_t i = 0; i < sizeof headers / sizeof headers[0]; i++) {
        if (log_token_is(first, headers[i].first) &&
            ((headers[i].second == NULL) || log_token_is(second, headers[i].second))) {
            return headers[i].header;
        }
    }
    return log_token_begins(first, "//") ? LINE_OTHER : LINE_UNKNOWN;
}

bool vector_asc_begins(const char *line, size_t length) {
    rest_t rest = {.at = line, .end = &line[length]};
    const log_token_t first = next(&rest);
    const log_token_t second = next(&rest);
    const log_token_t third = next(&rest);
    uint64_t us = 0;
    uint32_t channel = 0;
    if (header_of(first, second) != LINE_UNKNOWN) {
        return !log_token_is(first, "date") || (month_of(third) != 0);
    }
    const bool is_stamped = log_token_seconds(first, &us) && (memchr(first.at, '.', first.length) != NULL);
    return is_stamped && (log_token_number(second, DECIMAL, CHANNEL_MAX, &channel) || log_token_is(second, "CANFD") ||
                          log_token_is(second, "Start"));
}

static const char *take_channel(vector_asc_t *asc, log_token_t token, candump_record_t *record) {
    uint32_t channel = 0;
    if (!log_token_number(token, DECIMAL, CHANNEL_MAX, &channel) || (channel == 0)) {
        return "the channel is not a number from 1 to 255";
    }
    record->interface = asc->interface;
    record->interface_length = (size_t)snprintf(asc->interface, sizeof asc->interface, "can%u", channel - 1);
    return NULL;
}

static const char *take_id(const vector_asc_t *asc, log_token_t token, hal_can_frame_t *frame) {
    const uint32_t base = asc->is_decimal ? DECIMAL : HEX;
    const bool is_extended = (token.length > 1) && (token.at[token.length - 1] == 'x');
    token.length -= is_extended ? 1 : 0;
    if (!log_token_number(token, base, CANDUMP_EXTENDED_ID_MAX, &frame->id)) {
        return "the identifier is not a number: symbolic names cannot be read";
    }
    frame->flags |= is_extended ? HAL_CAN_EXTENDED : 0;
    return (is_extended || (frame->id <= CANDUMP_ID_MAX)) ? NULL : "the identifier is above 7FF";
}

static const char *take_bytes(const vector_asc_t *asc, rest_t *rest, hal_can_frame_t *frame) {
    const uint32_t base = asc->is_decimal ? DECIMAL : HEX;
    for (uint32_t i = 0; i < frame->length; i++) {
        uint32_t byte = 0;
        if (!log_token_number(next(rest), base, BYTE_MAX, &byte)) {
            return "the data is shorter than its length says";
        }
        if (i < DATA_MAX) {
            frame->data[i] = (uint8_t)byte;
        }
    }
    return NULL;
}

/** Read what follows the direction of a classic frame: "d 8 00 11 ...", "r", "r 8". */
static const char *take_classic(const vector_asc_t *asc, rest_t *rest, hal_can_frame_t *frame) {
    const log_token_t kind = next(rest);
    const bool is_remote = log_token_is(kind, "r");
    if (!is_remote && !log_token_is(kind, "d")) {
        return "neither a data nor a remote frame (d, r)";
    }
    uint32_t dlc = 0;
    const bool has_dlc = log_token_number(peek(rest), HEX, DLC_MAX, &dlc);
    if (has_dlc) {
        (void)next(rest);
    } else if (!is_remote) {
        return "the length of the data is missing";
    }
    frame->flags |= is_remote ? HAL_CAN_REMOTE : 0;
    frame->length = (uint8_t)((dlc > DATA_MAX) ? (uint32_t)DATA_MAX : dlc);
    if (is_remote) {
        return NULL;
    }
    const char *wrong = take_bytes(asc, rest, frame);
    uint32_t byte = 0;
    const bool has_more = (wrong == NULL) && (peek(rest).length <= 2) &&
                          log_token_number(peek(rest), asc->is_decimal ? DECIMAL : HEX, BYTE_MAX, &byte);
    return has_more ? "the data is longer than its length says" : wrong;
}

static bool is_bit(log_token_t token) {
    return (token.length == 1) && ((token.at[0] == '0') || (token.at[0] == '1'));
}

/** Read what follows the identifier of a CANFD line: "[name] BRS ESI DLC length 00 11 ... duration length flags ...". */
static const char *take_fd(const vector_asc_t *asc, rest_t *rest, hal_can_frame_t *frame) {
    static const uint32_t fd_format = 0x1000u;
    if (!is_bit(peek(rest))) {
        (void)next(rest); /* the message's name */
    }
    uint32_t dlc = 0;
    uint32_t length = 0;
    const log_token_t rate_switch = next(rest);
    const log_token_t error_state = next(rest);
    if (!is_bit(rate_switch) || !is_bit(error_state) || !log_token_number(next(rest), HEX, DLC_MAX, &dlc) ||
        !log_token_number(next(rest), DECIMAL, FD_DATA_MAX, &length)) {
        return "bit rate switch, error state, DLC and length of a CANFD line are missing";
    }
    frame->length = (uint8_t)length;
    const char *wrong = take_bytes(asc, rest, frame);
    uint32_t flags = 0;
    (void)next(rest); /* duration */
    (void)next(rest); /* number of bits */
    const bool has_flags = log_token_number(next(rest), HEX, UINT32_MAX - 1, &flags);
    const bool is_fd = !has_flags || ((flags & fd_format) != 0) || (length > DATA_MAX);
    const bool is_remote = !is_fd && (length == 0) && (dlc > 0);
    frame->flags |= is_fd ? HAL_CAN_FD : 0;
    frame->flags |= is_remote ? HAL_CAN_REMOTE : 0;
    return wrong;
}

static const char *take_error(hal_can_frame_t *frame, uint32_t class, uint8_t controller) {
    frame->flags = HAL_CAN_ERROR;
    frame->id = class;
    frame->length = DATA_MAX;
    frame->data[CONTROLLER_STATE_AT] = controller;
    return NULL;
}

/** "1  43F  Rx  d 8 ...", "1  ErrorFrame", or another event of a channel. */
static const char *take_channel_event(vector_asc_t *asc, log_token_t channel, rest_t *rest, candump_record_t *record) {
    const log_token_t id = next(rest);
    const log_token_t direction = next(rest);
    if (log_token_is(id, "ErrorFrame")) {
        (void)take_error(&record->frame, CANDUMP_ERROR_PROTOCOL, 0);
        return take_channel(asc, channel, record);
    }
    if (log_token_is(direction, "TxRq") || ((id.length > 0) && (id.at[id.length - 1] == ':'))) {
        return LOG_NO_FRAME;
    }
    if (!log_token_is(direction, "Rx") && !log_token_is(direction, "Tx")) {
        uint32_t number = 0;
        const bool is_cut =
            (direction.length < 2) && ((id.length == 0) || log_token_number(id, HEX, CANDUMP_EXTENDED_ID_MAX, &number));
        return is_cut ? "the frame is cut off" : LOG_NO_FRAME;
    }
    const char *wrong = take_channel(asc, channel, record);
    wrong = (wrong == NULL) ? take_id(asc, id, &record->frame) : wrong;
    return (wrong == NULL) ? take_classic(asc, rest, &record->frame) : wrong;
}

/** "CANFD   1 Rx  123  1 0 9 12 ...". */
static const char *take_fd_event(vector_asc_t *asc, rest_t *rest, candump_record_t *record) {
    const char *wrong = take_channel(asc, next(rest), record);
    const log_token_t direction = next(rest);
    const log_token_t id = next(rest);
    if (wrong != NULL) {
        return wrong;
    }
    if (log_token_is(direction, "TxRq")) {
        return LOG_NO_FRAME;
    }
    if (log_token_is(id, "ErrorFrame")) {
        return take_error(&record->frame, CANDUMP_ERROR_PROTOCOL, 0);
    }
    wrong = take_id(asc, id, &record->frame);
    return (wrong == NULL) ? take_fd(asc, rest, &record->frame) : wrong;
}

/** "CAN 1 Status:chip status error passive": as the error frame that SocketCAN makes of it. */
static const char *take_status(vector_asc_t *asc, rest_t *rest, candump_record_t *record) {
    static const struct {
        const char *first;
        const char *second;
        uint32_t class;
        uint8_t controller;
    } states[] = {{"bus", "off", CANDUMP_ERROR_BUS_OFF, 0},
                  {"busoff", "", CANDUMP_ERROR_BUS_OFF, 0},
                  {"error", "passive", CANDUMP_ERROR_CONTROLLER, CANDUMP_CONTROLLER_PASSIVE},
                  {"warning", "", CANDUMP_ERROR_CONTROLLER, CANDUMP_CONTROLLER_WARNING},
                  {"error", "active", CANDUMP_ERROR_CONTROLLER | CANDUMP_ERROR_RESTARTED, CANDUMP_CONTROLLER_ACTIVE}};
    const log_token_t channel = next(rest);
    if (!log_token_begins(next(rest), "Status:") || (take_channel(asc, channel, record) != NULL)) {
        return LOG_NO_FRAME;
    }
    for (log_token_t token = next(rest); token.length > 0; token = next(rest)) {
        for (size_t i = 0; i < sizeof states / sizeof states[0]; i++) {
            if (log_token_is(token, states[i].first) && log_token_begins(peek(rest), states[i].second)) {
                return take_error(&record->frame, states[i].class, states[i].controller);
            }
        }
    }
    return LOG_NO_FRAME;
}

static const char *take_header(vector_asc_t *asc, log_token_t first, rest_t *rest) {
    switch (header_of(first, peek(rest))) {
    case LINE_DATE:
        take_date(*rest, &asc->start_us);
        return LOG_NO_FRAME;
    case LINE_BLOCK:
        (void)next(rest); /* "Triggerblock" */
        take_date(*rest, &asc->block_us);
        return LOG_NO_FRAME;
    case LINE_BASE:
        return take_base(asc, *rest);
    case LINE_OTHER:
        return LOG_NO_FRAME;
    default:
        return "not a line of an ASC log";
    }
}

const char *vector_asc_parse(vector_asc_t *asc, const char *line, size_t length, candump_record_t *record) {
    rest_t rest = {.at = line, .end = &line[length]};
    const log_token_t first = next(&rest);
    uint64_t us = 0;
    if (!log_token_seconds(first, &us)) {
        return take_header(asc, first, &rest);
    }
    (void)memset(&record->frame, 0, sizeof record->frame);
    const uint64_t at_us = asc->is_relative ? (asc->last_us + us) : us;
    record->stamp_us = asc->start_us + at_us;
    if (!asc->is_relative || (us <= CANDUMP_GAP_MAX_US)) {
        asc->last_us = at_us; /* a line with a wild stamp does not shift those behind it */
    }
    const log_token_t kind = next(&rest);
    uint32_t channel = 0;
    if (log_token_is(kind, "CANFD")) {
        return take_fd_event(asc, &rest, record);
    }
    if (log_token_is(kind, "CAN")) {
        return take_status(asc, &rest, record);
    }
    if (log_token_is(kind, "Start") && (us == 0) && (asc->block_us != 0)) {
        asc->start_us = asc->block_us;
    }
    if (log_token_number(kind, DECIMAL, CHANNEL_MAX, &channel)) {
        return take_channel_event(asc, kind, &rest, record);
    }
    return (kind.length > 0) ? LOG_NO_FRAME : "the line is cut off behind its time stamp";
}

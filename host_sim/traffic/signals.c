#include "traffic/signals.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "agv/codec.h"
#include "agv/names.h"
#include "agv/state.h"

enum { BITS_PER_BYTE = 8, NO_REASON = 0xFF, DECIMAL = 10, PAGE_AT = 2, PAGE_SHIFT = 4, ANY_PAGE = 0xFF };

/** A raw value with its word. */
typedef struct {
    uint32_t raw;
    const char *word;
} word_row_t;

static const word_row_t on_words[] = {{0, "off"}, {1, "on"}, {0, NULL}};
static const word_row_t off_words[] = {{0, "on"}, {1, "off"}, {0, NULL}};
static const word_row_t yes_words[] = {{0, "no"}, {1, "yes"}, {0, NULL}};
static const word_row_t gear_words[] = {
    {AGV_GEAR_P, "P"}, {AGV_GEAR_R, "R"}, {AGV_GEAR_N, "N"}, {AGV_GEAR_D, "D"}, {0, NULL}};
static const word_row_t mode_words[] = {{0, "none"}, {1, "manual"}, {2, "autopilot"}, {3, "both"}, {0, NULL}};
static const word_row_t eps_mode_words[] = {{AGV_EPS_MODE_ASSIST, "assist"}, {AGV_EPS_MODE_ANGLE, "angle"},
                                            {AGV_EPS_MODE_SPEED, "speed"},   {AGV_EPS_MODE_TORQUE, "torque"},
                                            {AGV_EPS_MODE_OFF, "off"},       {0, NULL}};
static const word_row_t output_words[] = {{0, "open"}, {1, "closed"}, {0, NULL}};
static const word_row_t no_words[] = {{0, NULL}};
static const word_row_t state_words[] = {{0, NULL}};  /* agv_state_name() knows them */
static const word_row_t reason_words[] = {{0, NULL}}; /* agv_fault_name() knows them */

/** How the raw value lies in the payload. */
typedef enum {
    LAYOUT_NUMBER,
    LAYOUT_SIGNED,
    LAYOUT_BIG,
    LAYOUT_CHOICE,
    LAYOUT_FLAG,
    LAYOUT_ALARM,
    LAYOUT_COUNTER,
    LAYOUT_HEX
} layout_t;

static const signal_kind_t kinds[] = {
    [LAYOUT_NUMBER] = SIGNAL_NUMBER,   [LAYOUT_SIGNED] = SIGNAL_NUMBER, [LAYOUT_BIG] = SIGNAL_NUMBER,
    [LAYOUT_CHOICE] = SIGNAL_CHOICE,   [LAYOUT_FLAG] = SIGNAL_FLAG,     [LAYOUT_ALARM] = SIGNAL_ALARM,
    [LAYOUT_COUNTER] = SIGNAL_COUNTER, [LAYOUT_HEX] = SIGNAL_HEX,
};

/** A row of signals.def. */
typedef struct {
    uint32_t message;
    const char *name;
    layout_t layout;
    uint8_t at;
    uint8_t bits;
    int32_t factor;
    int32_t offset;
    uint8_t decimals;
    const char *unit;
    uint32_t highest;
    const word_row_t *words;
    uint8_t page; /**< ANY_PAGE, or the page of the status frame that has it */
} row_t;

static const row_t rows[] = {
#define SIGNAL(message, name, kind, at, bits, factor, offset, decimals, unit, highest, words)                          \
    {(uint32_t)(message), #name, LAYOUT_##kind, at, bits, factor, offset, decimals, unit, highest, words, ANY_PAGE},
#define PAGED(message, name, kind, at, bits, page)                                                                     \
    {(uint32_t)(message), #name, LAYOUT_##kind, at, bits, 1, 0, 0, "", UINT32_MAX, no_words, page},
#include "traffic/signals.def"
#undef SIGNAL
#undef PAGED
};

enum { ROWS = sizeof rows / sizeof rows[0] };

/** Where the rows of each message begin, and what is made from them; filled in once. */
static struct {
    bool made;
    size_t first[SIGNALS_MESSAGES];
    size_t count[SIGNALS_MESSAGES];
    signal_info_t infos[ROWS];
} table;

static void make_table(void) {
    if (table.made) {
        return;
    }
    for (size_t i = 0; i < ROWS; i++) {
        const row_t *row = &rows[i];
        const bool is_alarm = row->layout == LAYOUT_ALARM;
        table.first[row->message] = (table.count[row->message] == 0) ? i : table.first[row->message];
        table.count[row->message]++;
        table.infos[i] = (signal_info_t){.name = row->name,
                                         .unit = row->unit,
                                         .kind = kinds[row->layout],
                                         .decimals = row->decimals,
                                         .fault = is_alarm ? agv_fault_from_name(row->name) : AGV_FAULT_NONE};
    }
    table.made = true;
}

/** The index of a row; ROWS: there is no such signal. */
static size_t row_of(uint32_t message, size_t index) {
    make_table();
    const bool exists = (message < SIGNALS_MESSAGES) && (index < table.count[message]);
    return exists ? table.first[message] + index : (size_t)ROWS;
}

const char *signals_message_name(uint32_t message) {
    return (message == SIGNALS_STATUS_FRAME) ? "supervisor_status" : agv_message_name((agv_message_t)message);
}

size_t signals_count(uint32_t message) {
    make_table();
    return (message < SIGNALS_MESSAGES) ? table.count[message] : 0;
}

const signal_info_t *signals_info(uint32_t message, size_t index) {
    const size_t row = row_of(message, index);
    return (row < ROWS) ? &table.infos[row] : NULL;
}

static uint32_t raw_of(const row_t *row, const uint8_t data[AGV_DLC]) {
    const uint32_t first = (uint32_t)row->at / BITS_PER_BYTE;
    const uint32_t bytes = ((uint32_t)row->bits + BITS_PER_BYTE - 1) / BITS_PER_BYTE;
    uint32_t raw = 0;
    for (uint32_t i = 0; i < bytes; i++) {
        const uint32_t from = (row->layout == LAYOUT_BIG) ? i : bytes - 1 - i;
        raw = (raw << BITS_PER_BYTE) | data[first + from];
    }
    raw >>= (uint32_t)row->at % BITS_PER_BYTE;
    return (row->bits == 32) ? raw : (raw & ((1u << row->bits) - 1));
}

static const char *word_of(const row_t *row, uint32_t raw) {
    if (row->words == state_words) {
        return agv_state_name((agv_state_t)raw);
    }
    if (row->words == reason_words) {
        return (raw == NO_REASON) ? "none" : agv_fault_name((agv_fault_t)raw);
    }
    for (const word_row_t *word = row->words; word->word != NULL; word++) {
        if (word->raw == raw) {
            return word->word;
        }
    }
    return NULL;
}

static signal_value_t value_of(const row_t *row, uint32_t raw) {
    const bool is_signed = row->layout == LAYOUT_SIGNED;
    const int64_t number = is_signed ? (int64_t)(int32_t)raw : (int64_t)raw;
    const char *word = word_of(row, raw);
    return (signal_value_t){.raw = raw,
                            .scaled = (number * row->factor) + row->offset,
                            .word = word,
                            .present = true,
                            .valid = (is_signed || (raw <= row->highest)) &&
                                     ((row->layout != LAYOUT_CHOICE) || (word != NULL))};
}

bool signals_read(uint32_t message, size_t index, const uint8_t data[AGV_DLC], signal_value_t *value) {
    const size_t at = row_of(message, index);
    if (at == ROWS) {
        return false;
    }
    const row_t *row = &rows[at];
    const bool present = (row->page == ANY_PAGE) || (row->page == (data[PAGE_AT] >> PAGE_SHIFT));
    *value = present ? value_of(row, raw_of(row, data)) : (signal_value_t){.valid = true};
    return true;
}

void signals_mask(uint32_t message, uint8_t mask[AGV_DLC]) {
    (void)memset(mask, 0, AGV_DLC);
    for (size_t i = 0; i < signals_count(message); i++) {
        const row_t *row = &rows[row_of(message, i)];
        for (uint32_t bit = row->at; bit < (uint32_t)row->at + row->bits; bit++) {
            mask[bit / BITS_PER_BYTE] |= (uint8_t)(1u << (bit % BITS_PER_BYTE));
        }
    }
}

static int64_t power_of_ten(uint8_t decimals) {
    int64_t power = 1;
    for (uint8_t i = 0; i < decimals; i++) {
        power *= DECIMAL;
    }
    return power;
}

double signals_number(const signal_info_t *info, const signal_value_t *value) {
    return (double)value->scaled / (double)power_of_ten(info->decimals);
}

void signals_value_text(char text[SIGNALS_VALUE_SIZE], const signal_info_t *info, const signal_value_t *value) {
    const char *invalid = value->valid ? "" : " (invalid)";
    if (info->kind == SIGNAL_HEX) {
        (void)snprintf(text, SIGNALS_VALUE_SIZE, "%08" PRIX32, value->raw);
        return;
    }
    if (value->word != NULL) {
        (void)snprintf(text, SIGNALS_VALUE_SIZE, "%s%s", value->word, invalid);
        return;
    }
    (void)snprintf(text, SIGNALS_VALUE_SIZE, "%.*f%s%s%s", (int)info->decimals, signals_number(info, value),
                   (info->unit[0] != '\0') ? " " : "", info->unit, invalid);
}

void signals_raw_text(char text[SIGNALS_VALUE_SIZE], uint32_t message, size_t index, uint32_t raw) {
    const size_t row = row_of(message, index);
    text[0] = '\0';
    if (row < ROWS) {
        const signal_value_t value = value_of(&rows[row], raw);
        signals_value_text(text, &table.infos[row], &value);
    }
}

/** Whether a text about the payload names this signal. */
static bool is_shown(const signal_info_t *info, const signal_value_t *value) {
    if (!value->present) {
        return false;
    }
    if ((info->kind == SIGNAL_FLAG) && (value->word != NULL)) {
        return (strcmp(value->word, "no") != 0) && (strcmp(value->word, "off") != 0);
    }
    return (info->kind != SIGNAL_ALARM) || (value->raw != 0);
}

char *signals_print(char *text, size_t size, uint32_t message, const uint8_t data[AGV_DLC]) {
    size_t used = 0;
    signal_value_t value;
    text[0] = '\0';
    for (size_t i = 0; signals_read(message, i, data, &value); i++) {
        const signal_info_t *info = signals_info(message, i);
        if ((info == NULL) || !is_shown(info, &value)) {
            continue;
        }
        char part[SIGNALS_VALUE_SIZE + SIGNALS_VALUE_SIZE] = "";
        char number[SIGNALS_VALUE_SIZE] = "";
        const bool is_set = (info->kind == SIGNAL_FLAG) || ((info->kind == SIGNAL_ALARM) && (value.word != NULL));
        if (!is_set) {
            signals_value_text(number, info, &value);
        }
        const int length =
            snprintf(part, sizeof part, "%s%.40s%s%s", (used > 0) ? ", " : "", info->name, is_set ? "" : " ", number);
        if (used + (size_t)length < size) {
            (void)memcpy(&text[used], part, (size_t)length + 1);
            used += (size_t)length;
        }
    }
    return text;
}

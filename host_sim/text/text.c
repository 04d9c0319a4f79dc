#include "text/text.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

void text_clear(text_t *text) {
    text->used = 0;
    text->full = false;
    text->bytes[0] = '\0';
}

void text_add(text_t *text, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(&text->bytes[text->used], sizeof text->bytes - text->used, format, arguments);
    va_end(arguments);
    if ((length < 0) || ((size_t)length >= sizeof text->bytes - text->used)) {
        text->full = true;
        text->bytes[text->used] = '\0';
        return;
    }
    text->used += (size_t)length;
}

void text_add_count(text_t *text, const char *what, uint64_t count) {
    if (count > 0) {
        text_add(text, "%s%s: %" PRIu64, (text->used > 0) ? ", " : "", what, count);
    }
}

size_t text_character(const char *text, uint32_t *character) {
    static const struct {
        uint32_t mask; /**< of the first byte */
        uint32_t value;
        uint32_t lowest; /**< that is so long */
    } lengths[] = {{0x80u, 0x00u, 0}, {0xE0u, 0xC0u, 0x80u}, {0xF0u, 0xE0u, 0x800u}, {0xF8u, 0xF0u, 0x10000u}};
    const unsigned char *at = (const unsigned char *)text;
    size_t more = 0;
    while ((more < sizeof lengths / sizeof lengths[0]) && ((at[0] & lengths[more].mask) != lengths[more].value)) {
        more++;
    }
    if (more == sizeof lengths / sizeof lengths[0]) {
        return 0;
    }
    *character = at[0] & ~lengths[more].mask;
    for (size_t i = 1; i <= more; i++) {
        if ((at[i] & 0xC0u) != 0x80u) {
            return 0;
        }
        *character = (*character << 6) | (at[i] & 0x3Fu);
    }
    return (*character >= lengths[more].lowest) ? more + 1 : 0;
}

/** The length of a character that can be shown within a line; 0: it cannot. */
static size_t shown_length(const char *text) {
    static const struct {
        uint32_t first;
        uint32_t last;
    } hidden[] = {
        {0x00u, 0x1Fu},     {0x7Fu, 0x9Fu},     {0x2028u, 0x202Eu},      {0xD800u, 0xDFFFu},
        {0xFEFFu, 0xFEFFu}, {0xFFFEu, 0xFFFFu}, {0x110000u, UINT32_MAX},
    };
    uint32_t character = 0;
    const size_t length = text_character(text, &character);
    for (size_t i = 0; i < sizeof hidden / sizeof hidden[0]; i++) {
        if ((character >= hidden[i].first) && (character <= hidden[i].last)) {
            return 0;
        }
    }
    return length;
}

bool text_is_one_line(const char *text) {
    const char *at = text;
    for (size_t length = shown_length(at); length > 0; length = shown_length(at)) {
        at += length;
    }
    return *at == '\0';
}

void text_mask(char *text) {
    for (char *at = text; *at != '\0';) {
        const size_t length = shown_length(at);
        *at = (length > 0) ? *at : '?';
        at += (length > 0) ? length : 1;
    }
}

const char *text_one_line(text_t *copy, const char *from) {
    text_clear(copy);
    text_add(copy, "%s", from);
    text_mask(copy->bytes);
    return copy->bytes;
}

size_t text_break(const char *text, size_t room) {
    size_t length = room;
    while ((length > 0) && (text[length] != ' ')) {
        length--;
    }
    return (length > 0) ? length : room;
}

void text_print_from(int column, const char *text) {
    const size_t room = (size_t)(TEXT_COLUMNS - column);
    while (strlen(text) > room) {
        const size_t length = text_break(text, room);
        (void)printf("%.*s\n%*s", (int)length, text, column, "");
        text = &text[length + ((text[length] == ' ') ? 1 : 0)];
    }
    (void)printf("%s\n", text);
}

#include "text/text.h"

#include <stdarg.h>
#include <stdio.h>

void text_clear(text_t *text) {
    text->used = 0u;
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

size_t text_break(const char *text, size_t room) {
    size_t length = room;
    while ((length > 0u) && (text[length] != ' ')) {
        length--;
    }
    return (length > 0u) ? length : room;
}

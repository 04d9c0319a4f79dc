#include "common/json_build.h"

#include <stdlib.h>
#include <string.h>

void json_put(json_t *object, const char *key, json_t *value) {
    (void)json_object_set_new(object, key, value);
}

void json_add(json_t *array, json_t *value) {
    (void)json_array_append_new(array, value);
}

json_t *json_uint(uint64_t value) {
    return json_integer((json_int_t)value);
}

/** A text of any bytes: those above ASCII become `?`. */
static json_t *ascii_text(const char *text) {
    char *ascii = strdup(text);
    if (ascii == NULL) {
        return NULL;
    }
    for (char *at = ascii; *at != '\0'; at++) {
        *at = ((unsigned char)*at < 0x80u) ? *at : '?';
    }
    json_t *value = json_string(ascii);
    free(ascii);
    return value;
}

json_t *json_text(const char *text) {
    if (text == NULL) {
        return json_null();
    }
    json_t *value = json_string(text);
    return (value != NULL) ? value : ascii_text(text);
}

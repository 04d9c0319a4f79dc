#include "memory_output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "common/report.h"

enum { FILES_MAX = 4, NAME_SIZE = 16, FIRST_ROOM = 65536 };

/** A text; `name` is "" while its place is free. */
typedef struct {
    char name[NAME_SIZE];
    char *text;
    size_t size;
    size_t room;
} memory_file_t;

static memory_file_t files[FILES_MAX];

static memory_file_t *find(const char *name) {
    for (size_t i = 0u; i < (size_t)FILES_MAX; i++) {
        if (strcmp(files[i].name, name) == 0) {
            return &files[i];
        }
    }
    return NULL;
}

const char *memory_output_text(const char *name) {
    const memory_file_t *file = find(name);
    return (file != NULL) ? file->text : NULL;
}

bool output_open(output_t *output, const char *path) {
    memory_file_t *file = find(path);
    file = (file != NULL) ? file : find("");
    if ((file == NULL) || (strlen(path) >= sizeof file->name)) {
        return report("%s: no room for this output", path);
    }
    free(file->text);
    *file = (memory_file_t){.name = ""};
    (void)strcpy(file->name, path);
    output->name = path;
    output->fd = (int)(file - files);
    output->error = 0;
    output->used = 0u;
    output->is_open = true;
    return true;
}

/** Make room for more bytes, and for the zero at the end. */
static bool grow(memory_file_t *file, size_t size) {
    size_t room = (file->room > 0u) ? file->room : (size_t)FIRST_ROOM;
    while (room <= file->size + size) {
        room *= 2u;
    }
    if (room > file->room) {
        char *text = realloc(file->text, room);
        if (text == NULL) {
            return false;
        }
        file->text = text;
        file->room = room;
    }
    return true;
}

bool output_write(output_t *output, const void *bytes, size_t size) {
    memory_file_t *file = &files[output->fd];
    if ((output->error == 0) && !grow(file, size)) {
        output->error = ENOMEM;
    }
    if (output->error != 0) {
        return false;
    }
    (void)memcpy(&file->text[file->size], bytes, size);
    file->size += size;
    file->text[file->size] = '\0';
    return true;
}

bool output_flush(output_t *output) {
    return output->error == 0;
}

bool output_flush_all(output_t outputs[], size_t count) {
    bool good = true;
    for (size_t i = 0u; i < count; i++) {
        good = good && output_flush(&outputs[i]);
    }
    return good;
}

bool output_commit(output_t *output) {
    const bool was_open = output->is_open;
    output->is_open = false;
    return !was_open || (output->error == 0) || report("%s: %s", output->name, strerror(output->error));
}

bool output_commit_all(output_t outputs[], size_t count) {
    bool good = true;
    for (size_t i = 0u; i < count; i++) {
        good = output_commit(&outputs[i]) && good;
    }
    return good;
}

void output_discard(output_t *output) {
    output->is_open = false;
}

bool output_is_stdout(const char *path) {
    (void)path;
    return false; /* it is for the text for people */
}

bool output_put(output_t *output, const char *path, const void *bytes, size_t size) {
    return output_open(output, path) && output_write(output, bytes, size) && output_commit(output);
}

#include "io/output_json.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

void output_json(output_t *output, json_t *value, size_t flags) {
    char *text = (value != NULL) ? json_dumps(value, flags) : NULL;
    json_decref(value);
    if (text == NULL) {
        output->error = (output->error == 0) ? ENOMEM : output->error;
        return;
    }
    const size_t length = strlen(text);
    text[length] = '\n'; /* in the place of the terminating zero */
    (void)output_write(output, text, length + 1);
    free(text);
}

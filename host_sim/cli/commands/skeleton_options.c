#include "cli/commands/skeleton_options.h"

#include <string.h>

#include "skeleton/skeleton.h"

void skeleton_options_init(skeleton_options_t *from, option_t rows[SKELETON_OPTIONS]) {
    *from = (skeleton_options_t){.log = NULL};
    const option_t all[SKELETON_OPTIONS] = {
        OPTION_TEXT("--from", "LOG", "make a scenario that replays the first trip of a log, and run no FILE",
                    &from->log),
        OPTION_TEXT("-o", "FILE", "where to write it (standard output); a file that exists is not replaced",
                    &from->out),
        OPTION_TEXT("--ai-if", "NAME", "interface of the AI side; selects the gateway topology", &from->ai_interface),
        OPTION_FLAG("--skip-bad-lines", "skip lines of the log that are not frames", &from->skip_bad_lines),
    };
    (void)memcpy(rows, all, sizeof all);
}

bool skeleton_options_check(const skeleton_options_t *from) {
    const bool any = (from->out != NULL) || (from->ai_interface != NULL) || from->skip_bad_lines;
    return (from->log != NULL) || !any || report("-o, --ai-if and --skip-bad-lines need --from LOG");
}

status_t skeleton_options_run(const skeleton_options_t *from, config_options_t *config) {
    skeleton_request_t request = {
        .log = from->log, .out = from->out, .ai_interface = from->ai_interface, .skip_bad_lines = from->skip_bad_lines};
    config->has_ai_side = from->ai_interface != NULL;
    return config_options_make(config, &request.config) ? skeleton_make(&request) : STATUS_UNUSABLE;
}

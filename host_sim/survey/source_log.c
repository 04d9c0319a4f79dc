#include <stdio.h>
#include <stdlib.h>

#include "logs/candump_log.h"
#include "survey/sources.h"

static bool read_frames(const survey_request_t *request, candump_log_t *log, observation_t *observation,
                        source_t *source) {
    candump_record_t record;
    candump_result_t result = candump_next(log, &record);
    for (; result == CANDUMP_RECORD; result = candump_next(log, &record)) {
        const bool is_ai = candump_is_from(&record, request->ai_interface);
        source->has_ai_side = source->has_ai_side || is_ai;
        observation_interface(observation, record.interface, record.interface_length, is_ai);
        observation_frame(observation, is_ai ? HAL_CAN_AI : HAL_CAN_VEHICLE, &record.frame, record.stamp_us);
    }
    (void)snprintf(source->name, sizeof source->name, "%s", log->name);
    (void)snprintf(source->format, sizeof source->format, "%s", candump_format_name(log->format));
    source->skipped_lines = log->skipped;
    if ((result == CANDUMP_END) && (observation->frames == 0)) {
        return report("%s: contains no frame", log->name);
    }
    return result == CANDUMP_END;
}

bool source_log(const survey_request_t *request, observation_t *observation, source_t *source) {
    candump_log_t *log = calloc(1, sizeof *log);
    if (log == NULL) {
        return report("out of memory");
    }
    const bool good =
        candump_open(log, request->log, request->skip_bad_lines) && read_frames(request, log, observation, source);
    candump_close(log);
    free(log);
    if (good) {
        observation_end(observation, observation->last_us);
    }
    return good;
}

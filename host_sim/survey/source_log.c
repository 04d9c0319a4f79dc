#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "logs/candump_log.h"
#include "survey/sources.h"

static hal_can_side_t side_of(const survey_request_t *request, const candump_record_t *record) {
    const char *ai = request->ai_interface;
    const bool is_ai = (ai != NULL) && (strlen(ai) == record->interface_length) &&
                       (memcmp(record->interface, ai, record->interface_length) == 0);
    return is_ai ? HAL_CAN_AI : HAL_CAN_VEHICLE;
}

static bool read_frames(const survey_request_t *request, candump_log_t *log, observation_t *observation,
                        source_t *source) {
    candump_record_t record;
    candump_result_t result = candump_next(log, &record);
    for (; result == CANDUMP_RECORD; result = candump_next(log, &record)) {
        const hal_can_side_t side = side_of(request, &record);
        source->has_ai_side = source->has_ai_side || (side == HAL_CAN_AI);
        observation_interface(observation, record.interface, record.interface_length, side == HAL_CAN_AI);
        observation_frame(observation, side, &record.frame, record.stamp_us);
    }
    (void)snprintf(source->name, sizeof source->name, "%s", log->name);
    (void)snprintf(source->format, sizeof source->format, "%s", candump_format_name(log->format));
    source->skipped_lines = log->skipped;
    if ((result == CANDUMP_END) && (observation->frames == 0u)) {
        return report("%s: contains no frame", log->name);
    }
    return result == CANDUMP_END;
}

bool source_log(const survey_request_t *request, observation_t *observation, source_t *source) {
    candump_log_t *log = calloc(1u, sizeof *log);
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

#include "logs/sent_log.h"

#include <string.h>

#include "common/report.h"

static void write_line(sent_log_t *log, const sent_log_frame_t *sent) {
    char line[CANDUMP_WRITE_MAX];
    hal_can_frame_t frame = {.id = sent->id, .length = sent->length};
    (void)memcpy(frame.data, sent->data, sizeof frame.data);
    size_t length = candump_write(line, sent->stamp_us, log->interfaces[sent->side], &frame);
    (void)output_write(log->output, line, length);
}

static void write_waiting(sent_log_t *log) {
    for (size_t i = 0; i < log->waiting_count; i++) {
        write_line(log, &log->waiting[i]);
    }
    log->waiting_count = 0;
}

/** Whether the oldest waiting frame, and so every one behind it, has to go on waiting. */
static bool must_wait(const sent_log_t *log) {
    for (size_t i = 0; i < log->waiting_count; i++) {
        if (log->interfaces[log->waiting[i].side][0] == '\0') {
            return true;
        }
    }
    return false;
}

void sent_log_heard(sent_log_t *log, hal_can_side_t side, const char *interface, size_t length) {
    char *name = log->interfaces[side];
    if ((name[0] == '\0') && (length <= CANDUMP_INTERFACE_MAX)) {
        (void)memcpy(name, interface, length);
        name[length] = '\0';
        if (!must_wait(log)) {
            write_waiting(log);
        }
    }
}

/** Give every side without a name one that no other side has. */
static void name_interfaces(sent_log_t *log) {
    static const char *const made_up[HAL_CAN_SIDES] = {"can0", "can1"};
    for (uint32_t side = 0; side < HAL_CAN_SIDES; side++) {
        const char *other = log->interfaces[HAL_CAN_SIDES - 1 - side];
        const char *name = (strcmp(other, made_up[0]) == 0) ? made_up[1] : made_up[0];
        if (log->interfaces[side][0] == '\0') {
            note("no frame was received on the %s side: frames sent there are logged as %s",
                 (side == HAL_CAN_VEHICLE) ? "vehicle" : "AI", name);
            sent_log_heard(log, (hal_can_side_t)side, name, strlen(name));
        }
    }
}

void sent_log_add(sent_log_t *log, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t stamp_us) {
    if (log->output == NULL) {
        return;
    }
    sent_log_frame_t sent = {.stamp_us = stamp_us, .side = side, .id = (uint16_t)frame->id, .length = frame->length};
    (void)memcpy(sent.data, frame->data, sizeof sent.data);
    if (log->waiting_count == SENT_LOG_WAITING_MAX) {
        name_interfaces(log);
    }
    if ((log->waiting_count > 0) || (log->interfaces[side][0] == '\0')) {
        log->waiting[log->waiting_count] = sent;
        log->waiting_count++;
    } else {
        write_line(log, &sent);
    }
}

void sent_log_finish(sent_log_t *log) {
    if (log->waiting_count > 0) {
        name_interfaces(log);
    }
}

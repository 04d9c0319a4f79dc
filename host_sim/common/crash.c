#include "common/crash.h"

#include <inttypes.h>
#include <stdio.h>

#include "agv/names.h"

static uint32_t address_at(const uint8_t *bytes) {
    return (uint32_t)bytes[0] | ((uint32_t)bytes[1] << 8) | ((uint32_t)bytes[2] << 16) | ((uint32_t)bytes[3] << 24);
}

crash_addresses_t crash_addresses(const agv_event_t *event) {
    return (crash_addresses_t){.pc = address_at(&event->frames[0][0]), .lr = address_at(&event->frames[0][4])};
}

const char *crash_text(const agv_event_t *event, char text[CRASH_TEXT_SIZE]) {
    const char *cause = agv_reset_cause_name(event->a);
    const char *end = agv_end_name(event->b);
    const crash_addresses_t addresses = crash_addresses(event);
    if (cause == NULL) {
        cause = "unknown";
    }
    if (end == NULL) {
        (void)snprintf(text, CRASH_TEXT_SIZE, "reset by %s", cause);
    } else {
        (void)snprintf(text, CRASH_TEXT_SIZE, "reset by %s, %s, PC %08" PRIx32 ", LR %08" PRIx32, cause, end,
                       addresses.pc, addresses.lr);
    }
    return text;
}

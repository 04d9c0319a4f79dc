#include "agv/scheduler.h"

/* First periodic frame after all were sent at once: spread, so that they do not meet again. */
static const uint8_t first_ms[AGV_COMMAND_COUNT] = {100u, 66u, 33u, 25u};

static bool is_past(uint32_t now_ms, uint32_t moment_ms) {
    return (now_ms - moment_ms) <= (UINT32_MAX / 2u);
}

void agv_scheduler_restart(agv_scheduler_t *scheduler, uint32_t now_ms) {
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        scheduler->slots[i] = (agv_slot_t){.next_ms = now_ms + first_ms[i]};
    }
}

void agv_scheduler_restart_slot(agv_scheduler_t *scheduler, agv_message_t command, uint32_t now_ms) {
    scheduler->slots[command].next_ms = now_ms + agv_message_cycle_ms(command);
}

bool agv_scheduler_due(agv_scheduler_t *scheduler, agv_message_t command, uint32_t now_ms, uint32_t *skipped) {
    agv_slot_t *slot = &scheduler->slots[command];
    if (!is_past(now_ms, slot->next_ms)) {
        return false;
    }
    const uint32_t cycle_ms = agv_message_cycle_ms(command);
    const uint32_t missed = (now_ms - slot->next_ms) / cycle_ms;
    slot->next_ms += (missed + 1u) * cycle_ms;
    *skipped += missed;
    return true;
}

/* Once the gap is over it stays over: differences of wrapping microseconds are only taken while it is not. */
static bool is_too_soon(agv_slot_t *slot, uint32_t now_us, uint16_t gap_ms) {
    if ((now_us - slot->overridden_us) >= ((uint32_t)gap_ms * 1000u)) {
        slot->override_recent = false;
    }
    return slot->override_recent;
}

bool agv_scheduler_override(agv_scheduler_t *scheduler, agv_message_t command, uint32_t now_us, uint16_t gap_ms) {
    agv_slot_t *slot = &scheduler->slots[command];
    slot->override_waits = is_too_soon(slot, now_us, gap_ms);
    return !slot->override_waits;
}

bool agv_scheduler_override_due(agv_scheduler_t *scheduler, agv_message_t command, uint32_t now_us, uint16_t gap_ms) {
    agv_slot_t *slot = &scheduler->slots[command];
    return !is_too_soon(slot, now_us, gap_ms) && slot->override_waits;
}

void agv_scheduler_overridden(agv_scheduler_t *scheduler, agv_message_t command, uint32_t now_ms, uint32_t now_us) {
    agv_slot_t *slot = &scheduler->slots[command];
    slot->overridden_us = now_us;
    slot->override_recent = true;
    slot->override_waits = false;
    slot->next_ms = now_ms + (agv_message_cycle_ms(command) / 2u);
}

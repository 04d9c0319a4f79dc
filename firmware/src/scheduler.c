#include "agv/scheduler.h"

#include "agv/core.h"

/* First periodic frame after all were sent at once: spread, so that they do not meet again. */
static const uint8_t first_ms[AGV_COMMAND_COUNT] = {100u, 66u, 33u, 25u};

static agv_slot_t *slot_of(agv_core_t *core, agv_message_t command) {
    return &core->transmitter.scheduler.slots[command];
}

void agv_scheduler_restart(agv_core_t *core) {
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        agv_slot_t *const slot = &core->transmitter.scheduler.slots[i];
        slot->next_ms = core->now_ms + first_ms[i];
        slot->override_recent = false;
        slot->override_waits = false;
    }
}

void agv_scheduler_restart_slot(agv_core_t *core, agv_message_t command) {
    slot_of(core, command)->next_ms = core->now_ms + agv_message_cycle_ms(command);
}

uint32_t agv_scheduler_due(agv_core_t *core, agv_message_t command) {
    agv_slot_t *const slot = slot_of(core, command);
    const uint32_t late_ms = core->now_ms - slot->next_ms;
    if (late_ms > (UINT32_MAX / 2u)) {
        return 0u;
    }
    const uint32_t cycle_ms = agv_message_cycle_ms(command);
    const uint32_t slots = (late_ms / cycle_ms) + 1u;
    slot->next_ms += slots * cycle_ms;
    return slots;
}

/* Once the gap is over it stays over: differences of wrapping microseconds are only taken while it is not. */
static bool is_too_soon(const agv_core_t *core, agv_slot_t *slot) {
    if ((core->now_us - slot->overridden_us) >= (core->config.override_gap_ms * 1000u)) {
        slot->override_recent = false;
    }
    return slot->override_recent;
}

bool agv_scheduler_override_due(agv_core_t *core, agv_message_t command) {
    agv_slot_t *const slot = slot_of(core, command);
    return !is_too_soon(core, slot) && slot->override_waits;
}

bool agv_scheduler_override(agv_core_t *core, agv_message_t command) {
    slot_of(core, command)->override_waits = true;
    return agv_scheduler_override_due(core, command);
}

void agv_scheduler_overridden(agv_core_t *core, agv_message_t command) {
    agv_slot_t *const slot = slot_of(core, command);
    slot->next_ms = core->now_ms + (agv_message_cycle_ms(command) / 2u);
    slot->overridden_us = core->now_us;
    slot->override_recent = true;
    slot->override_waits = false;
}

#include "base/score.h"

/* Bits of a budget: half of 1 ms is still to be subtracted; the condition held at the last tick. */
enum { BUDGET_HALF = 1, BUDGET_HELD = 2 };

void agv_score_add(agv_score_t *score, bool bad, uint32_t frames) {
    const uint32_t full = 2u * frames;
    uint32_t value = score->value;
    if (bad) {
        value = ((value + 2u) < full) ? (value + 2u) : full;
    } else if ((value > 1u) && (frames > 1u)) {
        value--;
    } else {
        value = 0u;
    }
    score->value = (uint8_t)value;
    score->present = (value == full) || (score->present && (value != 0u));
}

void agv_budget_add(agv_budget_t *budget, bool condition, uint32_t elapsed_ms, uint32_t limit_ms) {
    uint32_t value_ms = budget->value_ms;
    uint32_t half = budget->bits & (uint32_t)BUDGET_HALF;
    if (elapsed_ms == 0u) {
        return;
    }
    if (agv_held_since_tick((budget->bits & (uint32_t)BUDGET_HELD) != 0u, condition, elapsed_ms)) {
        value_ms = (elapsed_ms < (limit_ms - value_ms)) ? (value_ms + elapsed_ms) : limit_ms;
    } else {
        const uint32_t down_ms = (elapsed_ms / 2u) + (elapsed_ms & half);
        half ^= elapsed_ms & (uint32_t)BUDGET_HALF;
        value_ms = (value_ms > down_ms) ? (value_ms - down_ms) : 0u;
    }
    if (value_ms == 0u) {
        half = 0u;
    }
    budget->bits = (uint8_t)(half | (condition ? (uint32_t)BUDGET_HELD : 0u));
    budget->value_ms = (uint16_t)value_ms;
    budget->present = (value_ms == limit_ms) || (budget->present && (value_ms != 0u));
}

void agv_budget_gather(agv_budget_t *budget, bool condition, uint32_t elapsed_ms, uint32_t limit_ms) {
    const agv_budget_t before = *budget;
    agv_budget_add(budget, condition, elapsed_ms, limit_ms);
    if (budget->value_ms < before.value_ms) {
        budget->value_ms = before.value_ms;
        budget->present = before.present;
    }
}

#include "base/score.h"

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
    if (condition) {
        value_ms = (elapsed_ms < (limit_ms - value_ms)) ? (value_ms + elapsed_ms) : limit_ms;
    } else {
        const uint32_t down_ms = (elapsed_ms / 2u) + (((elapsed_ms & 1u) != 0u) && budget->half ? 1u : 0u);
        budget->half = ((elapsed_ms & 1u) != 0u) != budget->half;
        value_ms = (value_ms > down_ms) ? (value_ms - down_ms) : 0u;
    }
    if (value_ms == 0u) {
        budget->half = false;
    }
    budget->value_ms = (uint16_t)value_ms;
    budget->present = (value_ms == limit_ms) || (budget->present && (value_ms != 0u));
}

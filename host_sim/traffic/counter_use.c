#include "traffic/counter_use.h"

#include <stdbool.h>

enum { STEP_MAX = 3 };

void counter_use_add(counter_use_t *use, uint8_t value, uint64_t t_us) {
    const uint8_t step = (uint8_t)(value - use->value);
    const bool is_first = use->frames == 0;
    use->value = value;
    use->frames++;
    if (is_first) {
        use->changed_us = t_us;
        return;
    }
    if (step == 0) {
        use->repeats++;
        if (t_us - use->changed_us > use->longest_us) {
            use->longest_us = t_us - use->changed_us;
            use->longest_at_us = use->changed_us;
        }
        return;
    }
    use->changed_us = t_us;
    if (step <= STEP_MAX) {
        use->steps++;
        return;
    }
    use->other_at_us = (use->other_steps == 0) ? t_us : use->other_at_us;
    use->other_steps++;
}

counter_kind_t counter_use_kind(const counter_use_t *use) {
    if (use->frames < COUNTER_USE_FRAMES_MIN) {
        return COUNTER_UNSEEN;
    }
    if (use->steps + use->other_steps == 0) {
        return COUNTER_STUCK;
    }
    return (use->other_steps == 0) ? COUNTER_INCREMENTS : COUNTER_ANY;
}

const char *counter_use_word(counter_kind_t kind) {
    static const char *const words[] = {[COUNTER_UNSEEN] = "unknown",
                                        [COUNTER_INCREMENTS] = "increments",
                                        [COUNTER_ANY] = "any",
                                        [COUNTER_STUCK] = "stuck"};
    return words[kind];
}

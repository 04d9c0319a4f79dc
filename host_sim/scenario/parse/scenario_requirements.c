#include "scenario/parse/scenario_requirements.h"

#include <string.h>

static const char *const ids[] = {
#include "requirement_ids.def"
};

const char *scenario_requirement(size_t index) {
    return (index < sizeof ids / sizeof ids[0]) ? ids[index] : NULL;
}

bool scenario_is_requirement(const char *id) {
    for (size_t i = 0; i < sizeof ids / sizeof ids[0]; i++) {
        if (strcmp(ids[i], id) == 0) {
            return true;
        }
    }
    return false;
}

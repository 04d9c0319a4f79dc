#include "campaign/fault_option.h"

#include <stdio.h>

#include "agv/names.h"
#include "common/report.h"
#include "text/suggest.h"

enum { NAME_SIZE = 40 };

const char *fault_option_names(void) {
    static char names[AGV_FAULT_COUNT * NAME_SIZE];
    size_t used = 0;
    for (uint32_t i = 0; i < AGV_FAULT_COUNT; i++) {
        const agv_fault_t fault = (agv_fault_t)i;
        if ((campaign_row(fault) != NULL) && (used < sizeof names)) {
            used += (size_t)snprintf(&names[used], sizeof names - used, "%s%s", (used > 0) ? "|" : "",
                                     agv_fault_name(fault));
        }
    }
    return names;
}

bool fault_option_take(const char *option, const char *name, const campaign_row_t **row) {
    if (name == NULL) {
        return true;
    }
    const agv_fault_t fault = agv_fault_from_name(name);
    if (fault == AGV_FAULT_NONE) {
        char meant[SUGGEST_SIZE];
        (void)suggest_from(fault_option_names(), name, meant);
        return report("%s: unknown fault '%s'%s", option, name,
                      (meant[0] != '\0') ? meant : "; docs/faults.md lists them");
    }
    *row = campaign_row(fault);
    return (*row != NULL) || report("%s: a campaign does not inject %s", option, name);
}

#include "cli/exit_status.h"

const exit_status_t EXIT_STATUSES[] = {
    {STATUS_OK, "It ran. A trip of the supervisor is no failure, unless --fail-on-trip is given."},
    {STATUS_UNMET, "It ran, and found a problem: an expectation that failed, a broken invariant, a hazard, or, with "
                   "--fail-on-trip, a trip or a run that was not supervised."},
    {STATUS_UNUSABLE, "It could not run, or stopped early. One line on standard error says why."},
};

const size_t EXIT_STATUS_COUNT = sizeof EXIT_STATUSES / sizeof EXIT_STATUSES[0];

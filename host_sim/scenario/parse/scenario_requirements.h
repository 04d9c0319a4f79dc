/**
 * @file scenario_requirements.h
 * The IDs that `shows` may name besides faults: the rows of docs/requirements.md and the decisions of docs/protocol.md,
 * from which the build takes them.
 */
#ifndef HOST_SIM_SCENARIO_REQUIREMENTS_H
#define HOST_SIM_SCENARIO_REQUIREMENTS_H

#include <stdbool.h>
#include <stddef.h>

/** An ID by its index: "SUP-1"; NULL: no more. */
const char *scenario_requirement(size_t index);

/** Whether there is a requirement with this ID. */
bool scenario_is_requirement(const char *id);

#endif

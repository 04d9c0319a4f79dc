/**
 * @file atlas_scenario.h
 * A case of the atlas as the text of a scenario.
 */
#ifndef HOST_SIM_ATLAS_SCENARIO_H
#define HOST_SIM_ATLAS_SCENARIO_H

#include "atlas/atlas_case.h"
#include "text/text.h"

/** When the first fault comes, in ms. */
uint32_t atlas_first_ms(atlas_state_t state);

/** Write it, without its expectations. Two faults that set one field to two values: the bits of both, or the later one. */
void atlas_scenario_write(text_t *text, const atlas_case_t *pair);

#endif

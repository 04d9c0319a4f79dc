/**
 * @file scenario_analysis.h
 * Feeds an analysis with a run on the simulated bus.
 */
#ifndef HOST_SIM_SCENARIO_ANALYSIS_H
#define HOST_SIM_SCENARIO_ANALYSIS_H

#include "analysis/analysis.h"
#include "scenario/scenario_testbed.h"

/** The callbacks. @param analysis must outlive the run */
scenario_watch_t scenario_analysis_watch(analysis_t *analysis);

#endif

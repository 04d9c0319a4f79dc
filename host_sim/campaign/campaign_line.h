/**
 * @file campaign_line.h
 * The lines of a file of results, read back. For campaign_merge.c only.
 */
#ifndef HOST_SIM_CAMPAIGN_LINE_H
#define HOST_SIM_CAMPAIGN_LINE_H

#include <jansson.h>

#include "campaign/campaign_result.h"

/** Read the first line. @return false: another program wrote it; reported */
bool campaign_line_part(const char *path, size_t line, const json_t *object, campaign_part_t *part);

/** Read the line of a run. @return false: it is not such a line; reported */
bool campaign_line_run(const char *path, size_t line, const json_t *object, uint64_t *run, campaign_sample_t *sample);

#endif

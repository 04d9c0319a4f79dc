/**
 * @file report_page.h
 * The report: one HTML file that needs no network. It says first what failed, what the supervisor did and why the
 * vehicle stands, and then shows the run.
 */
#ifndef HOST_SIM_REPORT_PAGE_H
#define HOST_SIM_REPORT_PAGE_H

#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "hal/can.h"
#include "io/output.h"
#include "report/series.h"
#include "why/why.h"

/** What the report is about. Pointers are needed for the call alone. */
typedef struct {
    const char *name;                      /**< of the log, the interface or the scenario */
    const char *interfaces[HAL_CAN_SIDES]; /**< names of the sides; NULL: none */
    uint64_t clock_us;                     /**< time of day of the start, us since 1970; 0: there is none */
    bool is_recording;                     /**< the frames came from a recording, which does not obey */
    const agv_config_t *config;
    const json_t *messages; /**< the array of survey, as in --why; NULL: none */
    const json_t *remarks;  /**< what stands below the first words: {"hint": bool, "text"}; NULL: none */
    bool is_partial;        /**< a part of the run was not supervised: without a trip it is no pass */
} report_page_t;

/**
 * Write the page. A failure to write is kept in the output, as ever.
 * @param why after why_end() @param series after series_end()
 */
void report_page_write(output_t *output, const report_page_t *page, const why_t *why, const series_t *series);

#endif

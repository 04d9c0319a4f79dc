/**
 * @file memory_output.h
 * The outputs of a page are texts in memory: output.h for it. What was written to an output stays until the output is
 * opened anew.
 */
#ifndef WEB_MEMORY_OUTPUT_H
#define WEB_MEMORY_OUTPUT_H

#include "io/output.h"

/** The text that was written to the output of this name; NULL: nothing was, or there was no memory. */
const char *memory_output_text(const char *name);

#endif

/**
 * @file output_json.h
 * JSON text into an output.
 */
#ifndef HOST_SIM_OUTPUT_JSON_H
#define HOST_SIM_OUTPUT_JSON_H

#include <jansson.h>
#include <stddef.h>

#include "io/output.h"

/**
 * Write a value and the end of its line. Without memory nothing is written, and the output fails with ENOMEM.
 * @param value NULL: there was no memory for it; the reference is taken
 * @param flags of json_dumps()
 */
void output_json(output_t *output, json_t *value, size_t flags);

#endif

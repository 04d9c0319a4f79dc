/**
 * @file json_build.h
 * JSON values that are put together with jansson. Without memory a part is left out, and the final dump fails.
 */
#ifndef HOST_SIM_JSON_BUILD_H
#define HOST_SIM_JSON_BUILD_H

#include <jansson.h>
#include <stdint.h>

/** Put a value into an object. The reference is taken. */
void json_put(json_t *object, const char *key, json_t *value);

/** Add a value to an array. The reference is taken. */
void json_add(json_t *array, json_t *value);

/** A number up to INT64_MAX. */
json_t *json_uint(uint64_t value);

/** A text, in which `?` stands for each byte above ASCII if it is no UTF-8; null for NULL. */
json_t *json_text(const char *text);

#endif

/**
 * @file yaml_file.h
 * A YAML file as a document in memory, and its scalars; for configurations and scenarios.
 */
#ifndef HOST_SIM_YAML_FILE_H
#define HOST_SIM_YAML_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <yaml.h>

#define YAML_FILE_SIZE_MAX 1048576u /**< larger files are refused */
#define YAML_FILE_DEPTH_MAX 32u     /**< files nested deeper are refused */

/**
 * Load a file that holds one YAML document, or none.
 * @param document to be freed with yaml_document_delete(); its root node is NULL when the file holds no document
 * @return false: it cannot be read, or is no YAML; was reported with file and line.
 */
bool yaml_file_load(const char *path, yaml_document_t *document);

/** The same from memory. @param name for messages, in the place of the path */
bool yaml_text_load(const char *name, const char *text, yaml_document_t *document);

/** The line on which a node begins, from 1. */
size_t yaml_node_line(const yaml_node_t *node);

/** The text of a scalar, without NUL bytes inside; NULL for what is no such scalar. */
const char *yaml_node_text(const yaml_node_t *node);

/** The text of a scalar that is not in quotes, so may be a number; NULL else. */
const char *yaml_node_plain(const yaml_node_t *node);

#endif

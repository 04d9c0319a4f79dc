/**
 * @file config_file.h
 * A configuration as a YAML file: settings at the top level, by the names of config_settings.def, and
 * `class_<fault in lower case>: trip|warn`. Settings that are not in the file keep their defaults.
 */
#ifndef HOST_SIM_CONFIG_FILE_H
#define HOST_SIM_CONFIG_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <yaml.h>

#include "agv/config.h"

/** Where each setting stands in its file, so that a later check can name the line; 0 = it is not in it. */
typedef struct {
    const char *path; /**< NULL: no file */
    size_t settings[AGV_SETTING_COUNT];
    size_t classes[AGV_FAULT_COUNT];
} config_lines_t;

/**
 * Read a file into a configuration.
 * @param config starts as what the caller filled in, commonly the defaults
 * @param lines  is filled in
 * @return false: the file cannot be read, or a key or value makes no sense by itself; was reported.
 */
bool config_file_load(const char *path, agv_config_t *config, config_lines_t *lines);

/**
 * Read a mapping of a document into a configuration (a scenario has one).
 * @param lines its path is set; the rest is added to
 * @return false: a key or value makes no sense by itself; was reported.
 */
bool config_read_mapping(yaml_document_t *document, const yaml_node_t *mapping, agv_config_t *config,
                         config_lines_t *lines);

/** Check a configuration as a whole. @return false: it makes no sense; was reported, with its line if it has one. */
bool config_check(const agv_config_t *config, const config_lines_t *lines);

/** Size of the key of any fault's class, terminating zero included. */
#define CONFIG_CLASS_KEY_SIZE 64u

/** "class_bus_off": the key of a fault's class. */
void config_class_key(agv_fault_t fault, char key[CONFIG_CLASS_KEY_SIZE]);

#endif

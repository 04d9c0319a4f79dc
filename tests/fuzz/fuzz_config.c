/*
 * The reader of configurations. A refusal is reported in one line, with the line of the file. An accepted configuration
 * is in range, and is the same after it is printed and read again.
 */
#include <string.h>

#include "agv/names.h"
#include "capture.h"
#include "config/config_file.h"
#include "config/config_text.h"
#include "input.h"

static bool read_once(const char *path, agv_config_t *config) {
    config_lines_t lines;
    memset(config, 0, sizeof *config);
    agv_config_defaults(config);
    return config_file_load(path, config, &lines) && config_check(config, &lines);
}

static void check_ranges(const agv_config_t *config) {
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        const agv_setting_info_t *info = agv_setting_info(i);
        const uint16_t value = agv_config_get(config, i);
        if ((value < info->lowest) || (value > info->highest)) {
            capture_fail("a setting out of range was taken", info->name);
        }
    }
}

static void print_and_read(const agv_config_t *config) {
    agv_config_t again;
    size_t size = 0;
    capture_begin();
    config_print_yaml(config);
    (void)capture_end();
    const char *text = capture_out(&size);
    const char *path = capture_file((const uint8_t *)text, size);
    capture_begin();
    const bool good = read_once(path, &again);
    const char *printed = capture_end();
    if (!good || (agv_config_checksum(&again) != agv_config_checksum(config))) {
        capture_fail("printed and read it is another configuration", printed);
    }
    capture_begin();
    config_print_kconfig(config);
    config_note_deviations(config);
    (void)capture_end();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const char *path = capture_file(data, size);
    agv_config_t config;
    capture_begin();
    const bool good = read_once(path, &config);
    const char *printed = capture_end();
    if (!good) {
        (void)capture_line(printed, path, capture_yaml_lines(data, size));
        return 0;
    }
    if (printed[0] != '\0') {
        capture_fail("accepted, and something was printed", printed);
    }
    check_ranges(&config);
    print_and_read(&config);
    return 0;
}

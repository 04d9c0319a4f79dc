/*
 * Steps of a scenario as a line: typed to `host_sim vehicle`, or after --fault. A refusal is reported in one line. Byte
 * 1: which of the two, topology, ID set; then the line.
 */
#include <stdlib.h>
#include <string.h>

#include "capture.h"
#include "input.h"
#include "live/vehicle_words.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    input_t input = {.at = data, .left = size};
    const uint8_t how = input_byte(&input);
    agv_config_t config;
    agv_config_defaults(&config);
    config.topology = (how >> 1) & 1;
    config.id_set = (how >> 2) & 1;
    char *line = malloc(input.left + 1);
    vehicle_words_t *words = calloc(1, sizeof *words);
    if ((line == NULL) || (words == NULL)) {
        free(line);
        free(words);
        return 0;
    }
    input_bytes(&input, (uint8_t *)line, input.left);
    line[size > 0 ? size - 1 : 0] = '\0';
    capture_begin();
    const bool good =
        ((how & 1) != 0) ? vehicle_words_typed(line, &config, words) : vehicle_words_fault(line, &config, words);
    const char *printed = capture_end();
    if (!good) {
        capture_one_line(printed);
    } else if ((printed[0] != '\0') || (memchr(words->what, '\0', sizeof words->what) == NULL) ||
               !words->step.of_vehicle) {
        capture_fail("taken, and something was printed, or it is no step of the vehicle", printed);
    } else {
        /* a step */
    }
    free(line);
    free(words);
    return 0;
}

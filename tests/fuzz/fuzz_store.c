/*
 * The reader of stores (latch and recorder, --store), and a supervisor that starts from the result. A damaged store is
 * never accepted (FSM-7): STORE_INVALID, and TRIPPED after every reset but a power-on.
 *
 * Byte 1: the reset cause; bit 7: correct the checksum at the end; then the file.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "agv/supervisor.h"
#include "capture.h"
#include "hal_sim/sim_hal.h"
#include "input.h"
#include "io/store_file.h"

enum { ROOM = 32, SIZE_LIMIT = 1 << 16 };

/* CRC-32 of IEEE 802.3, bit by bit. */
static uint32_t crc_by_hand(const uint8_t *bytes, size_t size) {
    uint32_t crc = 0xFFFFFFFFu;
    for (size_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (unsigned bit = 0; bit < 8; bit++) {
            crc = (crc >> 1) ^ (((crc & 1) != 0) ? 0xEDB88320u : 0);
        }
    }
    return ~crc;
}

/* Whether the last line is the correct checksum of all lines before it. */
static bool ends_in_its_checksum(const char *text, size_t size) {
    char expected[ROOM];
    if ((size < 15) || (text[size - 1] != '\n')) {
        return false;
    }
    const size_t before = size - 15; /* "check 1A2B3C4D\n" */
    (void)snprintf(expected, sizeof expected, "check %08X\n", (unsigned)crc_by_hand((const uint8_t *)text, before));
    return memcmp(&text[before], expected, 15) == 0;
}

static void check_start(hal_reset_cause_t cause, sim_store_t *store, agv_recorder_t *recorder, bool damaged) {
    static agv_supervisor_t supervisor;
    static struct hal hal;
    const sim_hal_config_t config = {.watchdog_ms = SIM_HAL_WATCHDOG_OFF, .reset_cause = cause, .store = store};
    const agv_ports_t ports = {.hal = &hal, .recorder = recorder};
    agv_config_t defaults;
    agv_config_defaults(&defaults);
    sim_hal_init_direct(&hal, &config, 1, NULL, NULL);
    agv_supervisor_start(&supervisor, &ports, &defaults, 0);
    const bool invalid = agv_supervisor_has_fault(&supervisor, AGV_FAULT_STORE_INVALID);
    if (agv_supervisor_state(&supervisor) != ((cause == HAL_RESET_POWER_ON) ? AGV_STATE_INIT : AGV_STATE_TRIPPED)) {
        capture_fail("it starts in the wrong state", "FSM-7");
    }
    if (damaged && !invalid) {
        capture_fail("a damaged store was believed", "FSM-7");
    }
    for (uint32_t i = 1; i <= 20; i++) {
        agv_supervisor_tick(&supervisor, &ports, i);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static sim_store_t store;
    static agv_recorder_t recorder;
    input_t input = {.at = data, .left = (size < SIZE_LIMIT) ? size : SIZE_LIMIT};
    const uint8_t how = input_byte(&input);
    char *text = malloc(input.left + ROOM);
    if (text == NULL) {
        return 0;
    }
    size_t length = input.left;
    input_bytes(&input, (uint8_t *)text, length);
    if ((how & 0x80u) != 0) {
        length += (size_t)snprintf(&text[length], ROOM, "check %08X\n", (unsigned)crc_by_hand((uint8_t *)text, length));
    }
    const char *path = capture_file((const uint8_t *)text, length);
    capture_begin();
    const bool loaded = store_file_load(path, &store, &recorder);
    const char *printed = capture_end();
    if (!loaded || (printed[0] != '\0')) {
        capture_fail("a file that can be read is a store, or a damaged one", printed);
    }
    check_start((hal_reset_cause_t)((how & 0x7Fu) % 6), &store, &recorder, !ends_in_its_checksum(text, length));
    free(text);
    return 0;
}

/* Common start of tests of the port: one port on vcan0 and a tester beside it. Included by the test itself. */
#ifndef ONE_PORT_H
#define ONE_PORT_H

#include "hal_linux/linux_hal.h"
#include "port.h"
#include "unity.h"
#include "vcan.h"

static hal_t hal;
static port_left_t left;
static int tester;

void setUp(void) {
    vcan_begin();
    port_open(&hal, "vcan0", NULL, &left);
    tester = vcan_open("vcan0");
}

void tearDown(void) {
    linux_hal_close(&hal);
    vcan_restore();
}

#endif

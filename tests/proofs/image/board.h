/*
 * The board that image.c runs on and sweep.c plays: its addresses, shared by both. The CAN controller takes a frame when it is
 * asked to, and sends it at once; the clock stands still within a millisecond.
 */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

enum { BOARD_FLASH = 0x00000000, BOARD_FLASH_SIZE = 0x00010000 };
enum { BOARD_RAM = 0x20000000, BOARD_RAM_SIZE = 0x00009000 };
enum { BOARD_REGISTERS = 0x40000000, BOARD_REGISTERS_SIZE = 0x00001000 };

/* Offsets of the registers, one word each. */
enum {
    BOARD_NOW_MS = 0x00, /* read: the clock */
    BOARD_CAUSE = 0x04,  /* read: hal_reset_cause_t */

    BOARD_RX_WAITING = 0x10, /* read: 1 if a frame waits */
    BOARD_RX_SIDE = 0x14,
    BOARD_RX_ID = 0x18,
    BOARD_RX_LOW = 0x1C,   /* bytes 1 to 4 */
    BOARD_RX_HIGH = 0x20,  /* bytes 5 to 8 */
    BOARD_RX_TAKEN = 0x24, /* write: on to the next one */

    BOARD_TX_SIDE = 0x30, /* write */
    BOARD_TX_ID = 0x34,
    BOARD_TX_LENGTH = 0x38,
    BOARD_TX_LOW = 0x3C,
    BOARD_TX_HIGH = 0x40,
    BOARD_TX_SEND = 0x44, /* write: send it */

    BOARD_OUTPUT = 0x50, /* write: the safety output, 1 = closed */
    BOARD_FEED = 0x54,   /* write: the hardware watchdog */
    BOARD_LED = 0x58     /* write */
};

/* The stored latch record. */
typedef struct {
    uint32_t size;
    uint8_t bytes[32];
} image_latch_t;

/* The start of the image: initial stack pointer and reset handler, as the processor expects them, and facts for sweep. */
typedef struct {
    uintptr_t stack;
    uintptr_t reset;
    uintptr_t latch; /* address of its image_latch_t */
    uintptr_t log;   /* addresses of the events that the flight recorder keeps */
    uintptr_t log_end;
    uint32_t architecture;
    uint32_t topology; /* agv_topology_t */
} image_start_t;

#endif

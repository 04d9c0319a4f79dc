/* A Cortex-M (Unicorn) on the board of board.h, whose state can be saved, loaded and changed. */
#ifndef MACHINE_H
#define MACHINE_H

#include <stdbool.h>
#include <stdint.h>
#include <unicorn/unicorn.h>

#include "board.h"
#include "world.h"

enum { MACHINE_SP = 13, MACHINE_LR = 14, MACHINE_PC = 15, MACHINE_REGISTERS = 16 };

typedef struct {
    uint32_t r[MACHINE_REGISTERS];
    uint32_t psr; /* flags, and state of an IT block */
} cpu_t;

typedef struct {
    uint32_t now_ms;
    uint32_t fed_ms;   /* the watchdog */
    uint32_t cause;    /* of the last reset */
    uint32_t received; /* frames taken in this millisecond */
    frame_t sending;
    bus_t bus;
} board_t;

typedef struct {
    cpu_t cpu;
    board_t board;
    uint8_t ram[BOARD_RAM_SIZE];
} snapshot_t;

typedef enum { MACHINE_SLEEPS, MACHINE_CRASHED, MACHINE_HANGS, MACHINE_GOES_ON } machine_end_t;

typedef struct machine machine_t;

/* What image_start_t is on the board: its pointers have 32 bits there. */
typedef struct {
    uint32_t stack;
    uint32_t reset;
    uint32_t latch;
    uint32_t log;
    uint32_t log_end;
    uint32_t architecture;
    uint32_t topology;
} start_t;

/* Load an ELF file into the flash; all machines share it. Ends the program, with a line, if it is no such image. */
const start_t *machine_image(const char *path);

/* A checksum of the flash. */
uint64_t machine_image_hash(void);

/* @param steps it is stepped, never run: Unicorn does not stop after one instruction in code that it ran before */
machine_t *machine_open(bool steps);

void machine_load(machine_t *machine, const snapshot_t *from);
void machine_save(const machine_t *machine, snapshot_t *to);
board_t *machine_board(machine_t *machine);

/* As the reset of the processor leaves it; RAM and board stay. */
void machine_reset(machine_t *machine);

/* Run until the program sleeps, or one instruction. A fault of the processor is a crash. */
machine_end_t machine_run(machine_t *machine);
machine_end_t machine_step(machine_t *machine);

/* Clear the memory below the stack pointer: nothing reads it, and states that differ there alone are the same. */
void machine_clear_dead_stack(machine_t *machine);

/* A checksum of processor and RAM, without the recorder's log, which no decision reads. */
uint64_t machine_hash(const machine_t *machine);

/* The length of the instruction at an address of the flash, in bytes; go past it in a saved state, as if it were a NOP. */
uint32_t machine_length(uint32_t pc);
void machine_skip(cpu_t *cpu);

#endif

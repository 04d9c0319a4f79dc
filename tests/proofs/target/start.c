/* The vector table of the machine that runs the tests: where a program begins, and what becomes of one that crashes. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#define TOP_OF_MEMORY 0x00400000u

void _start(void); /* newlib's */

static void report_crash(void) {
    (void)puts("the processor faulted");
    (void)fflush(stdout);
    _Exit(3);
}

typedef void handler_t(void);

__attribute__((section(".vectors"))) const struct {
    uintptr_t stack; /* until _start has asked for it */
    handler_t *reset;
    handler_t *nmi;
    handler_t *hard_fault;
    handler_t *memory_fault;
    handler_t *bus_fault;
    handler_t *usage_fault;
} agv_target_vectors = {TOP_OF_MEMORY, _start, report_crash, report_crash, report_crash, report_crash, report_crash};

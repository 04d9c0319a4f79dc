/*
 * Counts the instructions of the supervisor's entry points, without those of the port, while a test runs under
 * `run --counting`. Linked around them (--wrap); prints a table when the program ends.
 *
 * QEMU then lets 64 ns pass with every instruction, and SysTick counts 25 MHz: 8 counts are 5 instructions.
 */
#include <stdio.h>
#include <stdlib.h>

#include "agv/names.h"
#include "agv/supervisor.h"
#include "hal/clock.h"
#include "hal/inputs.h"
#include "hal/led.h"
#include "hal/reset.h"
#include "hal/safety_output.h"
#include "hal/self_test.h"
#include "hal/store.h"
#include "hal/watchdog.h"

/* SysTick of every Cortex-M: control, reload value, value, which counts down 24 bits. */
#define SYSTICK ((volatile uint32_t *)0xE000E010u)
#define SYSTICK_MAX 0x00FFFFFFu

typedef struct {
    uint32_t calls;
    uint32_t most;
    uint64_t sum;
} row_t;

enum { STATES = 5, OTHER = AGV_MSG_COUNT };

static const agv_state_t states[STATES] = {AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_STATE_ACTIVE, AGV_STATE_TRIPPED,
                                           AGV_STATE_SAFE};
static row_t starts;
static row_t frames[AGV_MSG_COUNT + 1];
static row_t ticks[STATES];
static row_t trips_by_frame; /* from the call to its first hal_can_send, of a frame that trips */
static row_t trips_by_tick;  /* the same of a tick */
static uint32_t first_send;  /* counts of this call up to its first hal_can_send; 0: none yet */
static uint32_t counted;     /* counts of the call that goes on, up to the last pause */
static uint32_t began_at;    /* SysTick when it began or went on */
static uint32_t empty;       /* what looking at the clock costs */

static void go_on(void) {
    began_at = SYSTICK[2];
}

static void pause(void) {
    counted += (began_at - SYSTICK[2]) & SYSTICK_MAX;
}

static void begin(void) {
    counted = 0;
    go_on();
}

static uint32_t end(void) {
    pause();
    return ((counted * 5u) + 4u) / 8u; /* below 10 million */
}

static void count_call(row_t *row, uint32_t instructions) {
    const uint32_t own = instructions > empty ? instructions - empty : 0u;
    row->calls++;
    row->sum += own;
    row->most = own > row->most ? own : row->most;
}

/* A call that was not tripped before it and is now: FSM-2. */
static void note_trip(row_t *row, agv_state_t before, agv_state_t now) {
    if (!agv_state_is_latched(before) && (now == AGV_STATE_TRIPPED) && (first_send != 0u)) {
        count_call(row, ((first_send * 5u) + 4u) / 8u);
    }
}

static row_t *row_of_tick(const agv_supervisor_t *supervisor) {
    unsigned i = 0;
    while (i < STATES - 1 && states[i] != agv_supervisor_state(supervisor)) {
        i++;
    }
    return &ticks[i];
}

/* Starts the clock. Without `run --counting` it would be that of the computer, and mean nothing. */
static void prepare(void) {
    SYSTICK[1] = SYSTICK_MAX;
    SYSTICK[2] = 0;
    SYSTICK[0] = 5; /* enabled, without an interrupt, at the processor's clock */
    begin();
    empty = end();
    begin();
    __asm__ volatile(".rept 1000\n nop\n .endr");
    const uint32_t thousand = end() - empty;
    if (thousand < 999u || thousand > 1001u) {
        printf("1000 instructions were counted as %u: run --counting\n", (unsigned)thousand);
        exit(1);
    }
}

/* ---- The entry points ---- */

void __real_agv_supervisor_start(agv_supervisor_t *supervisor, const agv_ports_t *ports, const agv_config_t *config,
                                 uint32_t now_ms);
void __wrap_agv_supervisor_start(agv_supervisor_t *supervisor, const agv_ports_t *ports, const agv_config_t *config,
                                 uint32_t now_ms);
void __real_agv_supervisor_frame(agv_supervisor_t *supervisor, const agv_ports_t *ports, hal_can_side_t side,
                                 const hal_can_frame_t *frame);
void __wrap_agv_supervisor_frame(agv_supervisor_t *supervisor, const agv_ports_t *ports, hal_can_side_t side,
                                 const hal_can_frame_t *frame);
void __real_agv_supervisor_tick(agv_supervisor_t *supervisor, const agv_ports_t *ports, uint32_t now_ms);
void __wrap_agv_supervisor_tick(agv_supervisor_t *supervisor, const agv_ports_t *ports, uint32_t now_ms);

void __wrap_agv_supervisor_start(agv_supervisor_t *supervisor, const agv_ports_t *ports, const agv_config_t *config,
                                 uint32_t now_ms) {
    prepare();
    begin();
    __real_agv_supervisor_start(supervisor, ports, config, now_ms);
    count_call(&starts, end());
}

void __wrap_agv_supervisor_frame(agv_supervisor_t *supervisor, const agv_ports_t *ports, hal_can_side_t side,
                                 const hal_can_frame_t *frame) {
    const uint32_t message = agv_message_from_id(frame->id, agv_supervisor_config(supervisor)->id_set);
    const agv_state_t before = agv_supervisor_state(supervisor);
    first_send = 0;
    begin();
    __real_agv_supervisor_frame(supervisor, ports, side, frame);
    count_call(&frames[message], end());
    note_trip(&trips_by_frame, before, agv_supervisor_state(supervisor));
}

void __wrap_agv_supervisor_tick(agv_supervisor_t *supervisor, const agv_ports_t *ports, uint32_t now_ms) {
    row_t *row = row_of_tick(supervisor);
    const agv_state_t before = agv_supervisor_state(supervisor);
    first_send = 0;
    begin();
    __real_agv_supervisor_tick(supervisor, ports, now_ms);
    count_call(row, end());
    note_trip(&trips_by_tick, before, agv_supervisor_state(supervisor));
}

/* ---- The port, which does not count ---- */

#define NOT_COUNTED(type, name, parameters, arguments)                                                                 \
    type __real_##name parameters;                                                                                     \
    type __wrap_##name parameters;                                                                                     \
    type __wrap_##name parameters {                                                                                    \
        pause();                                                                                                       \
        type result = __real_##name arguments;                                                                         \
        go_on();                                                                                                       \
        return result;                                                                                                 \
    }
#define NOT_COUNTED_VOID(name, parameters, arguments)                                                                  \
    void __real_##name parameters;                                                                                     \
    void __wrap_##name parameters;                                                                                     \
    void __wrap_##name parameters {                                                                                    \
        pause();                                                                                                       \
        __real_##name arguments;                                                                                       \
        go_on();                                                                                                       \
    }

bool __real_hal_can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame);
bool __wrap_hal_can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame);

bool __wrap_hal_can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame) {
    pause();
    if (first_send == 0u) {
        first_send = counted;
    }
    const bool taken = __real_hal_can_send(hal, side, frame);
    go_on();
    return taken;
}

NOT_COUNTED(size_t, hal_store_read_latch, (hal_t * hal, void *record, size_t size), (hal, record, size))
NOT_COUNTED(bool, hal_store_write_latch, (hal_t * hal, const void *record, size_t size), (hal, record, size))
NOT_COUNTED(bool, hal_store_append, (hal_t * hal, const void *record, size_t size), (hal, record, size))
NOT_COUNTED(hal_reset_cause_t, hal_reset_cause, (hal_t * hal), (hal))
NOT_COUNTED_VOID(hal_can_purge, (hal_t * hal, hal_can_side_t side), (hal, side))
NOT_COUNTED_VOID(hal_can_recover, (hal_t * hal, hal_can_side_t side), (hal, side))
NOT_COUNTED_VOID(hal_can_status, (hal_t * hal, hal_can_side_t side, hal_can_status_t *status), (hal, side, status))
NOT_COUNTED_VOID(hal_led_set, (hal_t * hal, bool on), (hal, on))
NOT_COUNTED_VOID(hal_safety_output_set, (hal_t * hal, bool closed), (hal, closed))
NOT_COUNTED_VOID(hal_watchdog_feed, (hal_t * hal), (hal))
NOT_COUNTED_VOID(hal_inputs_read, (hal_t * hal, hal_inputs_t *inputs), (hal, inputs))
NOT_COUNTED(bool, hal_clock_second_ms, (hal_t * hal, uint32_t *time_ms), (hal, time_ms))
NOT_COUNTED(uint32_t, hal_self_test, (hal_t * hal), (hal))

/* ---- The table ---- */

static uint32_t print_row(const char *call, const char *of, const row_t *row) {
    if (row->calls > 0u) {
        const uint32_t mean = (uint32_t)(row->sum / row->calls);
        printf("%-6s %-20s %9u %9u %9u\n", call, of, (unsigned)row->calls, (unsigned)mean, (unsigned)row->most);
    }
    return row->most;
}

static void print_most(const char *call, uint32_t most) {
    printf("the most instructions of a %s: %u\n", call, (unsigned)most);
}

__attribute__((destructor)) static void print_table(void) {
    uint32_t frame = 0;
    uint32_t tick = 0;
    printf("%-6s %-20s %9s %9s %9s\n", "call", "of, or in", "calls", "mean", "most");
    (void)print_row("start", "", &starts);
    for (uint32_t i = 0; i <= AGV_MSG_COUNT; i++) {
        const char *name = i < (uint32_t)OTHER ? agv_message_name((agv_message_t)i) : "another identifier";
        const uint32_t most = print_row("frame", name, &frames[i]);
        frame = most > frame ? most : frame;
    }
    for (unsigned i = 0; i < STATES; i++) {
        const uint32_t most = print_row("tick", agv_state_name(states[i]), &ticks[i]);
        tick = most > tick ? most : tick;
    }
    (void)print_row("trip", "by a frame, to send", &trips_by_frame);
    (void)print_row("trip", "by a tick, to send", &trips_by_tick);
    print_most("frame", frame);
    print_most("tick", tick);
}

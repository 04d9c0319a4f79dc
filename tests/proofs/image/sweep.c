/*
 * Disturbs the instructions of an image (image.c), one at a time: each instruction that is executed in a window (world.h) is
 * skipped, and after it each bit of each register that it writes is flipped. What follows is judged from the bus and the safety
 * output.
 *
 * usage: sweep IMAGE [--window NAME] [--pc FROM-TO] [--shard I/N] [--every N | --bits N] [--table FILE]
 *
 * --pc FROM-TO: only instructions at these addresses, hexadecimal, without the last one.
 * --shard I/N: the I-th of N parts of the instructions.
 * --every N: every N-th flip and 30 times as many of the skips, chosen by a hash.
 * --bits N: each skip, and at least N flips in each register that an instruction writes: evenly apart, the first by a hash.
 * --table FILE: a line for each disturbed instruction is added to it. What a run that was ended has left there is not done again.
 *
 * Prints a line of sums after each window, and at the end what harm there was: then the exit status is 1. It is 2 if nothing was
 * disturbed.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "agv/faults.h"
#include "hal/reset.h"
#include "machine.h"

enum { FOLLOW_MAX = 1300, WATCHDOG_MS = 100, FLAGS = MACHINE_REGISTERS, SKIP = MACHINE_REGISTERS + 1 };
enum { LATCH_UNRESETTABLE = 2 }; /* byte of the stored record: agv_latch_t */

enum { HARMS = 4 };
static const char *const harm_names[HARMS] = {"motion", "undone", "silence", "closed"};

typedef enum { SAME, SAFE, DETECTED, HARMFUL, VERDICTS } verdict_t;

static struct {
    const char *image;
    const char *window;
    const char *table;
    unsigned shard;
    unsigned shards;
    unsigned every; /* 0: not given */
    unsigned bits;  /* 0: not given */
    unsigned from;
    unsigned to;
} options = {.shard = 1, .shards = 1, .to = UINT32_MAX};

static const start_t *start;
static machine_t *runner;
static machine_t *stepper;
static const window_t *window;
static uint32_t begin_ms;

/* ---- States that were followed before: what came of them ---- */

typedef struct {
    uint64_t key; /* 0: free */
    uint8_t harm;
    bool detected;
    bool differs; /* the bus, from here on */
} known_t;

enum { KNOWN = 1 << 22 };
static known_t *known;
static uint32_t known_count;

static known_t *find(uint64_t key) {
    known_t *at = &known[key % KNOWN];
    while ((at->key != 0) && (at->key != key)) {
        at = (at == &known[KNOWN - 1]) ? known : at + 1;
    }
    return at;
}

static void learn(uint64_t key, known_t what) {
    known_t *const at = find(key);
    if ((at->key == 0) && (known_count < KNOWN / 2)) {
        *at = what;
        at->key = key;
        known_count++;
    }
}

static bool is_looked_up(uint32_t offset) {
    return (offset <= 12) || ((offset % 32) == 0);
}

static uint64_t mixed(uint64_t key, uint64_t word) {
    const uint64_t product = (key ^ word) * 0xD6E8FEB86659FD93u;
    return product ^ (product >> 32);
}

/* All that decides what comes: processor, RAM, board, and what the judge remembers. */
static uint64_t key_of(uint32_t offset) {
    const board_t *const board = machine_board(runner);
    const bus_t *const bus = &board->bus;
    uint64_t key = mixed(machine_hash(runner), offset);
    key = mixed(key, board->fed_ms);
    key = mixed(key, board->cause | (bus->output_closed ? 0x100u : 0) | (bus->latched ? 0x200u : 0));
    key =
        mixed(key, bus->reason | ((board->now_ms - bus->opened_ms < 4) ? 0x100u + board->now_ms - bus->opened_ms : 0));
    for (uint32_t i = 0; i < WORLD_KINDS; i++) {
        key = mixed(key, bus->safe_ms[i]);
    }
    return (key == 0) ? 1 : key;
}

/* ---- Time ---- */

static uint64_t
    usual[FOLLOW_MAX]; /* hash of what the undisturbed run does on the bus, for each millisecond of the window */
static uint64_t usual_key[FOLLOW_MAX];
static uint32_t restart_ms; /* of a processor that is down; 0: it runs */
static bool was_down;

static void restart(uint32_t cause) {
    board_t *const board = machine_board(runner);
    world_reset(&board->bus, board->now_ms);
    board->cause = cause;
    board->fed_ms = board->now_ms;
    board->received = UINT32_MAX / 2; /* what comes meanwhile is lost */
    machine_reset(runner);
    restart_ms = (machine_run(runner) == MACHINE_SLEEPS) ? 0 : (board->now_ms + 1);
}

/* A crash opens the output and resets at once (FSM-4); a program that hangs, or feeds no more, is bitten. */
static void end_millisecond(machine_end_t end) {
    board_t *const board = machine_board(runner);
    if (end == MACHINE_CRASHED) {
        was_down = true;
        restart(HAL_RESET_SOFTWARE);
    } else if (end == MACHINE_HANGS) {
        was_down = true;
        restart_ms = board->fed_ms + (uint32_t)WATCHDOG_MS;
    } else if ((restart_ms == 0) && (board->now_ms - board->fed_ms >= WATCHDOG_MS)) {
        was_down = true;
        restart(HAL_RESET_WATCHDOG);
    }
    world_passed(&board->bus, board->now_ms);
    machine_clear_dead_stack(runner);
}

static void begin_millisecond(machine_t *machine) {
    board_t *const board = machine_board(machine);
    board->now_ms++;
    board->received = 0;
    board->bus.hash = 0;
}

static void one_millisecond(void) {
    begin_millisecond(runner);
    if (restart_ms == 0) {
        end_millisecond(machine_run(runner));
        return;
    }
    if (machine_board(runner)->now_ms >= restart_ms) {
        restart(HAL_RESET_WATCHDOG);
    }
    end_millisecond(MACHINE_SLEEPS);
}

/* ---- One disturbance ---- */

static bool found_itself(void) {
    static const uint8_t checks[] = {AGV_FAULT_SELF_TEST_FAILED, AGV_FAULT_MEMORY_CORRUPTED, AGV_FAULT_CONFIG_INVALID,
                                     AGV_FAULT_TX_GATE_REFUSED, AGV_FAULT_STEP_OVERRUN};
    static snapshot_t at;
    machine_save(runner, &at);
    const uint8_t unresettable =
        at.ram[start->latch - (uint32_t)BOARD_RAM + sizeof(uint32_t) + (size_t)LATCH_UNRESETTABLE];
    bool found = (at.board.bus.reason != UINT8_MAX) && (unresettable < AGV_FAULT_COUNT);
    for (uint32_t i = 0; i < sizeof checks; i++) {
        found = found || (at.board.bus.reason == checks[i]);
    }
    return found;
}

typedef struct {
    uint64_t keys[64];
    bool differs[64];
    uint32_t count;
} path_t;

static void note_millisecond(path_t *path, uint32_t offset) {
    if (machine_board(runner)->bus.hash != usual[offset]) {
        for (uint32_t i = 0; i < path->count; i++) {
            path->differs[i] = true;
        }
    }
}

/* Follow the runner from within the millisecond `offset` of the window to the end of the time. */
static known_t follow(uint32_t offset, machine_end_t end) {
    path_t path = {.count = 1}; /* the first one stands for the disturbance itself */
    known_t result = {0};
    restart_ms = 0;
    was_down = false;
    end_millisecond(end);
    for (;; offset++) {
        const board_t *const board = machine_board(runner);
        note_millisecond(&path, offset);
        result.harm = (uint8_t)board->bus.harm;
        if ((result.harm != 0) || (offset + 1 >= window->follow_ms)) {
            break;
        }
        if ((restart_ms == 0) && is_looked_up(offset)) {
            const uint64_t key = key_of(offset);
            const known_t *const before = find(key);
            if (before->key != 0) {
                result = *before;
                for (uint32_t i = 0; i < path.count; i++) {
                    path.differs[i] = path.differs[i] || result.differs;
                }
                break;
            }
            path.keys[path.count] = key;
            path.differs[path.count] = false;
            path.count++;
        }
        one_millisecond();
    }
    result.detected = result.detected || was_down || found_itself();
    for (uint32_t i = 1; i < path.count; i++) {
        result.differs = path.differs[i];
        learn(path.keys[i], result);
    }
    result.differs = path.differs[0];
    return result;
}

static verdict_t verdict_of(known_t result) {
    if (result.harm != 0) {
        return HARMFUL;
    }
    if (result.detected) {
        return DETECTED;
    }
    return result.differs ? SAFE : SAME;
}

/* ---- The table ---- */

static struct {
    uint64_t instructions;
    uint64_t faults; /* all that there are */
    uint64_t done;
    uint64_t verdicts[VERDICTS];
    uint64_t harms[HARMS];
} sum;

static FILE *table;
static char harms[4000]; /* the disturbances of an instruction that did harm */

static const char *name_of(uint32_t what) {
    static const char *const names[] = {"r0", "r1",  "r2",  "r3",  "r4", "r5", "r6", "r7",   "r8",
                                        "r9", "r10", "r11", "r12", "sp", "lr", "pc", "flags"};
    return names[what];
}

static void note_harm(uint32_t what, uint32_t bit, uint32_t harm) {
    const size_t used = strlen(harms);
    char text[20] = "skip";
    uint32_t i = 0;
    while (((harm >> i) & 1) == 0) {
        i++;
    }
    if (what != SKIP) {
        (void)snprintf(text, sizeof text, "%s.%u", name_of(what), (unsigned)bit);
    }
    (void)snprintf(&harms[used], sizeof harms - used, "%s%s=%s", (used > 0) ? " " : "", text, harm_names[i]);
    sum.harms[i]++;
}

typedef struct {
    uint64_t index; /* of the instruction in its window */
    uint32_t pc;
    uint64_t faults; /* all that there are */
    uint64_t verdicts[VERDICTS];
} line_t;

static void count_line(const line_t *line) {
    for (uint32_t i = 0; i < VERDICTS; i++) {
        sum.verdicts[i] += line->verdicts[i];
        sum.done += line->verdicts[i];
    }
}

static void add_line(const line_t *line) {
    const uint64_t *const v = line->verdicts;
    count_line(line);
    if ((table != NULL) && (v[SAME] + v[SAFE] + v[DETECTED] + v[HARMFUL] > 0)) {
        (void)fprintf(table, "%s\t%llu\t%x\t%llu\t%llu\t%llu\t%llu\t%llu\t%s\n", window->name,
                      (unsigned long long)line->index, (unsigned)line->pc, (unsigned long long)line->faults,
                      (unsigned long long)v[SAME], (unsigned long long)v[SAFE], (unsigned long long)v[DETECTED],
                      (unsigned long long)v[HARMFUL], harms);
        (void)fflush(table);
    }
}

static void refuse_table(const char *why) {
    (void)fprintf(stderr, "sweep: %s: %s\n", options.table, why);
    exit(2);
}

/* Continue the table: `resumed` of each window is the number after that of its last line. A line that was cut off is done again. */
static uint64_t resumed[WORLD_WINDOWS];

static void read_lines(FILE *in) {
    static char text[sizeof harms + 200];
    long whole = ftell(in);
    while ((fgets(text, sizeof text, in) != NULL) && (strchr(text, '\n') != NULL)) {
        uint64_t numbers[3 + VERDICTS]; /* index, address, disturbances, verdicts */
        char *at = strchr(text, '\t');
        for (unsigned i = 0; i < 3 + (unsigned)VERDICTS; i++) {
            numbers[i] = (at != NULL) ? strtoull(at, &at, (i == 1) ? 16 : 10) : 0;
        }
        if ((at == NULL) || (*at != '\t')) {
            refuse_table("has a line that is none of its own");
        }
        for (unsigned i = 0; i < WORLD_WINDOWS; i++) {
            if ((strncmp(text, WORLD[i].name, strlen(WORLD[i].name)) == 0) && (text[strlen(WORLD[i].name)] == '\t')) {
                resumed[i] = numbers[0] + 1;
            }
        }
        count_line(&(line_t){.verdicts = {numbers[3], numbers[4], numbers[5], numbers[6]}});
        whole = ftell(in);
    }
    (void)fseek(in, whole, SEEK_SET);
}

static void open_table(void) {
    char head[120];
    char there[sizeof head] = "";
    if (options.table == NULL) {
        return;
    }
    const bool by_bits = options.bits > 0;
    (void)snprintf(head, sizeof head, "# image %016llx, shard %u/%u, %s %u\n", (unsigned long long)machine_image_hash(),
                   options.shard, options.shards, by_bits ? "bits" : "every", by_bits ? options.bits : options.every);
    table = fopen(options.table, "r+");
    table = (table != NULL) ? table : fopen(options.table, "w+");
    if (table == NULL) {
        refuse_table("cannot be written");
    }
    if (fgets(there, sizeof there, table) == NULL) {
        (void)fputs(head, table);
    } else if (strcmp(head, there) != 0) {
        refuse_table("is of another image, shard or choice: remove it");
    } else {
        read_lines(table);
    }
}

/* ---- One instruction ---- */

/* The lowest bit of a register that is flipped: only the flags of the program status, and no bit of the instruction set. */
static uint32_t lowest_bit(uint32_t what) {
    return (what == FLAGS) ? 28 : ((what == MACHINE_PC) ? 1 : 0);
}

static uint64_t hash_of(uint64_t index, uint32_t what, uint32_t bit) {
    const uint64_t number = (((uint64_t)(window - WORLD) << 56) ^ (index << 16) ^ (what << 8) ^ bit) + 1;
    return mixed(mixed(number, 1), 2);
}

static bool is_one_of_bits(uint64_t index, uint32_t what, uint32_t bit) {
    const uint32_t apart = (32 - lowest_bit(what)) / options.bits;
    return (apart <= 1) || (((bit + hash_of(index, what, 0)) % apart) == 0);
}

static bool is_chosen(uint64_t index, uint32_t what, uint32_t bit) {
    if (options.bits > 0) {
        return (what == SKIP) || is_one_of_bits(index, what, bit);
    }
    const unsigned every = (what == SKIP) ? ((options.every + 29) / 30) : options.every;
    return (hash_of(index, what, bit) % every) == 0;
}

static void disturb(const snapshot_t *state, uint32_t offset, uint32_t what, uint32_t bit,
                    uint64_t verdicts[VERDICTS]) {
    machine_load(runner, state);
    const known_t result = follow(offset, machine_run(runner));
    const verdict_t verdict = verdict_of(result);
    verdicts[verdict]++;
    if (verdict == HARMFUL) {
        note_harm(what, bit, result.harm);
    }
}

static bool changes_flow(const snapshot_t *before, const snapshot_t *after) {
    const uint32_t pc = before->cpu.r[MACHINE_PC];
    return after->cpu.r[MACHINE_PC] != pc + machine_length(pc);
}

/*
 * Which registers an instruction writes, one bit each: those that change; and those that come out the same although they
 * were inverted before.
 */
static uint32_t written_by(const snapshot_t *before, const snapshot_t *after) {
    static snapshot_t inverted;
    static snapshot_t then;
    uint32_t written = changes_flow(before, after) ? (1u << MACHINE_PC) : 0;
    for (uint32_t r = 0; r <= FLAGS; r++) {
        const uint32_t mask = (r == FLAGS) ? 0xF0000000u : UINT32_MAX;
        if (r == MACHINE_PC) {
            continue;
        }
        inverted = *before;
        uint32_t *const there = (r == FLAGS) ? &inverted.cpu.psr : &inverted.cpu.r[r];
        const uint32_t value = *there ^ mask;
        const uint32_t was = *there;
        *there = value;
        machine_load(stepper, &inverted);
        const machine_end_t end = machine_step(stepper);
        machine_save(stepper, &then);
        const uint32_t now = (r == FLAGS) ? then.cpu.psr : then.cpu.r[r];
        const uint32_t usually = (r == FLAGS) ? after->cpu.psr : after->cpu.r[r];
        if ((((usually ^ was) & mask) != 0) || ((end == MACHINE_GOES_ON) && (((now ^ value) & mask) != 0))) {
            written |= 1u << r;
        }
    }
    return written;
}

static void disturb_instruction(const snapshot_t *before, const snapshot_t *after, uint32_t offset, uint64_t index) {
    static snapshot_t changed;
    uint64_t verdicts[VERDICTS] = {0};
    uint64_t count = 1;
    const uint32_t written = written_by(before, after);
    harms[0] = '\0';
    if (is_chosen(index, SKIP, 0)) {
        changed = *before;
        machine_skip(&changed.cpu);
        disturb(&changed, offset, SKIP, 0, verdicts);
    }
    for (uint32_t r = 0; r <= FLAGS; r++) {
        if (((written >> r) & 1) == 0) {
            continue;
        }
        for (uint32_t bit = lowest_bit(r); bit < 32; bit++, count++) {
            if (is_chosen(index, r, bit)) {
                changed = *after;
                *((r == FLAGS) ? &changed.cpu.psr : &changed.cpu.r[r]) ^= 1u << bit;
                disturb(&changed, offset, r, bit, verdicts);
            }
        }
    }
    sum.instructions++;
    sum.faults += count;
    add_line(&(line_t){.index = index,
                       .pc = before->cpu.r[MACHINE_PC],
                       .faults = count,
                       .verdicts = {verdicts[SAME], verdicts[SAFE], verdicts[DETECTED], verdicts[HARMFUL]}});
}

/* ---- A window ---- */

static void fail(const char *what) {
    (void)fprintf(stderr, "sweep: %s, window %s: %s\n", options.image, window->name, what);
    exit(2);
}

/* Run up to the window without a disturbance. @param before the state at the end of the millisecond before it */
static void approach(snapshot_t *before) {
    static const snapshot_t fresh;
    machine_load(runner, &fresh);
    machine_board(runner)->cause = HAL_RESET_POWER_ON;
    machine_reset(runner);
    if (machine_run(runner) != MACHINE_SLEEPS) {
        fail("the image does not start");
    }
    machine_clear_dead_stack(runner);
    while (machine_board(runner)->now_ms < 8000) {
        machine_save(runner, before);
        const uint32_t next_ms = before->board.now_ms + 1;
        begin_ms = next_ms;
        if (next_ms == window->first_ms) {
            return;
        }
        one_millisecond();
        const bool sent = machine_board(runner)->bus.safe_ms[1] == next_ms;
        if ((window->first_ms == 0) && (next_ms > 1100) && sent) {
            return;
        }
    }
    fail("the undisturbed run does not trip");
}

static machine_end_t begin_window(machine_t *machine, uint32_t offset) {
    begin_millisecond(machine);
    if (window->restarts && (offset == 0)) {
        board_t *const board = machine_board(machine);
        world_reset(&board->bus, board->now_ms);
        board->cause = HAL_RESET_WATCHDOG;
        board->fed_ms = board->now_ms;
        machine_reset(machine);
    }
    return MACHINE_GOES_ON;
}

/* The run that is not disturbed: it must do no harm, and every disturbed one is compared with it. */
static void run_usual(const snapshot_t *before) {
    machine_load(runner, before);
    restart_ms = 0;
    was_down = false;
    for (uint32_t offset = 0; offset < window->follow_ms; offset++) {
        (void)begin_window(runner, offset);
        end_millisecond(machine_run(runner));
        usual[offset] = machine_board(runner)->bus.hash;
        usual_key[offset] = key_of(offset);
        learn(usual_key[offset], (known_t){0});
    }
    if ((machine_board(runner)->bus.harm != 0) || was_down) {
        fail("the undisturbed run does harm, or ends");
    }
}

static bool is_mine(unsigned number, uint64_t index, uint32_t pc) {
    return (pc >= options.from) && (pc < options.to) && (index >= resumed[number]) &&
           ((index % options.shards) == options.shard - 1);
}

static void sweep_window(unsigned number) {
    static snapshot_t state;
    static snapshot_t before;
    static snapshot_t after;
    uint64_t index = 0;
    window = &WORLD[number];
    world_choose(number, start->topology);
    (void)memset(known, 0, (size_t)KNOWN * sizeof *known);
    known_count = 0;
    approach(&state);
    world_begin(begin_ms);
    run_usual(&state);
    machine_load(stepper, &state);
    for (uint32_t offset = 0; offset < window->length_ms; offset++) {
        (void)begin_window(stepper, offset);
        machine_end_t end = MACHINE_GOES_ON;
        while (end == MACHINE_GOES_ON) {
            machine_save(stepper, &before);
            end = machine_step(stepper);
            if ((end == MACHINE_GOES_ON) && is_mine(number, index, before.cpu.r[MACHINE_PC])) {
                machine_save(stepper, &after);
                disturb_instruction(&before, &after, offset, index);
                machine_load(stepper, &after);
            }
            index++;
        }
        world_passed(&machine_board(stepper)->bus, machine_board(stepper)->now_ms);
        machine_clear_dead_stack(stepper);
        machine_save(stepper, &state);
        machine_load(runner, &state);
        if ((end != MACHINE_SLEEPS) || (key_of(offset) != usual_key[offset])) {
            fail("it runs otherwise in single steps");
        }
    }
}

/* ---- */

static _Noreturn void usage(void) {
    (void)fprintf(
        stderr,
        "usage: sweep IMAGE [--window NAME] [--pc FROM-TO] [--shard I/N] [--every N | --bits N] [--table FILE]\n");
    exit(2);
}

/* A whole number of an option, in 1..most. @param end where it has to end: the text behind it */
static unsigned number_in(const char *value, unsigned long most, const char **end) {
    char *behind;
    const unsigned long number = strtoul(value, &behind, 10);
    if ((value[0] < '0') || (value[0] > '9') || (number < 1) || (number > most)) {
        usage();
    }
    *end = behind;
    return (unsigned)number;
}

/* FROM-TO */
static void read_range(const char *value) {
    char *end;
    options.from = (unsigned)strtoul(value, &end, 16);
    options.to = (*end == '-') ? (unsigned)strtoul(end + 1, &end, 16) : 0;
    if ((*end != '\0') || (options.from >= options.to)) {
        usage();
    }
}

static void read_option(const char *name, const char *value) {
    const char *end = "";
    if (strcmp(name, "--window") == 0) {
        options.window = value;
    } else if (strcmp(name, "--table") == 0) {
        options.table = value;
    } else if (strcmp(name, "--pc") == 0) {
        read_range(value);
    } else if (strcmp(name, "--every") == 0) {
        options.every = number_in(value, 1000000, &end);
    } else if (strcmp(name, "--bits") == 0) {
        options.bits = number_in(value, 32, &end);
    } else if (strcmp(name, "--shard") == 0) {
        options.shard = number_in(value, 1000000, &end);
        options.shards = (*end == '/') ? number_in(end + 1, 1000000, &end) : 0;
    } else {
        usage();
    }
    if (*end != '\0') {
        usage();
    }
}

static void read_options(int argc, char **argv) {
    if ((argc < 2) || (argc % 2 != 0) || (argv[1][0] == '-')) {
        usage();
    }
    options.image = argv[1];
    for (int i = 2; i < argc; i += 2) {
        read_option(argv[i], argv[i + 1]);
    }
    if ((options.shard > options.shards) || ((options.every > 0) && (options.bits > 0))) {
        usage();
    }
    if ((options.every == 0) && (options.bits == 0)) {
        options.every = 1;
    }
}

static void report(const char *name) {
    const unsigned long long shown[] = {sum.instructions,     sum.faults,         sum.done,
                                        sum.verdicts[SAME],   sum.verdicts[SAFE], sum.verdicts[DETECTED],
                                        sum.verdicts[HARMFUL]};
    (void)printf(
        "%-14s %8llu instructions %9llu disturbances %8llu done: %8llu same %7llu safe %8llu detected %5llu harmful,"
        " %.0f s\n",
        name, shown[0], shown[1], shown[2], shown[3], shown[4], shown[5], shown[6],
        (double)clock() / (double)CLOCKS_PER_SEC);
    (void)fflush(stdout);
}

int main(int argc, char **argv) {
    bool found = false;
    read_options(argc, argv);
    start = machine_image(options.image);
    runner = machine_open(false);
    stepper = machine_open(true);
    known = calloc(KNOWN, sizeof *known);
    if (known == NULL) {
        (void)fprintf(stderr, "sweep: no memory\n");
        return 2;
    }
    open_table();
    for (unsigned i = 0; i < WORLD_WINDOWS; i++) {
        if ((options.window == NULL) || (strcmp(options.window, WORLD[i].name) == 0)) {
            found = true;
            sweep_window(i);
            report(WORLD[i].name);
        }
    }
    if (!found) {
        usage();
    }
    if (sum.done == 0) {
        (void)fprintf(stderr, "sweep: no instruction of these windows and addresses was disturbed\n");
        return 2;
    }
    if (sum.verdicts[HARMFUL] == 0) {
        return 0;
    }
    for (uint32_t i = 0; i < HARMS; i++) {
        (void)printf("harm: %llu %s\n", (unsigned long long)sum.harms[i], harm_names[i]);
    }
    return 1;
}

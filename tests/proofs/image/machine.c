#include "machine.h"

#include <elf.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Blocks of instructions after which a call counts as endless: some 5 million instructions, where the longest call has 100,000. */
enum { BLOCKS_MAX = 1000000 };
enum { TRAP_SVC = 2, NO_TRAP = -1, OP_SVC = 0xDF00 };

struct machine {
    uc_engine *uc;
    uc_context *fresh;
    int trap;
    uint32_t blocks;
    board_t board;
    uint8_t *ram;
};

static _Alignas(4096) uint8_t flash[BOARD_FLASH_SIZE];
static start_t start;

static int names[MACHINE_REGISTERS + 1] = {UC_ARM_REG_R0,  UC_ARM_REG_R1,  UC_ARM_REG_R2,  UC_ARM_REG_R3, UC_ARM_REG_R4,
                                           UC_ARM_REG_R5,  UC_ARM_REG_R6,  UC_ARM_REG_R7,  UC_ARM_REG_R8, UC_ARM_REG_R9,
                                           UC_ARM_REG_R10, UC_ARM_REG_R11, UC_ARM_REG_R12, UC_ARM_REG_SP, UC_ARM_REG_LR,
                                           UC_ARM_REG_PC,  UC_ARM_REG_XPSR};

static void must(uc_err error, const char *what) {
    if (error != UC_ERR_OK) {
        (void)fprintf(stderr, "sweep: %s: %s\n", what, uc_strerror(error));
        exit(2);
    }
}

/* ---- The image ---- */

static void refuse(const char *path, const char *why) {
    (void)fprintf(stderr, "sweep: %s: %s (build the preset cortex-m)\n", path, why);
    exit(2);
}

/* The table of image.c at the beginning of the flash. */
static bool is_start(const start_t *found) {
    const uint32_t ram = BOARD_RAM;
    const uint32_t in_ram[] = {found->stack, found->latch, found->log, found->log_end};
    for (uint32_t i = 0; i < sizeof in_ram / sizeof in_ram[0]; i++) {
        if ((in_ram[i] < ram) || (in_ram[i] > ram + BOARD_RAM_SIZE - 16)) {
            return false;
        }
    }
    return (found->reset < BOARD_FLASH_SIZE) && (found->architecture >= 6) && (found->architecture <= 7) &&
           (found->topology <= 1);
}

const start_t *machine_image(const char *path) {
    static uint8_t file[4u << 20];
    Elf32_Ehdr head;
    FILE *const in = fopen(path, "rb");
    if (in == NULL) {
        refuse(path, "cannot be read");
    }
    const size_t size = fread(file, 1, sizeof file, in);
    (void)fclose(in);
    (void)memcpy(&head, file, sizeof head);
    if ((size < sizeof head) || (memcmp(head.e_ident, ELFMAG, SELFMAG) != 0) || (head.e_machine != EM_ARM)) {
        refuse(path, "not an image of a Cortex-M");
    }
    if ((head.e_phoff > size) || (head.e_phnum > (size - head.e_phoff) / sizeof(Elf32_Phdr))) {
        refuse(path, "is cut off");
    }
    for (uint32_t i = 0; i < head.e_phnum; i++) {
        Elf32_Phdr part;
        (void)memcpy(&part, &file[head.e_phoff + (i * sizeof part)], sizeof part);
        if ((part.p_type != PT_LOAD) || (part.p_filesz == 0)) {
            continue;
        }
        if ((part.p_paddr > sizeof flash) || (part.p_filesz > sizeof flash - part.p_paddr) || (part.p_offset > size) ||
            (part.p_filesz > size - part.p_offset)) {
            refuse(path, "does not fit into the flash");
        }
        (void)memcpy(&flash[part.p_paddr], &file[part.p_offset], part.p_filesz);
    }
    (void)memcpy(&start, flash, sizeof start);
    if (!is_start(&start)) {
        refuse(path, "is no image of tests/proofs/image");
    }
    return &start;
}

uint64_t machine_image_hash(void) {
    uint64_t hash = 0xCBF29CE484222325u;
    for (uint32_t i = 0; i < sizeof flash; i++) {
        hash = (hash ^ flash[i]) * 0x100000001B3u;
    }
    return hash;
}

static uint32_t half_at(uint32_t pc) {
    return (pc < sizeof flash - 1) ? (uint32_t)flash[pc] | ((uint32_t)flash[pc + 1] << 8) : 0;
}

uint32_t machine_length(uint32_t pc) {
    return (half_at(pc) >= 0xE800u) ? 4 : 2;
}

/* ---- The board ---- */

static uint32_t word_of(const uint8_t bytes[4]) {
    uint32_t word;
    (void)memcpy(&word, bytes, sizeof word);
    return word;
}

static uint64_t on_read(uc_engine *uc, uint64_t offset, unsigned size, void *context) {
    const board_t *const board = &((machine_t *)context)->board;
    const frame_t *const frame = world_frame(board->now_ms, board->received);
    (void)uc;
    (void)size;
    switch (offset) {
    case BOARD_NOW_MS:
        return board->now_ms;
    case BOARD_CAUSE:
        return board->cause;
    case BOARD_RX_WAITING:
        return (frame != NULL) ? 1 : 0;
    case BOARD_RX_SIDE:
        return (frame != NULL) ? frame->side : 0;
    case BOARD_RX_ID:
        return (frame != NULL) ? frame->id : 0;
    case BOARD_RX_LOW:
        return (frame != NULL) ? word_of(&frame->data[0]) : 0;
    case BOARD_RX_HIGH:
        return (frame != NULL) ? word_of(&frame->data[4]) : 0;
    default:
        return 0;
    }
}

static void on_write(uc_engine *uc, uint64_t offset, unsigned size, uint64_t value, void *context) {
    board_t *const board = &((machine_t *)context)->board;
    const uint32_t word = (uint32_t)value;
    (void)uc;
    (void)size;
    switch (offset) {
    case BOARD_RX_TAKEN:
        board->received++;
        break;
    case BOARD_TX_SIDE:
        board->sending.side = word;
        break;
    case BOARD_TX_ID:
        board->sending.id = word;
        break;
    case BOARD_TX_LENGTH:
        board->sending.length = word;
        break;
    case BOARD_TX_LOW:
        (void)memcpy(&board->sending.data[0], &word, sizeof word);
        break;
    case BOARD_TX_HIGH:
        (void)memcpy(&board->sending.data[4], &word, sizeof word);
        break;
    case BOARD_TX_SEND:
        world_sent(&board->bus, board->now_ms, &board->sending);
        break;
    case BOARD_OUTPUT:
        world_output(&board->bus, board->now_ms, (word & 1) != 0);
        break;
    case BOARD_FEED:
        board->fed_ms = board->now_ms;
        break;
    default:
        break;
    }
}

/* ---- The processor ---- */

static void on_trap(uc_engine *uc, uint32_t number, void *context) {
    ((machine_t *)context)->trap = (int)number;
    (void)uc_emu_stop(uc);
}

static void on_block(uc_engine *uc, uint64_t address, uint32_t size, void *context) {
    machine_t *const machine = context;
    (void)address;
    (void)size;
    machine->blocks++;
    if (machine->blocks > BLOCKS_MAX) {
        (void)uc_emu_stop(uc);
    }
}

/* Unicorn takes every function of a hook as a pointer to an object, which C has no conversion for. */
static void add_hook(machine_t *machine, int type, const void *function) {
    uc_hook hook;
    void *hooked = NULL;
    (void)memcpy((void *)&hooked, function, sizeof hooked);
    must(uc_hook_add(machine->uc, &hook, type, hooked, machine, 1, 0), "hook");
}

machine_t *machine_open(bool steps) {
    static void (*const trap)(uc_engine *, uint32_t, void *) = on_trap;
    static void (*const block)(uc_engine *, uint64_t, uint32_t, void *) = on_block;
    machine_t *const machine = calloc(1, sizeof *machine);
    void *const ram = aligned_alloc(4096, BOARD_RAM_SIZE);
    if ((machine == NULL) || (ram == NULL)) {
        refuse("Unicorn", "no memory");
    }
    machine->ram = ram;
    (void)memset(ram, 0, BOARD_RAM_SIZE);
    must(uc_open(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS, &machine->uc), "open");
    must(uc_ctl_set_cpu_model(machine->uc, (start.architecture == 6) ? UC_CPU_ARM_CORTEX_M0 : UC_CPU_ARM_CORTEX_M4),
         "processor");
    must(uc_mem_map_ptr(machine->uc, BOARD_FLASH, sizeof flash, UC_PROT_READ | UC_PROT_EXEC, flash), "flash");
    must(uc_mem_map_ptr(machine->uc, BOARD_RAM, BOARD_RAM_SIZE, UC_PROT_READ | UC_PROT_WRITE, ram), "RAM");
    must(uc_mmio_map(machine->uc, BOARD_REGISTERS, BOARD_REGISTERS_SIZE, on_read, machine, on_write, machine),
         "registers");
    add_hook(machine, UC_HOOK_INTR, (const void *)&trap);
    if (!steps) {
        add_hook(machine, UC_HOOK_BLOCK, (const void *)&block);
    }
    must(uc_context_alloc(machine->uc, &machine->fresh), "context");
    must(uc_context_save(machine->uc, machine->fresh), "context");
    return machine;
}

board_t *machine_board(machine_t *machine) {
    return &machine->board;
}

static void write_cpu(machine_t *machine, const cpu_t *cpu) {
    void *values[MACHINE_REGISTERS + 1];
    cpu_t copy = *cpu;
    for (uint32_t i = 0; i < MACHINE_REGISTERS; i++) {
        values[i] = &copy.r[i];
    }
    values[MACHINE_REGISTERS] = &copy.psr;
    copy.r[MACHINE_PC] |= 1;
    must(uc_reg_write_batch(machine->uc, names, values, MACHINE_REGISTERS + 1), "registers");
}

static void read_cpu(const machine_t *machine, cpu_t *cpu) {
    void *values[MACHINE_REGISTERS + 1];
    for (uint32_t i = 0; i < MACHINE_REGISTERS; i++) {
        values[i] = &cpu->r[i];
    }
    values[MACHINE_REGISTERS] = &cpu->psr;
    must(uc_reg_read_batch(machine->uc, names, values, MACHINE_REGISTERS + 1), "registers");
}

void machine_load(machine_t *machine, const snapshot_t *from) {
    must(uc_context_restore(machine->uc, machine->fresh), "context");
    write_cpu(machine, &from->cpu);
    machine->board = from->board;
    (void)memcpy(machine->ram, from->ram, BOARD_RAM_SIZE);
}

void machine_save(const machine_t *machine, snapshot_t *to) {
    read_cpu(machine, &to->cpu);
    to->board = machine->board;
    (void)memcpy(to->ram, machine->ram, BOARD_RAM_SIZE);
}

void machine_reset(machine_t *machine) {
    cpu_t cpu = {.psr = 1u << 24};
    cpu.r[MACHINE_SP] = start.stack;
    cpu.r[MACHINE_PC] = start.reset;
    must(uc_context_restore(machine->uc, machine->fresh), "context");
    write_cpu(machine, &cpu);
    (void)memset(machine->ram, 0, start.stack - (uint32_t)BOARD_RAM); /* what was on the stack is dead */
}

static uint32_t pc_of(const machine_t *machine) {
    uint32_t pc = 0;
    must(uc_reg_read(machine->uc, UC_ARM_REG_PC, &pc), "pc");
    return pc;
}

/* The one SVC of the image is its sleep; elsewhere in the flash there is none that is meant as code. */
static machine_end_t end_of(const machine_t *machine, uc_err error) {
    if (error != UC_ERR_OK) {
        return MACHINE_CRASHED;
    }
    if (machine->trap == TRAP_SVC) {
        return (half_at(pc_of(machine) - 2) == OP_SVC) ? MACHINE_SLEEPS : MACHINE_CRASHED;
    }
    return (machine->trap == NO_TRAP) ? MACHINE_GOES_ON : MACHINE_CRASHED;
}

static machine_end_t emulate(machine_t *machine, size_t instructions) {
    machine->trap = NO_TRAP;
    machine->blocks = 0;
    return end_of(machine, uc_emu_start(machine->uc, pc_of(machine) | 1, UINT32_MAX, 0, instructions));
}

machine_end_t machine_run(machine_t *machine) {
    const machine_end_t end = emulate(machine, 0);
    return (end == MACHINE_GOES_ON) ? MACHINE_HANGS : end;
}

/* ---- One instruction. Unicorn takes an IT block as one; here it is taken apart. ---- */

static uint32_t it_of(uint32_t psr) {
    return ((psr >> 25) & 3) | ((psr >> 8) & 0xFCu);
}

static uint32_t with_it(uint32_t psr, uint32_t it) {
    return (psr & ~0x0600FC00u) | ((it & 3) << 25) | ((it & 0xFCu) << 8);
}

static uint32_t next_it(uint32_t it) {
    return ((it & 7) == 0) ? 0 : ((it & 0xE0u) | ((it << 1) & 0x1Fu));
}

static bool is_it(uint32_t half) {
    return (start.architecture > 6) && ((half & 0xFF00u) == 0xBF00u) && ((half & 0xFu) != 0);
}

void machine_skip(cpu_t *cpu) {
    cpu->r[MACHINE_PC] += machine_length(cpu->r[MACHINE_PC]);
    cpu->psr = with_it(cpu->psr, next_it(it_of(cpu->psr)));
}

static bool holds(uint32_t condition, uint32_t psr) {
    const bool n = ((psr >> 31) & 1) != 0;
    const bool z = ((psr >> 30) & 1) != 0;
    const bool c = ((psr >> 29) & 1) != 0;
    const bool v = ((psr >> 28) & 1) != 0;
    const bool table[] = {z, c, n, v, c && !z, n == v, (n == v) && !z, true};
    return table[condition >> 1] != ((condition & 1) != 0);
}

/* In an IT block only comparisons among the 16-bit instructions set the flags. */
static bool keeps_flags(uint32_t half) {
    const bool compares = ((half & 0xF800u) == 0x2800u) || ((half & 0xFFC0u) == 0x4200u) ||
                          ((half & 0xFF80u) == 0x4280u) || ((half & 0xFF00u) == 0x4500u);
    return (half < 0xE800u) && !compares;
}

machine_end_t machine_step(machine_t *machine) {
    cpu_t cpu;
    read_cpu(machine, &cpu);
    const cpu_t before = cpu;
    const uint32_t pc = cpu.r[MACHINE_PC];
    const uint32_t it = it_of(cpu.psr);
    if (is_it(half_at(pc))) {
        cpu.r[MACHINE_PC] += 2;
        cpu.psr = with_it(cpu.psr, half_at(pc) & 0xFFu);
        write_cpu(machine, &cpu);
        return MACHINE_GOES_ON;
    }
    if (it == 0) {
        return emulate(machine, 1);
    }
    if (!holds(it >> 4, cpu.psr)) {
        machine_skip(&cpu);
        write_cpu(machine, &cpu);
        return MACHINE_GOES_ON;
    }
    cpu.psr = with_it(cpu.psr, 0);
    write_cpu(machine, &cpu);
    const machine_end_t end = emulate(machine, 1);
    read_cpu(machine, &cpu);
    if (keeps_flags(half_at(pc))) {
        cpu.psr = (cpu.psr & 0x0FFFFFFFu) | (before.psr & 0xF0000000u);
    }
    cpu.psr = with_it(cpu.psr, next_it(it));
    write_cpu(machine, &cpu);
    return end;
}

/* ---- Comparison ---- */

void machine_clear_dead_stack(machine_t *machine) {
    cpu_t cpu;
    read_cpu(machine, &cpu);
    const uint32_t sp = cpu.r[MACHINE_SP];
    if ((sp > BOARD_RAM) && (sp <= start.stack)) {
        (void)memset(machine->ram, 0, sp - (uint32_t)BOARD_RAM);
    }
}

static uint64_t mixed(uint64_t hash, uint64_t word) {
    const uint64_t product = (hash ^ word) * 0x9E3779B97F4A7C15u;
    return product ^ (product >> 29);
}

uint64_t machine_hash(const machine_t *machine) {
    cpu_t cpu;
    uint64_t lane[4] = {1, 2, 3, 4};
    read_cpu(machine, &cpu);
    for (uint32_t at = 0; at < BOARD_RAM_SIZE; at += (uint32_t)sizeof lane) {
        uint64_t words[4];
        if (((uint32_t)BOARD_RAM + at >= start.log) && ((uint32_t)BOARD_RAM + at + sizeof lane <= start.log_end)) {
            continue;
        }
        (void)memcpy(words, &machine->ram[at], sizeof words);
        for (uint32_t i = 0; i < 4; i++) {
            lane[i] = mixed(lane[i], words[i]);
        }
    }
    for (uint32_t i = 0; i < MACHINE_REGISTERS; i++) {
        lane[0] = mixed(lane[0], cpu.r[i]);
    }
    return mixed(mixed(mixed(mixed(cpu.psr, lane[0]), lane[1]), lane[2]), lane[3]);
}

/*
 * In place of three functions of Unicorn (2.0), which at every store look for translated code that it changes: no code is in this
 * RAM, and they would take most of the time. A version that has no such functions is slower, nothing else.
 */
void *page_collection_lock_arm(void);
void page_collection_unlock_arm(void);
void tb_invalidate_phys_page_fast_arm(void);

void *page_collection_lock_arm(void) {
    return NULL;
}

void page_collection_unlock_arm(void) {
}

void tb_invalidate_phys_page_fast_arm(void) {
}

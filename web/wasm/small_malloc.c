/*
 * Memory in blocks of powers of two, a list of free ones for each size: a tenth of the code of the C library's allocator,
 * which a module that is loaded over a network is better off without. A block begins with its size class.
 */
#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { HEADER = 16, SMALLEST = 5, CLASSES = 31 };

typedef struct block {
    uint32_t size_class; /* the block has 2^size_class bytes, HEADER included */
    struct block *next;  /* while it is free */
} block_t;

static block_t *unused[CLASSES];

/** The class of the smallest block that has room; CLASSES: there is none. */
static uint32_t class_of(size_t size) {
    uint32_t size_class = SMALLEST;
    while ((size_class < (uint32_t)CLASSES) && (((size_t)1u << size_class) - (size_t)HEADER < size)) {
        size_class++;
    }
    return size_class;
}

/** A new block from behind all others. */
static block_t *extend(uint32_t size_class) {
    static uint8_t *begin;
    static size_t left; /* bytes from there on */
    enum { PAGE = 65536 };
    const size_t size = (size_t)1u << size_class;
    if ((begin == NULL) || (left < size)) {
        const size_t more = (size - left + PAGE - 1u) / PAGE * PAGE;
        void *grown = sbrk((intptr_t)more);
        if ((intptr_t)grown == -1) {
            return NULL;
        }
        begin = (begin == NULL) ? grown : begin;
        left += more;
    }
    block_t *block = (void *)begin;
    begin += size;
    left -= size;
    block->size_class = size_class;
    return block;
}

void *malloc(size_t size) {
    const uint32_t size_class = class_of(size);
    block_t *block = (size_class < (uint32_t)CLASSES) ? unused[size_class] : NULL;
    if (block != NULL) {
        unused[size_class] = block->next;
    } else if (size_class < (uint32_t)CLASSES) {
        block = extend(size_class);
    }
    if (block == NULL) {
        errno = ENOMEM;
        return NULL;
    }
    return (uint8_t *)block + HEADER;
}

static block_t *block_of(void *memory) {
    return (void *)((uint8_t *)memory - HEADER);
}

void free(void *memory) {
    if (memory != NULL) {
        block_t *block = block_of(memory);
        block->next = unused[block->size_class];
        unused[block->size_class] = block;
    }
}

void *calloc(size_t count, size_t size) {
    const size_t all = count * size;
    void *memory = ((size == 0u) || (all / size == count)) ? malloc(all) : NULL;
    if (memory != NULL) {
        (void)memset(memory, 0, all);
    }
    return memory;
}

void *realloc(void *memory, size_t size) {
    if (memory == NULL) {
        return malloc(size);
    }
    const size_t room = ((size_t)1u << block_of(memory)->size_class) - (size_t)HEADER;
    if (size <= room) {
        return memory;
    }
    void *larger = malloc(size);
    if (larger != NULL) {
        (void)memcpy(larger, memory, room);
        free(memory);
    }
    return larger;
}

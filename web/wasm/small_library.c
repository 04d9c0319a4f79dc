/*
 * Functions of the C library that are shorter here: those of memory are one instruction, and what a page sorts is short or
 * in order, such as the identifiers of a log.
 */
#include <stdlib.h>
#include <string.h>

void *memcpy(void *restrict to, const void *restrict from, size_t size) {
    return __builtin_memcpy(to, from, size);
}

void *memmove(void *to, const void *from, size_t size) {
    return __builtin_memmove(to, from, size);
}

void *memset(void *to, int value, size_t size) {
    return __builtin_memset(to, value, size);
}

static void swap(char *one, char *other, size_t size) {
    for (size_t i = 0; i < size; i++) {
        const char byte = one[i];
        one[i] = other[i];
        other[i] = byte;
    }
}

void qsort(void *all, size_t count, size_t size, int (*compare)(const void *, const void *)) {
    char *const begin = all;
    for (size_t end = size; end < count * size; end += size) {
        for (size_t at = end; (at > 0) && (compare(&begin[at - size], &begin[at]) > 0); at -= size) {
            swap(&begin[at - size], &begin[at], size);
        }
    }
}

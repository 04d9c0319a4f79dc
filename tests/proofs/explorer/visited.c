#include "visited.h"

#include <stdlib.h>
#include <string.h>

enum { BUCKETS = 1 << 20, BLOCK = 1 << 14, BLOCKS = 1 << 12 };

static uint32_t bucket[BUCKETS];
static visited_t *block[BLOCKS];
static uint32_t count;
static uint32_t states;

void visited_begin(void) {
    for (uint32_t i = 0; i < count; i++) {
        free(visited_at(i)->model);
    }
    count = 0;
    states = 0;
    memset(bucket, 0xFF, sizeof bucket);
}

uint32_t visited_count(void) {
    return count;
}

uint32_t visited_states(void) {
    return states;
}

visited_t *visited_at(uint32_t index) {
    return &block[index / BLOCK][index % BLOCK];
}

static uint32_t hash_of(const abstract_t *key) {
    uint64_t hash = UINT64_C(0xCBF29CE484222325);
    for (unsigned i = 0; i < ABSTRACT_BYTES; i++) {
        hash = (hash ^ key->byte[i]) * UINT64_C(0x100000001B3);
    }
    return (uint32_t)(hash ^ (hash >> 32)) % BUCKETS;
}

static visited_t *append(void) {
    visited_t **room = &block[count / BLOCK];
    if ((count / BLOCK) >= BLOCKS) {
        return NULL;
    }
    if (*room == NULL) {
        *room = calloc(BLOCK, sizeof **room);
    }
    if (*room == NULL) {
        return NULL;
    }
    count++;
    return visited_at(count - 1);
}

static bool add(const abstract_t *key, uint32_t hash, uint32_t parent, unsigned symbol) {
    const uint32_t index = count;
    visited_t *v = append();
    model_saved_t *saved = malloc(sizeof *saved);
    if ((v == NULL) || (saved == NULL)) {
        free(saved);
        return false;
    }
    model_save(saved);
    *v = (visited_t){.key = *key,
                     .parent = parent,
                     .next = bucket[hash],
                     .depth = (uint16_t)((parent == VISITED_NONE) ? 0 : (visited_at(parent)->depth + 1)),
                     .symbol = (uint8_t)symbol,
                     .model = saved};
    bucket[hash] = index;
    return true;
}

bool visited_reached(uint32_t parent, unsigned symbol, unsigned representatives) {
    abstract_t key;
    abstract_now(&key);
    const uint32_t hash = hash_of(&key);
    unsigned known = 0;
    bool same_way = false;
    for (uint32_t i = bucket[hash]; i != VISITED_NONE; i = visited_at(i)->next) {
        const visited_t *v = visited_at(i);
        if (memcmp(&v->key, &key, sizeof key) == 0) {
            known++;
            same_way = same_way || (v->symbol == (uint8_t)symbol);
        }
    }
    if ((known >= representatives) || same_way) {
        return true;
    }
    states += (known == 0) ? 1 : 0;
    return add(&key, hash, parent, symbol);
}

unsigned visited_path(uint32_t index, uint8_t path[PATH_MAX_SYMBOLS]) {
    unsigned length = 0;
    for (uint32_t i = index; visited_at(i)->parent != VISITED_NONE; i = visited_at(i)->parent) {
        length++;
    }
    if (length > PATH_MAX_SYMBOLS) {
        abort();
    }
    unsigned at = length;
    for (uint32_t i = index; at > 0; i = visited_at(i)->parent) {
        at--;
        path[at] = visited_at(i)->symbol;
    }
    return length;
}

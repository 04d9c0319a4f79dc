/*
 * The abstract states in the order in which they were found, which is also the queue of the search. The model of a state
 * is kept until the state is explored; after that only the way to the state is kept.
 */
#ifndef VISITED_H
#define VISITED_H

#include <stdbool.h>
#include <stdint.h>

#include "abstract.h"
#include "model.h"

#define VISITED_NONE UINT32_MAX
enum { PATH_MAX_SYMBOLS = 400 };

typedef struct {
    abstract_t key;
    uint32_t parent; /* VISITED_NONE: the root */
    uint32_t next;   /* next entry with the same hash */
    uint16_t depth;
    uint8_t symbol; /* the last symbol of the way */
    model_saved_t *model;
} visited_t;

/* Remove all states. */
void visited_begin(void);

uint32_t visited_count(void);
visited_t *visited_at(uint32_t index);

/*
 * The search has reached the current model. It is added, unless enough models of its abstract state are known, or one of
 * them was reached by the same symbol.
 * @return false: no memory
 */
bool visited_reached(uint32_t parent, unsigned symbol, unsigned representatives);

/* Number of abstract states. */
uint32_t visited_states(void);

/* The symbols that lead to a state, oldest first. @return number of symbols */
unsigned visited_path(uint32_t index, uint8_t path[PATH_MAX_SYMBOLS]);

#endif

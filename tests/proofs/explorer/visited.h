/*
 * The abstract states that were found, in the order in which they were: that is the queue of the search, too. A model is
 * kept of each until it was explored; then only how it was reached.
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
    uint32_t next;   /* of the same hash */
    uint16_t depth;
    uint8_t symbol; /* by which it was reached */
    model_saved_t *model;
} visited_t;

/* Empty it. */
void visited_begin(void);

uint32_t visited_count(void);
visited_t *visited_at(uint32_t index);

/*
 * The model as it is was reached. It is added unless there are as many of its abstract state as are wanted, or one of
 * them did the same.
 * @return false: no memory
 */
bool visited_reached(uint32_t parent, unsigned symbol, unsigned representatives);

/* How many abstract states there are among them. */
uint32_t visited_states(void);

/* The symbols that lead there, oldest first. @return how many */
unsigned visited_path(uint32_t index, uint8_t path[PATH_MAX_SYMBOLS]);

#endif

/* Options of the programs of tests/proofs that select a part of the work: --shard I/N and --every N. */
#ifndef PART_H
#define PART_H

typedef struct {
    unsigned shard;  /* from 0 */
    unsigned shards; /* not 0 */
    unsigned every;  /* only every N-th item of the shard; not 0 */
} part_t;

/* Read the options; the default is all work. A wrong option ends the program with its usage and exit status 2. */
part_t part_read(const char *program, int argc, char **argv);

#endif

/* Which part of its work a program of tests/proofs does: --shard I/N and --every N. */
#ifndef PART_H
#define PART_H

typedef struct {
    unsigned shard;  /* from 0 */
    unsigned shards; /* not 0 */
    unsigned every;  /* of what belongs to the shard, each so-manieth; not 0 */
} part_t;

/* From the command line; without options all of it. What is wrong ends the program with the usage and status 2. */
part_t part_read(const char *program, int argc, char **argv);

#endif

#include "hunt/hunt_state.h"

#include <inttypes.h>
#include <string.h>

bool hunt_state_save(checkpoint_t *checkpoint, hunt_state_t *state, output_t *file) {
    const checkpoint_part_t parts[] = {{state, sizeof *state}};

    return checkpoint_save(checkpoint, file, parts, sizeof parts / sizeof parts[0]);
}

/** A hunt of fewer runs cannot take back those that are done. */
static bool check_end(const hunt_request_t *request, const hunt_state_t *state) {
    const uint64_t end =
        (state->pieces > 0) ? (((state->pieces - 1) * request->shards) + request->shard) * HUNT_PIECE_RUNS : 0;

    return (end <= request->runs) ||
           report("%s: its runs go up to %" PRIu64 ": give --runs %" PRIu64 " or more, or remove it to start over",
                  request->checkpoint, end, end);
}

bool hunt_state_load(const hunt_request_t *request, checkpoint_t *checkpoint, hunt_state_t *state, output_t *file) {
    const checkpoint_part_t parts[] = {{state, sizeof *state}};
    bool loaded = false;

    memset(state, 0, sizeof *state);
    *checkpoint = (checkpoint_t){
        .path = request->checkpoint,
        .kind = "hunt",
        .numbers = {request->seed, request->shard, request->shards},
    };
    return checkpoint_open(checkpoint, file) &&
           checkpoint_load(checkpoint, parts, sizeof parts / sizeof parts[0], &loaded) && check_end(request, state);
}

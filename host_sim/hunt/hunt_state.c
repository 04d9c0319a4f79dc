#include "hunt/hunt_state.h"

#include <inttypes.h>
#include <string.h>

#include "io/checkpoint.h"

/** Another hunt, or a program with other attacks, settings or faults, does not go on from it. */
static checkpoint_t checkpoint_of(const hunt_request_t *request) {
    return (checkpoint_t){
        .path = request->checkpoint,
        .kind = "hunt",
        .numbers = {request->seed, request->shard, request->shards, HUNT_ATTACK_COUNT, AGV_SETTING_COUNT,
                    AGV_FAULT_COUNT},
    };
}

bool hunt_state_save(const hunt_request_t *request, hunt_state_t *state, output_t *file) {
    const checkpoint_t checkpoint = checkpoint_of(request);
    const checkpoint_part_t parts[] = {{state, sizeof *state}};

    return checkpoint_save(&checkpoint, file, parts, sizeof parts / sizeof parts[0]);
}

/** A hunt of fewer runs cannot take back those that are done. */
static bool check_end(const hunt_request_t *request, const hunt_state_t *state) {
    const uint64_t end =
        (state->pieces > 0) ? (((state->pieces - 1) * request->shards) + request->shard) * HUNT_PIECE_RUNS : 0;

    return (end <= request->runs) ||
           report("%s: its runs go up to %" PRIu64 ": give --runs %" PRIu64 " or more, or remove it to start over",
                  request->checkpoint, end, end);
}

bool hunt_state_load(const hunt_request_t *request, hunt_state_t *state) {
    const checkpoint_t checkpoint = checkpoint_of(request);
    const checkpoint_part_t parts[] = {{state, sizeof *state}};
    bool loaded = false;

    memset(state, 0, sizeof *state);
    return checkpoint_load(&checkpoint, parts, sizeof parts / sizeof parts[0], &loaded) && check_end(request, state);
}

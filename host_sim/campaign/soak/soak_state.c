/* Checkpoints of a soak: its state and the whole testbed. */
#include "campaign/soak/soak_internal.h"

bool soak_save(soak_t *soak) {
    const checkpoint_part_t parts[] = {{&soak->state, sizeof soak->state}, {&soak->testbed, sizeof soak->testbed}};

    return checkpoint_save(&soak->checkpoint, &soak->file, parts, sizeof parts / sizeof parts[0]);
}

bool soak_load(soak_t *soak) {
    const soak_request_t *request = soak->request;
    const checkpoint_part_t parts[] = {{&soak->state, sizeof soak->state}, {&soak->saved, sizeof soak->saved}};
    bool loaded = false;

    soak->checkpoint = (checkpoint_t){
        .path = request->checkpoint,
        .kind = "soak",
        .numbers = {request->seed, request->hours, request->shard, request->shards},
    };
    const bool good = checkpoint_open(&soak->checkpoint, &soak->file) &&
                      checkpoint_load(&soak->checkpoint, parts, sizeof parts / sizeof parts[0], &loaded);
    if (loaded) {
        scenario_testbed_restore(&soak->testbed, &soak->saved);
    }
    return good;
}

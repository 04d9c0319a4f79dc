/**
 * @file hunt_state.h
 * Checkpoints of a hunt: how many pieces are done, in which time, and what was found in them.
 */
#ifndef HOST_SIM_HUNT_STATE_H
#define HOST_SIM_HUNT_STATE_H

#include "hunt/hunt.h"
#include "hunt/hunt_found.h"
#include "io/checkpoint.h"

/** What is kept. */
typedef struct {
    uint64_t pieces;     /**< of this shard that are done, each a whole one */
    uint64_t virtual_ms; /**< that they simulated */
    uint64_t spent_ms;
    uint64_t processor_ms;
    hunt_found_t found;
} hunt_state_t;

/** Write it. Nothing without a checkpoint. @return false: reported */
bool hunt_state_save(checkpoint_t *checkpoint, hunt_state_t *state, output_t *file);

/**
 * Open the checkpoint, for checkpoint_close() at the end, and resume from it if something is saved in it.
 * @return false: it cannot be written, is in use, belongs to another hunt or program, or goes on after this one's end;
 *         reported
 */
bool hunt_state_load(const hunt_request_t *request, checkpoint_t *checkpoint, hunt_state_t *state, output_t *file);

#endif

/**
 * @file hunt_found.h
 * The hazards that a hunt found: each kind of attack once, with as little of it as is needed, as a scenario file.
 */
#ifndef HOST_SIM_HUNT_FOUND_H
#define HOST_SIM_HUNT_FOUND_H

#include "hunt/hunt_play.h"
#include "io/output.h"

enum {
    HUNT_FOUND_MAX = 1000,
    HUNT_CAUSE_SIZE = 64,
    HUNT_ATTACK_WORDS = 2,
    HUNT_SETTING_WORDS = 4,
    HUNT_CLASS_WORDS = 2
};

/** What distinguishes one hazard from another. */
typedef struct {
    uint32_t kind;
    uint32_t gateway;
    char cause[HUNT_CAUSE_SIZE];
    uint64_t attacks[HUNT_ATTACK_WORDS];  /**< one bit a row of HUNT_ATTACKS */
    uint64_t patterns[HUNT_ATTACK_WORDS]; /**< of those with bad frames and good ones in turn */
    uint64_t settings[HUNT_SETTING_WORDS];
    uint64_t classes[HUNT_CLASS_WORDS];
    uint64_t run;  /**< the first that found it */
    uint64_t more; /**< others since */
} hunt_signature_t;

/** All that were found. */
typedef struct {
    hunt_signature_t items[HUNT_FOUND_MAX];
    uint32_t count;
    uint64_t runs; /**< in which there was a hazard */
} hunt_found_t;

/** Where a hazard is written to. */
typedef struct {
    const char *folder;
    uint64_t seed;
    uint64_t run;
    uint64_t spent_ms;
    output_t *file;
} hunt_place_t;

/**
 * A run of @p program ended in a hazard (of @p play). If it is a new one: drop what is not needed, write it, print a
 * line.
 * @return false: it could not be written; reported
 */
bool hunt_found_take(hunt_found_t *found, hunt_play_t *play, const hunt_program_t *program, const hunt_place_t *place);

#endif

/**
 * @file hunt_attacks.h
 * What an attacker can do: a table of attacks. Each has parameters, and is written as steps of a scenario.
 */
#ifndef HOST_SIM_HUNT_ATTACKS_H
#define HOST_SIM_HUNT_ATTACKS_H

#include <stddef.h>
#include <stdint.h>

#include "agv/protocol.h"

#define HUNT_PARAMETERS 4u
#define HUNT_PATTERN_BAD 2u  /**< the parameter: so many bad frames */
#define HUNT_PATTERN_GOOD 3u /**< and good ones */
#define HUNT_ENGAGE_AFTER 2u /**< of a reset: so many ms after its begin the autopilot is engaged */

/** @name Conditions and parameters of an attack. @{ */
#define HUNT_GATEWAY 0x01u /**< only in the gateway topology */
#define HUNT_MESSAGE 0x02u /**< its first parameter is a message */
#define HUNT_PATTERN 0x04u /**< its third and fourth are: so many frames bad (0: all), so many good, again and again */
#define HUNT_SHORT_BYTES 0x08u /**< its fourth is a length; more than 8 counts as 8 */
#define HUNT_VALUE 0x10u       /**< a field of its message has a wrong value */
/** @} */

/** A parameter: one of its words, or a number. */
typedef struct {
    const char *words; /**< divided by `|`; NULL: a number */
    uint32_t lowest;
    uint32_t highest;
} hunt_parameter_t;

/**
 * An attack. In the steps `|` divides; `+N ` or `+$b ` before a step: so many ms after the begin; and these stand for
 * something: `$a` .. `$d` a parameter (its word where it has words), `$n` the node that sends the message, `$v` the one
 * that receives it, `$t` its cycle, `$e` a cycle lengthened by the second parameter (in steps of a twentieth), `$f` the
 * pattern, `$r` again every $b ms, `$w` again every two times $c ms, `$g` every $d ms, `$s` the AI computer's side,
 * `$y` bytes ($c and its length), `$z` $c less 90, `$i` an identifier that no status message has, `$k` the time to the
 * message's next slot.
 */
typedef struct {
    const char *name;
    uint32_t flags;
    agv_message_t message; /**< with HUNT_VALUE */
    const char *begin;     /**< steps */
    const char *end;       /**< steps; NULL: none */
    hunt_parameter_t parameters[HUNT_PARAMETERS];
} hunt_attack_t;

/** One bit each in two words of hunt_signature_t. */
#define HUNT_ATTACKS_MAX 128u

extern const hunt_attack_t HUNT_ATTACKS[];
extern const size_t HUNT_ATTACK_COUNT; /**< at most HUNT_ATTACKS_MAX */

#endif

/*
 * What a conversion to an unsigned type does (C11 6.3.1.3): it adds or subtracts 2^32 or 2^16 until the value fits. frama-c's
 * WP knows the range of the result, not its value. The two lines of to_32_bits and to_16_bits are the only ones of this proof
 * that are taken for granted.
 */
#ifndef PROOF_UNBOUNDED_ARITHMETIC_H
#define PROOF_UNBOUNDED_ARITHMETIC_H

#include <stdint.h>

/*@ logic integer wraps32(integer x) = (x - (uint32_t)x) / 4294967296;
    logic integer wraps16(integer x) = (x - (uint16_t)x) / 65536;
    admit lemma to_32_bits: \forall integer x; x == (uint32_t)x + 4294967296 * wraps32(x);
    admit lemma to_16_bits: \forall integer x; x == (uint16_t)x + 65536 * wraps16(x);

    // These are proven. An age after a step of the clock; the time until a later one.
    lemma older: \forall integer now, time, since; 0 <= now <= 0xFFFFFFFF && 0 <= time <= 0xFFFFFFFF &&
        0 <= since <= 65535 && (uint16_t)(now - since) + (uint32_t)(time - now) <= 65535 ==>
            (uint16_t)(time - since) == (uint16_t)(now - since) + (uint32_t)(time - now);
    lemma nearer: \forall integer now, time, due; 0 <= now <= 0xFFFFFFFF && 0 <= time <= 0xFFFFFFFF &&
        0 <= due <= 0xFFFFFFFF && (uint32_t)(time - now) <= (uint32_t)(due - now) ==>
            (uint32_t)(due - time) == (uint32_t)(due - now) - (uint32_t)(time - now);
*/

/*@ // Masks of the state machine, bit by bit. These are proven, too.
    lemma confirmed_bits: \forall integer f; (f & 0xC000) == 0xC000 <==> (f & 0x4000) != 0 && (f & 0x8000) != 0;
    lemma none_of: \forall integer x; (x & 0x5B6) == 0 <==>
        (x & 0x02) == 0 && (x & 0x04) == 0 && (x & 0x10) == 0 && (x & 0x20) == 0 && (x & 0x80) == 0 &&
        (x & 0x100) == 0 && (x & 0x400) == 0;
    lemma none_of_init: \forall integer x; (x & 0x4A6) == 0 <==>
        (x & 0x02) == 0 && (x & 0x04) == 0 && (x & 0x20) == 0 && (x & 0x80) == 0 && (x & 0x400) == 0;
*/

#endif

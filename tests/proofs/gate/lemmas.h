/*
 * Two facts on bits that the provers do not find by themselves. They are proven on their own, by trying all 256 values of
 * a byte, before anything else uses them.
 */
#ifndef PROOF_GATE_LEMMAS_H
#define PROOF_GATE_LEMMAS_H

/*@ lemma every_bit: \forall integer byte; 0 <= byte <= 255 ==> (255 & byte) == byte;
    lemma shifted: \forall integer byte; 0 <= byte <= 255 ==> (byte << 8) == 256 * byte;
*/

#endif

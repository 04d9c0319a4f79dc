/*
 * The latch record (FSM-7) as a contract in ACSL: every content of the store, and every record that is written. Written from
 * docs/requirements.md. A compiler sees declarations only.
 */
#ifndef PROOF_UNBOUNDED_LATCH_H
#define PROOF_UNBOUNDED_LATCH_H

#include <stddef.h>

#include "keep/latch.h"

/*@ // The checksum may be any function of the four bytes before it.
    axiomatic crc { logic integer crc(integer a, integer b, integer c, integer d); }

    predicate sealed{L}(agv_latch_t *r) =
        r->version == 1 && r->checksum == (uint32_t)~crc(r->latched, r->first_reason, r->unresettable, r->version);
    predicate same_record{L}(agv_latch_t *a, agv_latch_t *b) =
        a->latched == b->latched && a->first_reason == b->first_reason && a->unresettable == b->unresettable &&
        a->version == b->version && a->checksum == b->checksum;
*/

// The store: as many bytes as were stored, and the record when they are its 8 bytes.
/*@ ghost size_t kept_size; */
/*@ ghost agv_latch_t kept; */

/*@ // Only a sealed record of this layout counts. All else leaves the caller's record as it was.
    requires \valid(latch) && \separated(latch, &kept, &kept_size);
    assigns *latch;
    ensures \result == AGV_LATCH_NOTHING <==> kept_size == 0;
    ensures \result == AGV_LATCH_VALID <==> kept_size == 8 && sealed(&kept);
    ensures \result == AGV_LATCH_NOTHING || \result == AGV_LATCH_VALID || \result == AGV_LATCH_CORRUPT;
    ensures \result == AGV_LATCH_VALID ==> same_record(latch, &kept);
    ensures \result != AGV_LATCH_VALID ==> *latch == \old(*latch);
*/
agv_latch_found_t agv_latch_read(hal_t *hal, agv_latch_t *latch);

/*@ // What is written is valid when it is read again, and the same.
    requires first_reason <= 255 && unresettable <= 255;
    assigns kept, kept_size;
    ensures kept_size == 8 && sealed(&kept);
    ensures kept.latched == latched && kept.first_reason == first_reason && kept.unresettable == unresettable;
*/
void agv_latch_write(hal_t *hal, uint8_t latched, uint32_t first_reason, uint32_t unresettable);

#endif

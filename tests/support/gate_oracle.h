/*
 * The expected decision of the gate for one frame, by the oracle and the throttle ceiling. For a gate that is tested
 * alone, without the last 363h and without the end of an engagement.
 */
#ifndef GATE_ORACLE_H
#define GATE_ORACLE_H

#include "oracle.h"
#include "transmit/gate.h"

oracle_t gate_oracle(const agv_gate_t *gate);

/* Whether this frame may be sent. @param oracle made by gate_oracle() for this gate */
bool gate_oracle_allows(const oracle_t *oracle, const agv_gate_t *gate, hal_can_side_t side,
                        const hal_can_frame_t *frame);

#endif

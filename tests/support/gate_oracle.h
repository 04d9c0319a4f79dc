/*
 * What the gate has to say to one frame, by the oracle and the throttle ceiling. For a gate that is asked alone: it knows
 * nothing of the last 363h, nor of an engagement that has ended.
 */
#ifndef GATE_ORACLE_H
#define GATE_ORACLE_H

#include "oracle.h"
#include "transmit/gate.h"

oracle_t gate_oracle(const agv_gate_t *gate);

/* Whether this frame may leave. @param oracle as gate_oracle() has made it for this gate */
bool gate_oracle_allows(const oracle_t *oracle, const agv_gate_t *gate, hal_can_side_t side,
                        const hal_can_frame_t *frame);

#endif

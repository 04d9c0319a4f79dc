/* What frama-c is given: the contract, then the shipped sources as they are. */
#include "contract.h"

#include "gate.c"
#include "message.c"
#include "state.c"

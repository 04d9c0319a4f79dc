/* What frama-c is given: the contract, then the shipped sources as they are. */
#include "contract.h"

#include "base/message.c"
#include "base/state.c"
#include "transmit/gate.c"

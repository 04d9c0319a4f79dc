/* What Unity calls after each test, in the build tree of tests/proofs/mutation: one failure is enough to know a mutant. */
#include <stdio.h>
#include <stdlib.h>

#include "unity.h"

void agv_stop_at_failure(void);

void agv_stop_at_failure(void) {
    (void)fflush(stdout); /* what was printed is not lost in a crash */
    if ((Unity.TestFailures != 0) && (getenv("AGV_MUTATION_GO_ON") == NULL)) {
        exit(1);
    }
}

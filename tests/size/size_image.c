/* What scripts/tools/size.py measures: the core behind its entry points (kept by the linker), and one supervisor. */
#include "agv/supervisor.h"

agv_supervisor_t agv_size_supervisor; /* its size in the object file is what a supervisor needs */

int main(void) {
    return 0;
}

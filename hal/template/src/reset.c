/* hal/reset.h: the cause of the last reset. */
#include "hal/reset.h"

#include "hal_template/hal_template.h"

hal_reset_cause_t hal_reset_cause(hal_t *hal) {
    return hal->reset_cause;
}

/* The template port. */
#include "hal/reset.h"
#include "hal_template/hal_template.h"
#include "unity.h"

/* An unknown reset cause is never reported as a power-on. */
/* Shows: FSM-7 */
void test_an_unwritten_port_does_not_claim_a_power_on(void) {
    struct hal hal;
    hal_template_init(&hal);
    TEST_ASSERT_EQUAL_INT(HAL_RESET_UNKNOWN, hal_reset_cause(&hal));
}

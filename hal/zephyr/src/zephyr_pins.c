/* hal/safety_output.h, hal/led.h and hal/inputs.h. */
#include <zephyr/init.h>

#include "zephyr_hal_internal.h"

static const struct gpio_dt_spec output = GPIO_DT_SPEC_GET(ZEPHYR_HAL_NODE, safety_output_gpios);
static const struct gpio_dt_spec feedback = GPIO_DT_SPEC_GET_OR(ZEPHYR_HAL_NODE, feedback_gpios, {0});
static const struct gpio_dt_spec stop = GPIO_DT_SPEC_GET_OR(ZEPHYR_HAL_NODE, estop_gpios, {0});
static const struct gpio_dt_spec button = GPIO_DT_SPEC_GET_OR(ZEPHYR_HAL_NODE, reset_gpios, {0});
static const struct gpio_dt_spec led = GPIO_DT_SPEC_GET(DT_PHANDLE(ZEPHYR_HAL_NODE, alarm_led), gpios);

static bool output_is_set_up;

/* Runs as soon as the pins work: before any other driver, and long before main(). Some drivers refuse an output that is read. */
static int open_output_at_boot(void) {
    int status = -ENODEV;
    if (gpio_is_ready_dt(&output)) {
        status = gpio_pin_configure_dt(&output, GPIO_OUTPUT_INACTIVE | GPIO_INPUT);
        status = (status == -ENOTSUP) ? gpio_pin_configure_dt(&output, GPIO_OUTPUT_INACTIVE) : status;
    }
    output_is_set_up = status == 0;
    return status;
}

BUILD_ASSERT(CONFIG_GPIO_INIT_PRIORITY < CONFIG_AGV_OUTPUT_INIT_PRIORITY,
             "the GPIO driver must be initialised before the output");
SYS_INIT(open_output_at_boot, POST_KERNEL, CONFIG_AGV_OUTPUT_INIT_PRIORITY);

bool zephyr_hal_output_is_open(void) {
    return output_is_set_up && (gpio_pin_get_dt(&output) == 0);
}

/* Not by gpio_pin_set_dt(): an assertion that fails in it would call this function again. */
void zephyr_output_open_now(void) {
    if (!gpio_is_ready_dt(&output)) {
        return;
    }
    if ((output.dt_flags & GPIO_ACTIVE_LOW) != 0u) {
        (void)gpio_port_set_bits_raw(output.port, BIT(output.pin));
    } else {
        (void)gpio_port_clear_bits_raw(output.port, BIT(output.pin));
    }
}

void hal_safety_output_set(hal_t *hal, bool closed) {
    ARG_UNUSED(hal);
    (void)gpio_pin_set_dt(&output, closed ? 1 : 0);
}

bool zephyr_led_start(void) {
    return gpio_is_ready_dt(&led) && (gpio_pin_configure_dt(&led, GPIO_OUTPUT_INACTIVE) == 0);
}

void hal_led_set(hal_t *hal, bool on) {
    ARG_UNUSED(hal);
    (void)gpio_pin_set_dt(&led, on ? 1 : 0);
}

static bool start_input(const struct gpio_dt_spec *input) {
    return (input->port == NULL) || (gpio_is_ready_dt(input) && (gpio_pin_configure_dt(input, GPIO_INPUT) == 0));
}

bool zephyr_inputs_start(void) {
    const bool feedback_works = start_input(&feedback);
    const bool stop_works = start_input(&stop);
    return start_input(&button) && feedback_works && stop_works;
}

/* A pin that cannot be read is a broken input. */
static uint8_t contact(const struct gpio_dt_spec *input) {
    if (input->port == NULL) {
        return (uint8_t)HAL_CONTACT_NONE;
    }
    const int level = gpio_pin_get_dt(input);
    if (level < 0) {
        return UINT8_MAX;
    }
    return (uint8_t)((level == 1) ? HAL_CONTACT_CLOSED : HAL_CONTACT_OPEN);
}

void hal_inputs_read(hal_t *hal, hal_inputs_t *inputs) {
    ARG_UNUSED(hal);
    *inputs = (hal_inputs_t){
        .output_feedback = contact(&feedback), .emergency_stop = contact(&stop), .reset_button = contact(&button)};
}

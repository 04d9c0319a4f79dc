#include "fake_parts.h"

#include <string.h>

#include <zephyr/drivers/can/can_fake.h>
#include <zephyr/drivers/counter.h>
#include <zephyr/drivers/gpio/gpio_emul.h>
#include <zephyr/drivers/hwinfo.h>
#include <zephyr/drivers/watchdog.h>
#include <zephyr/irq_offload.h>
#include <zephyr/kernel.h>

#include "vehicle.h"

DEFINE_FFF_GLOBALS;

fake_bus_t fake_buses[HAL_CAN_SIDES];

static fake_bus_t *bus_of(const struct device *device) {
    return (device == fake_buses[HAL_CAN_VEHICLE].device) ? &fake_buses[HAL_CAN_VEHICLE] : &fake_buses[HAL_CAN_AI];
}

static int start(const struct device *device) {
    fake_bus_t *const bus = bus_of(device);
    if ((bus->start_error != 0) || bus->started) {
        return (bus->start_error != 0) ? bus->start_error : -EALREADY;
    }
    bus->started = true;
    bus->state = CAN_STATE_ERROR_ACTIVE;
    return 0;
}

static void end_of_bus(fake_bus_t *bus) {
    bus->state_callback(bus->device, CAN_STATE_BUS_OFF, (struct can_bus_err_cnt){0}, bus->state_data);
}

/* Reports more than Zephyr's drivers do: also the stop. */
static int stop(const struct device *device) {
    fake_bus_t *const bus = bus_of(device);
    bus->stops++;
    if (bus->stop_error != 0) {
        return bus->stop_error;
    }
    if (bus->bus_off_at_stop) {
        end_of_bus(bus);
    }
    if (bus->sends_at_stop) {
        bus->in_mailbox = 0u;
        bus->sent_callback(device, 0, bus->sent_data);
    }
    bus->started = false;
    bus->state = CAN_STATE_STOPPED;
    bus->state_callback(device, CAN_STATE_STOPPED, (struct can_bus_err_cnt){0}, bus->state_data);
    if (bus->in_mailbox > 0u) {
        bus->in_mailbox = 0u;
        if (!bus->is_late) {
            bus->sent_callback(device, -ENETDOWN, bus->sent_data);
        }
    }
    return 0;
}

static int get_capabilities(const struct device *device, can_mode_t *able) {
    *able = bus_of(device)->able;
    return 0;
}

static int set_mode(const struct device *device, can_mode_t mode) {
    bus_of(device)->mode = mode;
    return 0;
}

static int set_timing(const struct device *device, const struct can_timing *timing) {
    bus_of(device)->timing = *timing;
    return 0;
}

static int get_core_clock(const struct device *device, uint32_t *rate) {
    ARG_UNUSED(device);
    *rate = MHZ(80);
    return 0;
}

static int add_rx_filter(const struct device *device, can_rx_callback_t callback, void *data,
                         const struct can_filter *filter) {
    fake_bus_t *const bus = bus_of(device);
    if (bus->filters == bus->filter_limit) {
        return -ENOSPC;
    }
    bus->filter[bus->filters] = *filter;
    bus->receive[bus->filters] = callback;
    bus->receive_data[bus->filters] = data;
    return (int)bus->filters++;
}

static void complete(const void *argument) {
    fake_bus_t *const bus = (fake_bus_t *)argument;
    bus->in_mailbox--;
    bus->sent_callback(bus->device, 0, bus->sent_data);
}

static int send(const struct device *device, const struct can_frame *frame, k_timeout_t timeout,
                can_tx_callback_t callback, void *data) {
    fake_bus_t *const bus = bus_of(device);
    if (!bus->started) {
        return -ENETDOWN;
    }
    if (!K_TIMEOUT_EQ(timeout, K_NO_WAIT) || (bus->send_error != 0)) {
        return (bus->send_error != 0) ? bus->send_error : -EINVAL; /* the caller must not wait */
    }
    bus->sent[bus->sent_count % FAKE_SENT_MAX] = *frame;
    bus->sent_count++;
    bus->sent_callback = callback;
    bus->sent_data = data;
    bus->in_mailbox++;
    if (bus->sends_at_once) {
        irq_offload(complete, bus);
    }
    return 0;
}

static int get_state(const struct device *device, enum can_state *state, struct can_bus_err_cnt *errors) {
    if (state != NULL) {
        *state = bus_of(device)->state;
    }
    if (errors != NULL) {
        *errors = (struct can_bus_err_cnt){0};
    }
    return 0;
}

static int recover(const struct device *device, k_timeout_t timeout) {
    ARG_UNUSED(timeout);
    bus_of(device)->recoveries++;
    return 0;
}

static void set_state_callback(const struct device *device, can_state_change_callback_t callback, void *data) {
    bus_of(device)->state_callback = callback;
    bus_of(device)->state_data = data;
}

static void reset_buses(void) {
    static const struct device *const devices[HAL_CAN_SIDES] = {DEVICE_DT_GET(DT_NODELABEL(test_vehicle_can)),
                                                                DEVICE_DT_GET(DT_NODELABEL(test_ai_can))};
    for (size_t i = 0u; i < HAL_CAN_SIDES; i++) {
        fake_buses[i] = (fake_bus_t){.device = devices[i],
                                     .able = CAN_MODE_MANUAL_RECOVERY | CAN_MODE_LISTENONLY,
                                     .filter_limit = FAKE_FILTERS_MAX,
                                     .state = CAN_STATE_STOPPED};
    }
}

void fake_parts_connect(void) {
    fake_can_start_fake.custom_fake = start;
    fake_can_stop_fake.custom_fake = stop;
    fake_can_get_capabilities_fake.custom_fake = get_capabilities;
    fake_can_set_mode_fake.custom_fake = set_mode;
    fake_can_set_timing_fake.custom_fake = set_timing;
    fake_can_get_core_clock_fake.custom_fake = get_core_clock;
    fake_can_add_rx_filter_fake.custom_fake = add_rx_filter;
    fake_can_send_fake.custom_fake = send;
    fake_can_get_state_fake.custom_fake = get_state;
    fake_can_recover_fake.custom_fake = recover;
    fake_can_set_state_change_callback_fake.custom_fake = set_state_callback;
}

void fake_parts_reset(void) {
    reset_buses();
    fake_parts_connect();
    fake_watchdog_feeds = 0u;
    fake_reset_flags = RESET_POR;
    fake_reset_error = 0;
    fake_reset_supported = RESET_POR | RESET_BROWNOUT;
    fake_reset_reads = 0u;
    fake_reset_clears = 0u;
}

typedef struct {
    fake_bus_t *bus;
    struct can_frame frame;
} arrival_t;

static void arrive(const void *argument) {
    arrival_t *const arrival = (arrival_t *)argument;
    fake_bus_t *const bus = arrival->bus;
    for (uint32_t i = 0u; i < bus->filters; i++) {
        if (can_frame_matches_filter(&arrival->frame, &bus->filter[i])) {
            bus->receive[i](bus->device, &arrival->frame, bus->receive_data[i]);
        }
    }
}

void fake_bus_frame(hal_can_side_t side, const struct can_frame *frame) {
    arrival_t arrival = {.bus = &fake_buses[side], .frame = *frame};
    irq_offload(arrive, &arrival);
}

void vehicle_sends(const struct can_frame *frame) {
    fake_bus_frame(HAL_CAN_VEHICLE, frame);
}

void fake_bus_complete(hal_can_side_t side, int error) {
    fake_bus_t *const bus = &fake_buses[side];
    bus->in_mailbox--;
    bus->sent_callback(bus->device, error, bus->sent_data);
}

void fake_bus_state(hal_can_side_t side, enum can_state state, bool with_interrupt) {
    fake_bus_t *const bus = &fake_buses[side];
    bus->state = state;
    if (with_interrupt) {
        bus->state_callback(bus->device, state, (struct can_bus_err_cnt){0}, bus->state_data);
    }
}

/* The watchdog. */
uint32_t fake_watchdog_feeds;
uint32_t fake_watchdog_ms;
bool fake_watchdog_started;
fake_window_watchdog_t fake_window_watchdog;

static bool is_window(const struct device *device) {
    return device == DEVICE_DT_GET(DT_NODELABEL(test_window_watchdog));
}

static int watchdog_setup(const struct device *device, uint8_t options) {
    ARG_UNUSED(options);
    if (is_window(device)) {
        fake_window_watchdog.fed_ms = k_uptime_get_32();
    } else {
        fake_watchdog_started = true;
    }
    return 0;
}

static int watchdog_disable(const struct device *device) {
    ARG_UNUSED(device);
    return -EPERM;
}

static int watchdog_install(const struct device *device, const struct wdt_timeout_cfg *config) {
    if (is_window(device)) {
        fake_window_watchdog.opens_ms = config->window.min;
        fake_window_watchdog.expires_ms = config->window.max;
    } else {
        fake_watchdog_ms = config->window.max;
    }
    return 0;
}

static void feed_window_watchdog(void) {
    fake_window_watchdog_t *const fed = &fake_window_watchdog;
    const uint32_t now_ms = k_uptime_get_32();
    const uint32_t passed_ms = now_ms - fed->fed_ms;
    fed->outside += ((passed_ms < fed->opens_ms) || (passed_ms > fed->expires_ms)) ? 1u : 0u;
    fed->fed_ms = now_ms;
    fed->feeds++;
}

static int watchdog_feed(const struct device *device, int channel) {
    ARG_UNUSED(channel);
    if (is_window(device)) {
        feed_window_watchdog();
    } else {
        fake_watchdog_feeds++;
    }
    return 0;
}

static const struct wdt_driver_api watchdog_api = {
    .setup = watchdog_setup, .disable = watchdog_disable, .install_timeout = watchdog_install, .feed = watchdog_feed};

#define WATCHDOG(node)                                                                                                 \
    DEVICE_DT_DEFINE(node, NULL, NULL, NULL, NULL, POST_KERNEL, CONFIG_KERNEL_INIT_PRIORITY_DEVICE, &watchdog_api);
DT_FOREACH_STATUS_OKAY(agv_test_watchdog, WATCHDOG)

/* The reset flags. */
uint32_t fake_reset_flags;
int fake_reset_error;
uint32_t fake_reset_supported = RESET_POR | RESET_BROWNOUT;
uint32_t fake_reset_reads;
uint32_t fake_reset_clears;

int z_impl_hwinfo_get_reset_cause(uint32_t *cause) {
    fake_reset_reads++;
    *cause = fake_reset_flags;
    return fake_reset_error;
}

int z_impl_hwinfo_get_supported_reset_cause(uint32_t *supported) {
    *supported = fake_reset_supported;
    return (fake_reset_supported != 0u) ? 0 : -ENOSYS;
}

int z_impl_hwinfo_clear_reset_cause(void) {
    fake_reset_clears++;
    fake_reset_flags = 0u;
    return 0;
}

/* The counter. */
uint32_t fake_counter_value;
uint32_t fake_counter_hz = 32768u;
uint32_t fake_counter_top = UINT32_MAX;
int fake_counter_error;

#if DT_HAS_COMPAT_STATUS_OKAY(agv_test_counter) && defined(CONFIG_COUNTER)
static int counter_ok(const struct device *device) {
    ARG_UNUSED(device);
    return 0;
}

static int counter_value(const struct device *device, uint32_t *value) {
    ARG_UNUSED(device);
    *value = fake_counter_value;
    return fake_counter_error;
}

static uint32_t counter_top(const struct device *device) {
    ARG_UNUSED(device);
    return fake_counter_top;
}

static uint32_t counter_hz(const struct device *device) {
    ARG_UNUSED(device);
    return fake_counter_hz;
}

static const struct counter_driver_api counter_api = {.start = counter_ok,
                                                      .stop = counter_ok,
                                                      .get_value = counter_value,
                                                      .get_top_value = counter_top,
                                                      .get_freq = counter_hz};

/* A device says in its configuration whether it counts up: so it lies in RAM here. */
static struct counter_config_info counter_config = {.flags = COUNTER_CONFIG_INFO_COUNT_UP};

DEVICE_DT_DEFINE(DT_NODELABEL(test_counter), NULL, NULL, NULL, &counter_config, POST_KERNEL,
                 CONFIG_KERNEL_INIT_PRIORITY_DEVICE, &counter_api);

void fake_counter_direction(bool up) {
    counter_config.flags = up ? COUNTER_CONFIG_INFO_COUNT_UP : 0u;
}
#endif

/* The pins. */
enum { PIN_LED = 0, PIN_OUTPUT = 1 };

static const struct device *const pins = DEVICE_DT_GET(DT_NODELABEL(test_pins));

bool fake_output_is_closed(void) {
    return gpio_emul_output_get(pins, PIN_OUTPUT) == 1;
}

void fake_input_set(fake_input_t input, bool high) {
    (void)gpio_emul_input_set(pins, (gpio_pin_t)input, high ? 1 : 0);
}

bool fake_led_is_on(void) {
    return gpio_emul_output_get(pins, PIN_LED) == 1;
}

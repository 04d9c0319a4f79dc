#include "fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "agv/names.h"
#include "unity.h"

enum { STANDBY_WITHIN_MS = 1000, ENGAGED_MS = 1000, UNKNOWN_ID = 0x7FE };

/* ---- Building ---- */

static uint16_t id_on_the_wire(const fixture_t *f, unsigned message) {
    return f->other_ids ? agv_config_get(&f->config, AGV_SETTING_ID + message) : traffic_id(&f->config, message);
}

/* A frame with the identifier of its set. An identifier that this vehicle does not use any more becomes an unknown one. */
static hal_can_frame_t with_id_of_set(const fixture_t *f, const hal_can_frame_t *frame) {
    hal_can_frame_t renamed = *frame;
    for (unsigned i = 0; f->other_ids && i < AGV_MSG_COUNT; i++) {
        renamed.id = frame->id == traffic_id(&f->config, i) ? UNKNOWN_ID : renamed.id;
    }
    for (unsigned i = 0; f->other_ids && i < AGV_MSG_COUNT; i++) {
        renamed.id = frame->id == id_on_the_wire(f, i) ? traffic_id(&f->config, i) : renamed.id;
    }
    return renamed;
}

static bool is_status_frame(const fixture_t *f, hal_can_side_t side, const hal_can_frame_t *frame) {
    return side == HAL_CAN_VEHICLE && f->config.status_frame_id != 0 && frame->id == f->config.status_frame_id;
}

static void on_sent(void *ctx, hal_can_side_t side, const hal_can_frame_t *on_wire) {
    fixture_t *f = (fixture_t *)ctx;
    const hal_can_frame_t renamed = with_id_of_set(f, on_wire);
    const hal_can_frame_t *frame = &renamed;
    oracle_sent(&f->oracle, side, frame, agv_supervisor_state(&f->supervisor));
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", oracle_verdict(&f->oracle), f->what);
    if (is_status_frame(f, side, on_wire)) {
        f->status_count++;
        if (!f->log_status) {
            return;
        }
    }
    if (f->long_run && f->sent_count == FIXTURE_SENT_MAX) {
        f->sent_count = 0;
    }
    TEST_ASSERT_TRUE_MESSAGE(f->sent_count < FIXTURE_SENT_MAX, "the log of sent frames is full");
    fixture_sent_t *entry = &f->sent[f->sent_count++];
    *entry = (fixture_sent_t){.time_ms = f->now_ms,
                              .call = f->call,
                              .side = side,
                              .id = frame->id,
                              .flags = frame->flags,
                              .length = frame->length};
    memcpy(entry->data, frame->data, sizeof entry->data);
}

/* 0, or a moment before the wrap. */
static uint32_t clock_start_ms(void) {
    const char *wrap_in_ms = getenv("AGV_TEST_WRAP_IN_MS");
    return wrap_in_ms != NULL ? 0u - (uint32_t)strtoul(wrap_in_ms, NULL, 10) : 0u;
}

void fixture_init(fixture_t *f) {
    memset(f, 0, sizeof *f);
    f->now_ms = clock_start_ms();
    agv_config_defaults(&f->config);
    f->ports = (agv_ports_t){.hal = &f->hal, .recorder = &f->recorder};
    f->reset_cause = HAL_RESET_POWER_ON;
    f->self_test_passed = true;
    f->what = "";
    sim_store_init(&f->store);
    traffic_heal(f->traffic);
}

static void address_traffic(fixture_t *f) {
    traffic_address(f->traffic, &f->config);
    for (unsigned i = 0; i < (unsigned)TRAFFIC_MESSAGES; i++) {
        f->traffic[i].id = id_on_the_wire(f, i);
    }
}

static void start_supervisor(fixture_t *f) {
    oracle_configure(&f->oracle, &f->config);
    f->oracle.now_ms = f->now_ms;
    oracle_restart(&f->oracle);
    f->call++;
    agv_supervisor_start(&f->supervisor, &f->ports, &f->config, f->self_test_passed, f->now_ms);
    oracle_returned(&f->oracle, agv_supervisor_state(&f->supervisor));
}

void fixture_start(fixture_t *f) {
    const bool gateway = f->config.topology == (uint16_t)AGV_TOPOLOGY_GATEWAY;
    const sim_hal_config_t config = {.clock_start_ms = f->now_ms, .reset_cause = f->reset_cause, .store = &f->store};
    sim_hal_init_direct(&f->hal, &config, gateway ? 2 : 1, on_sent, f);
    address_traffic(f);
    f->elapsed_ms = 0;
    start_supervisor(f);
}

void fixture_restart(fixture_t *f, hal_reset_cause_t cause) {
    sim_hal_reset(&f->hal, cause);
    start_supervisor(f);
}

void fixture_standby(fixture_t *f) {
    fixture_start(f);
    for (unsigned i = 0; i < STANDBY_WITHIN_MS && agv_supervisor_state(&f->supervisor) != AGV_STATE_STANDBY; i++) {
        fixture_run(f, 1);
    }
    expect_state(f, AGV_STATE_STANDBY);
    fixture_forget_sent(f);
}

void fixture_active(fixture_t *f) {
    fixture_standby(f);
    fixture_mode(f, MODE_ENGAGED);
    fixture_gear(f, GEAR_D);
    fixture_run(f, ENGAGED_MS);
    expect_state(f, AGV_STATE_ACTIVE);
    fixture_forget_sent(f);
}

/* ---- Traffic ---- */

void fixture_raw(fixture_t *f, hal_can_side_t side, hal_can_frame_t frame) {
    frame.time_ms = f->now_ms;
    f->call++;
    const hal_can_frame_t heard = with_id_of_set(f, &frame);
    oracle_heard(&f->oracle, side, &heard);
    agv_supervisor_frame(&f->supervisor, &f->ports, side, &frame);
    oracle_returned(&f->oracle, agv_supervisor_state(&f->supervisor));
}

void fixture_frame(fixture_t *f, agv_message_t message, const uint8_t data[8]) {
    hal_can_frame_t frame = {.id = f->traffic[message].id, .length = 8};
    memcpy(frame.data, data, sizeof frame.data);
    fixture_raw(f, f->traffic[message].side, frame);
}

void fixture_send_now(fixture_t *f, agv_message_t message) {
    traffic_message_t *m = &f->traffic[message];
    hal_can_frame_t frame = traffic_next(m);
    m->last_ms = f->now_ms;
    m->call = f->call + 1u;
    if (f->edit == NULL || f->edit(f, message, &frame)) {
        fixture_raw(f, m->side, frame);
    }
}

static void mute(fixture_t *f, const agv_message_t *messages, unsigned count, bool muted) {
    for (unsigned i = 0; i < count; i++) {
        f->traffic[messages[i]].muted = muted;
    }
}

void fixture_mute_vcu(fixture_t *f, bool muted) {
    static const agv_message_t OF_VCU[] = {AGV_MSG_VEHICLE_STATUS, AGV_MSG_GEAR_STATUS, AGV_MSG_THROTTLE_STATUS,
                                           AGV_MSG_WHEEL_SPEED};
    mute(f, OF_VCU, 4, muted);
}

void fixture_mute_eps(fixture_t *f, bool muted) {
    static const agv_message_t OF_EPS[] = {AGV_MSG_STEERING_STATUS, AGV_MSG_EPS_STATUS, AGV_MSG_STEERING_POSITION};
    mute(f, OF_EPS, 3, muted);
}

void fixture_mute_ai(fixture_t *f, bool muted) {
    static const agv_message_t OF_AI[] = {AGV_MSG_TURN_SIGNAL_COMMAND, AGV_MSG_GEAR_COMMAND, AGV_MSG_THROTTLE_COMMAND,
                                          AGV_MSG_STEERING_COMMAND};
    mute(f, OF_AI, TRAFFIC_COMMANDS, muted);
}

void fixture_mode(fixture_t *f, uint8_t mode) {
    traffic_mode(f->traffic, mode);
}

void fixture_button(fixture_t *f, bool pressed) {
    traffic_button(f->traffic, pressed);
}

void fixture_gear(fixture_t *f, uint8_t gear) {
    traffic_gear(f->traffic, gear);
}

void fixture_throttle(fixture_t *f, uint8_t counts) {
    f->traffic[AGV_MSG_THROTTLE_STATUS].data[0] = counts;
}

void fixture_speed(fixture_t *f, uint16_t counts) {
    traffic_put_word(f->traffic[AGV_MSG_VEHICLE_STATUS].data, counts);
}

void fixture_angle(fixture_t *f, uint16_t raw) {
    traffic_put_word(&f->traffic[AGV_MSG_STEERING_STATUS].data[2], raw);
}

void fixture_command_angle(fixture_t *f, uint16_t raw) {
    traffic_put_word(f->traffic[AGV_MSG_STEERING_COMMAND].data, raw);
}

void fixture_wheels(fixture_t *f, int32_t left_mm_s, int32_t right_mm_s) {
    traffic_wheels(f->traffic, left_mm_s, right_mm_s);
}

void fixture_drive(fixture_t *f, int32_t mm_s) {
    const uint32_t amount_mm_s = (uint32_t)(mm_s < 0 ? -mm_s : mm_s);
    fixture_wheels(f, mm_s, mm_s);
    fixture_speed(f, (uint16_t)(amount_mm_s * 36u / 10u));
}

void fixture_vehicle_confirms(fixture_t *f) {
    fixture_mode(f, MODE_MANUAL);
    fixture_gear(f, GEAR_P);
    fixture_throttle(f, 0);
    fixture_drive(f, 0);
}

/* ---- Time ---- */

static void tick(fixture_t *f) {
    if (!f->receive_path_dead) {
        agv_supervisor_receive_alive(&f->supervisor);
    }
    f->call++;
    f->oracle.now_ms = f->now_ms;
    agv_supervisor_tick(&f->supervisor, &f->ports, f->now_ms);
    oracle_returned(&f->oracle, agv_supervisor_state(&f->supervisor));
    (void)sim_hal_poll(&f->hal);
}

static void hand_over_traffic(fixture_t *f) {
    f->now_ms++;
    f->elapsed_ms++;
    sim_hal_set_now_ms(&f->hal, f->now_ms);
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        if (traffic_is_due(&f->traffic[i], f->elapsed_ms)) {
            fixture_send_now(f, (agv_message_t)i);
        }
    }
}

static void step(fixture_t *f) {
    hand_over_traffic(f);
    tick(f);
}

void fixture_run(fixture_t *f, uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        step(f);
    }
}

void fixture_run_before(fixture_t *f, agv_message_t message) {
    TEST_ASSERT_FALSE_MESSAGE(f->traffic[message].muted, "a muted message never comes");
    while (!traffic_is_due(&f->traffic[message], f->elapsed_ms + 1u)) {
        step(f);
    }
}

void fixture_run_past(fixture_t *f, agv_message_t message) {
    fixture_run_before(f, message);
    step(f);
}

void fixture_press(fixture_t *f, uint32_t held_ms) {
    fixture_run_before(f, AGV_MSG_VEHICLE_STATUS);
    fixture_button(f, true);
    fixture_run(f, held_ms);
    fixture_button(f, false);
    step(f);
}

void fixture_jump(fixture_t *f, uint32_t ms) {
    f->now_ms += ms;
    f->elapsed_ms += ms;
    sim_hal_set_now_ms(&f->hal, f->now_ms);
    tick(f);
}

void fixture_run_without_ticks(fixture_t *f, uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        hand_over_traffic(f);
    }
}

/* ---- Looking ---- */

bool fixture_has(const fixture_t *f, agv_fault_t fault) {
    return agv_supervisor_has_fault(&f->supervisor, fault);
}

uint32_t fixture_events(const fixture_t *f, agv_event_kind_t kind, int a, int c, agv_event_t *last) {
    const uint32_t next = agv_recorder_next_sequence(&f->recorder);
    const uint32_t kept = next < AGV_RECORDER_EVENTS ? next : AGV_RECORDER_EVENTS;
    uint32_t count = 0;
    agv_event_t event;
    for (uint32_t i = next - kept; i != next; i++) {
        if (agv_recorder_get(&f->recorder, i, &event) && event.kind == kind && (a == ANY || event.a == a) &&
            (c == ANY || event.c == c)) {
            count++;
            *last = event;
        }
    }
    return count;
}

uint32_t fixture_raised(const fixture_t *f, agv_fault_t fault) {
    agv_event_t event;
    return fixture_events(f, AGV_EVENT_FAULT, (int)fault, 1, &event);
}

uint32_t fixture_ended(const fixture_t *f, agv_fault_t fault) {
    agv_event_t event;
    return fixture_events(f, AGV_EVENT_FAULT, (int)fault, 0, &event);
}

bool fixture_last_raised(const fixture_t *f, agv_fault_t fault, agv_event_t *event) {
    return fixture_events(f, AGV_EVENT_FAULT, (int)fault, 1, event) > 0;
}

void fixture_forget_sent(fixture_t *f) {
    f->sent_count = 0;
}

uint32_t fixture_count_sent(const fixture_t *f, uint32_t id) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < f->sent_count; i++) {
        count += f->sent[i].id == id ? 1u : 0u;
    }
    return count;
}

const fixture_sent_t *fixture_nth_sent(const fixture_t *f, uint32_t id, uint32_t n) {
    for (uint32_t i = 0; i < f->sent_count; i++) {
        if (f->sent[i].id == id && n-- == 0) {
            return &f->sent[i];
        }
    }
    TEST_FAIL_MESSAGE("no such frame was sent");
    return NULL;
}

static const char *name_or(const char *name, const char *otherwise) {
    return name != NULL ? name : otherwise;
}

static void fail_unless(bool good, const fixture_t *f, const char *expected, const char *seen) {
    char text[200];
    if (!good) {
        (void)snprintf(text, sizeof text, "%s: expected %s, is %s, %u ms after the start", f->what, expected, seen,
                       (unsigned)f->elapsed_ms);
        TEST_FAIL_MESSAGE(text);
    }
}

void expect_state(const fixture_t *f, agv_state_t expected) {
    const agv_state_t state = agv_supervisor_state(&f->supervisor);
    fail_unless(state == expected, f, agv_state_name(expected), name_or(agv_state_name(state), "no state"));
}

void expect_reason(const fixture_t *f, agv_fault_t expected) {
    const agv_fault_t reason = agv_supervisor_first_reason(&f->supervisor);
    fail_unless(reason == expected, f, name_or(agv_fault_name(expected), "no reason"),
                name_or(agv_fault_name(reason), "no reason"));
}

void expect_fault(const fixture_t *f, agv_fault_t fault, bool active) {
    fail_unless(fixture_has(f, fault) == active, f, agv_fault_name(fault),
                active ? "not raised" : "(it should not be)");
}

void expect_led(const fixture_t *f, int expected_code) {
    TEST_ASSERT_EQUAL_INT_MESSAGE(expected_code, agv_supervisor_led_code(&f->supervisor), f->what);
}

void expect_output(const fixture_t *f, bool closed) {
    TEST_ASSERT_EQUAL_INT_MESSAGE(closed, f->hal.safety_output.on, f->what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(closed, agv_supervisor_output_closed(&f->supervisor), f->what);
}

void expect_silence(const fixture_t *f) {
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, f->sent_count, f->what);
}

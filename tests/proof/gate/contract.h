/*
 * What the sending gate may let out, in raw identifiers and bytes, as a contract in ACSL for frama-c (scripts/proofs/gate
 * proves it; README.md says what that shows). Written from docs/requirements.md (states, FSM-6, FSM-10, TOP-1,
 * TOP-2, TOP-3) and docs/protocol.md, not from the code: it uses no name, table or value of the code but the fields of
 * the structs. A compiler sees declarations only.
 */
#ifndef PROOF_GATE_CONTRACT_H
#define PROOF_GATE_CONTRACT_H

#include "agv/gate.h"
#include "agv/protocol.h"
#include "agv/state.h"
#include "lemmas.h"

/*@
  // ---- States: 0Fh INIT, 33h STANDBY, 3Ch ACTIVE; every other one, TRIPPED, SAFE and corrupted ones, is latched.
  predicate commands_safe(integer state) = state != 0x33 && state != 0x3C;

  // ---- Identifiers (P1): set 0 is `heading`, 1 is `table`.
  logic integer signals_id(integer chosen) = chosen == 0 ? 0x43F : 0x201;
  logic integer vehicle_id(integer chosen) = chosen == 0 ? 0x363 : 0x203;
  predicate is_command_id(integer id, integer chosen) =
      id == signals_id(chosen) || id == 0x168 || id == 0x075 || id == 0x065;
  predicate is_status_id(integer id, integer chosen) =
      id == vehicle_id(chosen) || id == 0x0A3 || id == 0x050 || id == 0x067 || id == 0x167 || id == 0x267 || id == 0x101;

  // ---- Bytes: d[0] is byte 1.
  logic integer word(uint8_t *d) = d[0] | (d[1] << 8);
  predicate zero_from_2(uint8_t *d) =
      d[1] == 0 && d[2] == 0 && d[3] == 0 && d[4] == 0 && d[5] == 0 && d[6] == 0 && d[7] == 0;
  predicate zero_from_3(uint8_t *d) =
      d[2] == 0 && d[3] == 0 && d[4] == 0 && d[5] == 0 && d[6] == 0 && d[7] == 0;
  // 43Fh: lights and autopilot off are bits 5 to 8 of byte 5, the alive counter is byte 8.
  predicate only_signals(uint8_t *d) =
      d[0] == 0 && d[1] == 0 && d[2] == 0 && d[3] == 0 && (d[4] & 0x0F) == 0 && d[5] == 0 && d[6] == 0;

  // ---- The safe commands: hazard lights, autopilot off, headlight on (1 is off); P; throttle 0; the held angle.
  predicate safe_signals(uint8_t *d) = only_signals(d) && d[4] == 0x70;
  predicate held(integer raw, integer check) = check == (uint16_t)(~raw);
  predicate safe_command(uint8_t *d, integer id, integer chosen, integer state, integer raw, integer check) =
      (id == signals_id(chosen) && safe_signals(d)) ||
      (id == 0x168 && d[0] == 8 && zero_from_2(d)) ||
      (id == 0x075 && d[0] == 0 && zero_from_2(d)) ||
      (id == 0x065 && state != 0x0F && held(raw, check) && word(d) == raw && word(d) <= 18000 && zero_from_3(d));

  // ---- What a gateway passes on: 43Fh always; the others in ACTIVE, or in manual with throttle 0 when that is chosen.
  predicate passed_command(uint8_t *d, integer id, integer chosen, integer state, integer in_manual, integer ceiling) =
      (id == signals_id(chosen) && only_signals(d)) ||
      ((state == 0x3C || in_manual == 1) &&
       ((id == 0x168 && (d[0] == 1 || d[0] == 2 || d[0] == 4 || d[0] == 8) && zero_from_2(d)) ||
        (id == 0x075 && (state == 0x3C ? 2 * d[0] <= 5 * ceiling : d[0] == 0) && zero_from_2(d)) ||
        (id == 0x065 && word(d) <= 18000 && zero_from_3(d))));

  predicate own_status(integer id, integer chosen, integer own_id) =
      id != 0 && id == own_id && !is_command_id(id, chosen) && !is_status_id(id, chosen);

  predicate may_leave_to_vehicle{L}(agv_gate_t *g, hal_can_frame_t *f) =
      own_status(f->id, g->config->id_set, g->config->status_frame_id) ||
      (commands_safe(g->state) &&
       safe_command(&f->data[0], f->id, g->config->id_set, g->state, g->hold_raw, g->hold_check)) ||
      (!commands_safe(g->state) && g->config->topology == 1 &&
       passed_command(&f->data[0], f->id, g->config->id_set, g->state, g->config->gateway_in_manual,
                      g->config->throttle_ceiling_pct));

  // Classic data frames of 8 bytes (P15) only. Side 0 is the vehicle, 1 is the AI computer.
  predicate may_leave{L}(agv_gate_t *g, integer side, hal_can_frame_t *f) =
      f->flags == 0 && f->length == 8 &&
      ((side == 0 && may_leave_to_vehicle(g, f)) ||
       (side == 1 && g->config->topology == 1 && is_status_id(f->id, g->config->id_set)));

  // ---- FSM-6 in its own words, for a frame to the vehicle in INIT, TRIPPED, SAFE and any corrupted state.
  predicate fsm6{L}(agv_gate_t *g, hal_can_frame_t *f) =
      (f->id == 0x168 ==> f->data[0] != 1 && f->data[0] != 2 && f->data[0] != 4) &&
      (f->id == 0x075 ==> f->data[0] == 0) &&
      (f->id == signals_id(g->config->id_set) ==> (f->data[4] / 64) % 2 == 1) &&
      (f->id == 0x065 ==> g->state != 0x0F && held(g->hold_raw, g->hold_check) && word(&f->data[0]) == g->hold_raw);

  predicate readable{L}(agv_gate_t *g, hal_can_frame_t *f) =
      \valid_read(g) && \valid_read(g->config) && \valid_read(f);
*/

/*@ // The tables of docs/protocol.md; 11 is no message.
    predicate is_message(integer message, integer id, integer chosen) =
        0 <= message <= 11 && (chosen > 1 ==> message == 11) &&
        (chosen <= 1 ==> (message == 0 <==> id == signals_id(chosen)) && (message == 1 <==> id == 0x168) &&
                         (message == 2 <==> id == 0x075) && (message == 3 <==> id == 0x065) &&
                         (4 <= message <= 10 <==> is_status_id(id, chosen)));
*/

/*@ assigns \nothing;
    ensures \result <==> id_set <= 1;
*/
static bool is_id_set(uint32_t id_set);

/*@ assigns \nothing;
    ensures is_message(\result, id, id_set);
*/
uint32_t agv_message_from_id(uint32_t id, uint32_t id_set);

/*@ assigns \nothing;
    ensures \result <==> commands_safe(state);
*/
bool agv_state_commands_safe(agv_state_t state);

// ---- Inside of the gate, step by step.

/*@ requires command <= 3;
    requires \valid_read(data + (0 .. 7));
    assigns \nothing;
    ensures command == 0 ==> (\result <==> only_signals(data));
    ensures command == 1 || command == 2 ==> (\result <==> zero_from_2(data));
    ensures command == 3 ==> (\result <==> zero_from_3(data));
*/
static bool reserved_are_zero(uint32_t command, const uint8_t data[AGV_DLC]);

/*@ requires \valid_read(data + (0 .. 1));
    assigns \nothing;
    ensures \result == word(data);
*/
static uint32_t first_two(const uint8_t data[AGV_DLC]);

/*@ requires \valid_read(gate);
    assigns \nothing;
    ensures \result <==> gate->state != 0x0F && held(gate->hold_raw, gate->hold_check) && raw == gate->hold_raw;
*/
static bool is_held_angle(const agv_gate_t *gate, uint32_t raw);

/*@ assigns \nothing;
    ensures \result <==> gear == 1 || gear == 2 || gear == 4 || gear == 8;
*/
static bool is_gear(uint8_t gear);

/*@ requires \valid_read(gate) && \valid_read(gate->config);
    assigns \nothing;
    ensures gate->state == 0x3C ==> 2 * \result <= 5 * gate->config->throttle_ceiling_pct < 2 * \result + 2;
    ensures gate->state != 0x3C ==> \result == 0;
*/
static uint32_t throttle_max_counts(const agv_gate_t *gate);

/*@ requires \valid_read(gate) && \valid_read(gate->config) && \valid_read(data + (0 .. 7));
    requires message <= 3;
    assigns \nothing;
    ensures message == 0 ==> (\result <==> (safe ==> data[4] == 0x70));
    ensures message == 1 && safe ==> (\result <==> data[0] == 8);
    ensures message == 1 && !safe ==> (\result <==> data[0] == 1 || data[0] == 2 || data[0] == 4 || data[0] == 8);
    ensures message == 2 && gate->state == 0x3C ==>
                (\result <==> 2 * data[0] <= 5 * gate->config->throttle_ceiling_pct);
    ensures message == 2 && gate->state != 0x3C ==> (\result <==> data[0] == 0);
    ensures message == 3 && !safe ==> (\result <==> word(data) <= 18000);
    ensures message == 3 && safe ==>
                (\result <==> word(data) <= 18000 && gate->state != 0x0F && held(gate->hold_raw, gate->hold_check) &&
                              word(data) == gate->hold_raw);
*/
static bool value_allowed(const agv_gate_t *gate, uint32_t message, const uint8_t data[AGV_DLC], bool safe);

/*@ requires \valid_read(gate) && \valid_read(gate->config);
    assigns \nothing;
    ensures \result <==> gate->config->topology == 1 &&
                         (gate->state == 0x3C || message == 0 || gate->config->gateway_in_manual == 1);
*/
static bool may_pass(const agv_gate_t *gate, uint32_t message);

/*@ requires readable(gate, frame);
    requires is_message(message, frame->id, gate->config->id_set);
    assigns \nothing;
    behavior a_set:
        assumes gate->config->id_set <= 1;
        ensures \result <==> may_leave_to_vehicle(gate, frame);
    behavior no_set:
        assumes gate->config->id_set > 1;
        ensures \result ==> frame->id != 0 && frame->id == gate->config->status_frame_id;
*/
static bool vehicle_side_allows(const agv_gate_t *gate, uint32_t message, const hal_can_frame_t *frame);

/*@ // Any state, configuration, held angle, side and frame.
    requires readable(gate, frame);
    assigns \nothing;
    behavior a_set: // the configuration names one of the two ID sets: the gate says exactly this
        assumes gate->config->id_set <= 1;
        ensures \result <==> may_leave(gate, side, frame);
    behavior no_set: // it names none, so it is corrupted: nothing but the status frame of the supervisor's own
        assumes gate->config->id_set > 1;
        ensures \result ==> side == 0 && frame->flags == 0 && frame->length == 8 && frame->id != 0 &&
                            frame->id == gate->config->status_frame_id;
    behavior fsm6: // follows from what the two above say
        assumes side == 0 && commands_safe(gate->state);
        assumes gate->config->id_set <= 1 || !(is_command_id(gate->config->status_frame_id, 0) ||
                                               is_command_id(gate->config->status_frame_id, 1));
        ensures \result ==> fsm6(gate, frame);
    complete behaviors a_set, no_set;
    disjoint behaviors a_set, no_set;
*/
bool agv_gate_allows(const agv_gate_t *gate, hal_can_side_t side, const hal_can_frame_t *frame);

// What the HAL is asked for. What hal_can_send then does with a frame is the port's; here it counts the requests and
// keeps the last one. This contract is the only one that is not proven: there is no code to prove it of.
/*@ ghost int requests; */
/*@ ghost int requested_side; */
/*@ ghost const hal_can_frame_t *requested; */

/*@ requires \valid_read(frame);
    assigns requests, requested_side \from requests, side;
    assigns requested \from frame;
    ensures requests == \old(requests) + 1;
    ensures requested_side == side && requested == frame;
*/
bool hal_can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame);

/*@ requires readable(gate, frame);
    requires 0 <= requests < 1000;
    requires \separated(gate, gate->config, frame, &requests, &requested_side, &requested);
    assigns requests, requested_side \from requests, side;
    assigns requested \from frame;
    behavior lets_out:
        assumes gate->config->id_set <= 1 && may_leave(gate, side, frame) && gate->config->shadow != 1;
        ensures requests == \old(requests) + 1 && requested_side == side && requested == frame;
        ensures \result == AGV_GATE_SENT || \result == AGV_GATE_BUSY;
    behavior shadow:
        assumes gate->config->id_set <= 1 && may_leave(gate, side, frame) && gate->config->shadow == 1;
        ensures requests == \old(requests) && \result == AGV_GATE_SHADOWED;
    behavior keeps:
        assumes gate->config->id_set <= 1 && !may_leave(gate, side, frame);
        ensures requests == \old(requests) && \result == AGV_GATE_REFUSED;
    behavior fsm6:
        assumes side == 0 && commands_safe(gate->state);
        assumes gate->config->id_set <= 1 || !(is_command_id(gate->config->status_frame_id, 0) ||
                                               is_command_id(gate->config->status_frame_id, 1));
        ensures requests != \old(requests) ==> fsm6(gate, requested);
    disjoint behaviors lets_out, shadow, keeps;
*/
agv_gate_result_t agv_gate_send(const agv_gate_t *gate, hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame);

#endif

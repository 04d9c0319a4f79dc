/*
 * What the sending gate may let out, in raw identifiers and bytes, as a contract in ACSL for frama-c (tests/proofs/gate/run
 * proves it; README.md says what that shows). Written from docs/requirements.md (states, FSM-6, FSM-10, TOP-1,
 * TOP-2, TOP-3) and docs/protocol.md, not from the code: it uses no name, table or value of the code but the fields of
 * the structs. Messages are numbered as in docs/protocol.md: 0 to 3 are 43Fh, 168h, 075h, 065h, 4 to 10 the status messages. A compiler sees declarations only.
 */
#ifndef PROOF_GATE_CONTRACT_H
#define PROOF_GATE_CONTRACT_H

#include "agv/protocol.h"
#include "agv/state.h"
#include "lemmas.h"
#include "transmit/gate.h"

/*@
  // ---- States: 0Fh INIT, 33h STANDBY, 3Ch ACTIVE; every other one, TRIPPED, SAFE and corrupted ones, is latched.
  predicate commands_safe(integer state) = state != 0x33 && state != 0x3C;

  // ---- Identifiers (P1): `of` holds those of the 11 messages, as configured. They may be any numbers: of two messages
  // with one identifier the first counts.
  predicate is_of{L}(integer id, uint16_t *of, integer m) =
      of[m] == id && \forall integer k; 0 <= k < m ==> of[k] != id;
  predicate is_status_id{L}(integer id, uint16_t *of) = \exists integer m; 4 <= m <= 10 && is_of(id, of, m);
  predicate is_no_id{L}(integer id, uint16_t *of) = \forall integer k; 0 <= k <= 10 ==> of[k] != id;
  predicate commands_differ{L}(uint16_t *of) =
      of[0] != of[1] && of[0] != of[2] && of[0] != of[3] && of[1] != of[2] && of[1] != of[3] && of[2] != of[3];

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
  predicate safe_command(uint8_t *d, integer id, uint16_t *of, integer state, integer raw, integer check) =
      (is_of(id, of, 0) && safe_signals(d)) ||
      (is_of(id, of, 1) && d[0] == 8 && zero_from_2(d)) ||
      (is_of(id, of, 2) && d[0] == 0 && zero_from_2(d)) ||
      (is_of(id, of, 3) && state != 0x0F && held(raw, check) && word(d) == raw && word(d) <= 18000 && zero_from_3(d));

  // ---- What a gateway lets out: 43Fh always, throttle 0 always (the end of an engagement, TOP-2); the others in ACTIVE,
  // or in manual with throttle 0 when that is chosen.
  predicate passed_command(uint8_t *d, integer id, uint16_t *of, integer state, integer in_manual, integer ceiling) =
      (is_of(id, of, 0) && only_signals(d)) ||
      (is_of(id, of, 2) && (state == 0x3C ? 2 * d[0] <= 5 * ceiling : d[0] == 0) && zero_from_2(d)) ||
      ((state == 0x3C || in_manual == 1) &&
       ((is_of(id, of, 1) && (d[0] == 1 || d[0] == 2 || d[0] == 4 || d[0] == 8) && zero_from_2(d)) ||
        (is_of(id, of, 3) && word(d) <= 18000 && zero_from_3(d))));

  predicate own_status{L}(integer id, uint16_t *of, integer own_id) = id != 0 && id == own_id && is_no_id(id, of);

  predicate may_leave_to_vehicle{L}(agv_gate_t *g, hal_can_frame_t *f) =
      own_status(f->id, &g->ids->of[0], g->config->status_frame_id) ||
      (commands_safe(g->state) &&
       safe_command(&f->data[0], f->id, &g->ids->of[0], g->state, g->hold_raw, g->hold_check)) ||
      (!commands_safe(g->state) && g->config->topology == 1 &&
       passed_command(&f->data[0], f->id, &g->ids->of[0], g->state, g->config->gateway_in_manual,
                      g->config->throttle_ceiling_pct));

  // Classic data frames of 8 bytes (P15) only. Side 0 is the vehicle, 1 is the AI computer.
  predicate may_leave{L}(agv_gate_t *g, integer side, hal_can_frame_t *f) =
      f->flags == 0 && f->length == 8 &&
      ((side == 0 && may_leave_to_vehicle(g, f)) ||
       (side == 1 && g->config->topology == 1 && is_status_id(f->id, &g->ids->of[0])));

  // ---- FSM-6 in its own words, for a frame to the vehicle in INIT, TRIPPED, SAFE and any corrupted state.
  predicate fsm6{L}(agv_gate_t *g, hal_can_frame_t *f) =
      (f->id == g->ids->of[1] ==> f->data[0] != 1 && f->data[0] != 2 && f->data[0] != 4) &&
      (f->id == g->ids->of[2] ==> f->data[0] == 0) &&
      (f->id == g->ids->of[0] ==> (f->data[4] / 64) % 2 == 1) &&
      (f->id == g->ids->of[3] ==> g->state != 0x0F && held(g->hold_raw, g->hold_check) && word(&f->data[0]) == g->hold_raw);

  predicate readable{L}(agv_gate_t *g, hal_can_frame_t *f) =
      \valid_read(g) && \valid_read(g->config) && \valid_read(g->ids) && \valid_read(f);
*/

/*@ // 11 is no message.
    predicate is_message{L}(integer message, integer id, uint16_t *of) =
        (0 <= message <= 10 && is_of(id, of, message)) || (message == 11 && is_no_id(id, of));
*/

/*@ requires \valid_read(ids + (0 .. 10));
    assigns \nothing;
    ensures is_message(\result, id, ids);
*/
static uint32_t find(const uint16_t ids[AGV_MSG_COUNT], uint32_t id);

/*@ requires \valid_read(ids);
    assigns \nothing;
    ensures is_message(\result, id, &ids->of[0]);
*/
uint32_t agv_ids_find(const agv_ids_t *ids, uint32_t id);

/*@ assigns \nothing;
    ensures \result <==> message <= 10;
*/
static bool is_message(uint32_t message);

/*@ // The two presets of docs/protocol.md, which a configuration begins with.
    assigns \nothing;
    ensures id_set == 0 && message == 0 ==> \result == 0x43F;
    ensures id_set == 1 && message == 0 ==> \result == 0x201;
    ensures id_set <= 1 && message == 1 ==> \result == 0x168;
    ensures id_set <= 1 && message == 2 ==> \result == 0x075;
    ensures id_set <= 1 && message == 3 ==> \result == 0x065;
    ensures id_set == 0 && message == 4 ==> \result == 0x363;
    ensures id_set == 1 && message == 4 ==> \result == 0x203;
    ensures id_set <= 1 && message == 5 ==> \result == 0x0A3;
    ensures id_set <= 1 && message == 6 ==> \result == 0x050;
    ensures id_set <= 1 && message == 7 ==> \result == 0x067;
    ensures id_set <= 1 && message == 8 ==> \result == 0x167;
    ensures id_set <= 1 && message == 9 ==> \result == 0x267;
    ensures id_set <= 1 && message == 10 ==> \result == 0x101;
    ensures id_set > 1 || message > 10 ==> \result > 0x7FF;
*/
uint16_t agv_message_id(uint32_t message, uint32_t id_set);

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
                         (gate->state == 0x3C || message == 0 || message == 2 || gate->config->gateway_in_manual == 1);
*/
static bool may_pass(const agv_gate_t *gate, uint32_t message);

/*@ requires readable(gate, frame);
    requires is_message(message, frame->id, &gate->ids->of[0]);
    assigns \nothing;
    ensures \result <==> may_leave_to_vehicle(gate, frame);
*/
static bool vehicle_side_allows(const agv_gate_t *gate, uint32_t message, const hal_can_frame_t *frame);

/*@ // Any state, configuration, identifiers, held angle, side and frame: the gate says exactly this.
    requires readable(gate, frame);
    assigns \nothing;
    ensures \result <==> may_leave(gate, side, frame);
    behavior fsm6: // follows from it
        assumes side == 0 && commands_safe(gate->state);
        assumes commands_differ(&gate->ids->of[0]); // agv_config_check refuses two messages with one identifier
        ensures \result ==> fsm6(gate, frame);
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
    requires \separated(gate, gate->config, gate->ids, frame, &requests, &requested_side, &requested);
    assigns requests, requested_side \from requests, side;
    assigns requested \from frame;
    behavior lets_out:
        assumes may_leave(gate, side, frame) && gate->config->shadow != 1;
        ensures requests == \old(requests) + 1 && requested_side == side && requested == frame;
        ensures \result == AGV_GATE_SENT || \result == AGV_GATE_BUSY;
    behavior shadow:
        assumes may_leave(gate, side, frame) && gate->config->shadow == 1;
        ensures requests == \old(requests) && \result == AGV_GATE_SHADOWED;
    behavior keeps:
        assumes !may_leave(gate, side, frame);
        ensures requests == \old(requests) && \result == AGV_GATE_REFUSED;
    behavior fsm6:
        assumes side == 0 && commands_safe(gate->state);
        assumes commands_differ(&gate->ids->of[0]);
        ensures requests != \old(requests) ==> fsm6(gate, requested);
    complete behaviors lets_out, shadow, keeps;
    disjoint behaviors lets_out, shadow, keeps;
*/
agv_gate_result_t agv_gate_send(const agv_gate_t *gate, hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame);

#endif

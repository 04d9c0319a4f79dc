#include "hunt_attacks.h"

#include <string.h>

/* The messages in the order of agv_message_t; the commands come first. */
#define COMMANDS "turn_signal_command|gear_command|throttle_command|steering_command"
#define MESSAGES                                                                                                       \
    COMMANDS "|vehicle_status|gear_status|throttle_status|steering_status|eps_status|steering_position|wheel_speed"
#define NODES "vcu|eps|ai"
#define VALUES "FA|01|02|08|00|FF|64|46"
/* The VCU keeps what it knows of the EPS to itself. */
#define QUIET_VCU "vcu: set, field: alarms, value: 00h|"

#define NONE AGV_MSG_NONE
const hunt_attack_t HUNT_ATTACKS[] = {
    {"eps_mode", HUNT_PATTERN, AGV_MSG_EPS_STATUS, "eps: set, field: mode, value: $a$f",
     "eps: unset, message: eps_status", {"FFh|07h|02h|00h"}, {0u, 0u, 0u, 1u}, {0u, 0u, 60u, 60u}},
    {"eps_faults", HUNT_PATTERN, AGV_MSG_EPS_STATUS, QUIET_VCU "eps: set, field: faults, value: $a$f",
     "eps: unset, message: eps_status", {"01h|02h|04h|08h|20h|40h|80h|11h"}, {0u, 0u, 0u, 1u}, {0u, 0u, 60u, 60u}},
    {"vcu_alarms", HUNT_PATTERN, AGV_MSG_VEHICLE_STATUS, "vcu: set, field: alarms, value: $a$f",
     "vcu: unset, message: vehicle_status", {"01h|02h|10h|20h|80h"}, {0u, 0u, 0u, 1u}, {0u, 0u, 60u, 60u}},
    {"mode_bits", HUNT_PATTERN, AGV_MSG_VEHICLE_STATUS, "vcu: set, field: mode_bits, value: $a$f",
     "vcu: unset, message: vehicle_status", {"0h|1h|2h|3h"}, {0u, 0u, 0u, 1u}, {0u, 0u, 60u, 60u}},
    {"gear_status", HUNT_PATTERN, AGV_MSG_GEAR_STATUS, "vcu: set, field: gear, value: $a$f",
     "vcu: unset, message: gear_status", {"01h|02h|04h|08h|03h"}, {0u, 0u, 0u, 1u}, {0u, 0u, 60u, 60u}},
    {"throttle_status", HUNT_PATTERN, AGV_MSG_THROTTLE_STATUS, "vcu: set, field: throttle, value: $a$f",
     "vcu: unset, message: throttle_status", {"FAh|FBh|00h|80h"}, {0u, 0u, 0u, 1u}, {0u, 0u, 60u, 60u}},
    {"angle", HUNT_PATTERN, AGV_MSG_STEERING_STATUS, "eps: set, field: angle, value: $a$f",
     "eps: unset, message: steering_status", {"4651h|0000h|2328h|4650h|3000h"}, {0u, 0u, 0u, 1u}, {0u, 0u, 60u, 60u}},
    {"ai_gear", HUNT_PATTERN, AGV_MSG_GEAR_COMMAND, "ai: set, field: gear, value: $a$f",
     "ai: unset, message: gear_command", {"03h|02h|08h|04h|01h"}, {0u, 0u, 0u, 1u}, {0u, 0u, 10u, 10u}},
    {"ai_throttle", HUNT_PATTERN, AGV_MSG_THROTTLE_COMMAND, "ai: set, field: throttle, value: $a$f",
     "ai: unset, message: throttle_command", {"FBh|FAh|00h"}, {0u, 0u, 0u, 1u}, {0u, 0u, 10u, 10u}},
    {"ai_angle", HUNT_PATTERN, AGV_MSG_STEERING_COMMAND, "ai: set, field: angle, value: $a$f",
     "ai: unset, message: steering_command", {"4651h|0000h|4650h"}, {0u, 0u, 0u, 1u}, {0u, 0u, 40u, 40u}},
    {"mute", HUNT_MESSAGE | HUNT_PATTERN, NONE, "$n: mute, message: $a$f", "$n: unmute, message: $a", {MESSAGES},
     {0u, 0u, 0u, 1u}, {0u, 0u, 12u, 12u}},
    {"slow", HUNT_MESSAGE, NONE, "$n: send_every, message: $a, every_ms: $e",
     "$n: send_every, message: $a, every_ms: $t", {MESSAGES}, {0u, 1u, 0u, 0u}, {0u, 100u, 0u, 0u}},
    {"stop", 0u, NONE, "$a: stop", "$a: start", {NODES}, {0u}, {0u}},
    {"freeze", 0u, NONE, "$a: freeze_counter", "$a: run_counter", {NODES}, {0u}, {0u}},
    {"lag", 0u, NONE, "$a: lag, by_ms: $b", "$a: lag, by_ms: 0", {NODES}, {0u, 1u, 0u, 0u}, {0u, 60u, 0u, 0u}},
    {"garbage", 0u, NONE, "$a: garbage, kind: $b", "$a: recover", {NODES, "random|wrong_length|extended|remote"}, {0u},
     {0u}},
    {"restart", 0u, NONE, "$a: restart, off_ms: $b", "", {NODES}, {0u, 20u, 0u, 0u}, {0u, 4000u, 0u, 0u}},
    {"stuck_steering", 0u, NONE, "eps: stick", "eps: unstick", {NULL}, {0u}, {0u}},
    {"weave", 0u, NONE,
     "ai: drive, gear: D, throttle_pct: $d, steer_deg: $b$w|+$c ai: drive, gear: D, throttle_pct: $d, steer_deg: "
     "-$b$w",
     "", {NULL}, {0u, 20u, 100u, 10u}, {0u, 300u, 1500u, 60u}},
    {"drive", 0u, NONE, "ai: drive, gear: $a, throttle_pct: $b, steer_deg: $z", "", {"D|R|N|P"}, {0u}, {0u, 100u, 180u, 0u}},
    {"stubborn_ai", 0u, NONE, "ai: be_stubborn", "ai: be_obedient", {NULL}, {0u}, {0u}},
    {"ask_off", 0u, NONE, "ai: ask_autopilot_off", "ai: ask_nothing", {NULL}, {0u}, {0u}},
    {"ai_repeats", 0u, NONE, "ai: repeat, times: $b", "ai: repeat, times: 0", {NULL}, {0u, 1u, 0u, 0u},
     {0u, 40u, 0u, 0u}},
    {"ai_fast", HUNT_MESSAGE, NONE, "ai: send_every, message: $a, every_ms: $b",
     "ai: send_every, message: $a, every_ms: $t", {COMMANDS}, {0u, 1u, 0u, 0u}, {0u, 60u, 0u, 0u}},
    {"second_sender", HUNT_MESSAGE | HUNT_SHORT_BYTES, NONE,
     "bus: send, side: $s, message: $a, bytes: \"$y\", every_ms: $b", "bus: stop_sending", {COMMANDS, NULL, VALUES},
     {0u, 1u, 0u, 1u}, {0u, 120u, 0u, 14u}},
    {"sender_behind", HUNT_MESSAGE | HUNT_SHORT_BYTES, NONE,
     "+$k bus: send, side: $s, message: $a, bytes: \"$y\", every_ms: $t", "bus: stop_sending", {COMMANDS, NULL, VALUES},
     {0u, 0u, 0u, 1u}, {0u, 0u, 0u, 14u}},
    {"foreign_sender", HUNT_GATEWAY | HUNT_MESSAGE | HUNT_SHORT_BYTES, NONE,
     "bus: send, side: vehicle, message: $a, bytes: \"$y\", every_ms: $b", "bus: stop_sending",
     {COMMANDS, NULL, VALUES}, {0u, 1u, 0u, 1u}, {0u, 400u, 0u, 14u}},
    {"any_id", 0u, NONE, "bus: send, id: $i, bytes: \"$y\", every_ms: $b", "bus: stop_sending", {NULL, NULL, VALUES},
     {0u, 1u, 0u, 1u}, {0x7FFu, 50u, 0u, 8u}},
    {"fd", HUNT_MESSAGE | HUNT_SHORT_BYTES, NONE, "bus: deliver, side: $s, kind: fd, message: $a, bytes: \"$y\"$r", "",
     {COMMANDS, NULL, VALUES}, {0u, 1u, 0u, 1u}, {0u, 200u, 0u, 14u}},
    {"foreign_fd", HUNT_GATEWAY | HUNT_MESSAGE | HUNT_SHORT_BYTES, NONE,
     "bus: deliver, side: vehicle, kind: fd, message: $a, bytes: \"$y\"$r", "", {COMMANDS, NULL, VALUES},
     {0u, 1u, 0u, 1u}, {0u, 400u, 0u, 14u}},
    {"dead_transmitter", 0u, NONE, "supervisor: stall_tx", "supervisor: free_tx", {NULL}, {0u}, {0u}},
    {"ai_bus_off", HUNT_GATEWAY, NONE, "supervisor: bus_off, side: ai$r", "", {NULL}, {0u, 1u, 0u, 0u},
     {0u, 500u, 0u, 0u}},
    {"bus_off", 0u, NONE, "supervisor: bus_off", "", {NULL}, {0u}, {0u}},
    {"destroyed_frames", 0u, NONE, "bus: destroy, frames: $a$r", "", {NULL}, {1u, 2u, 0u, 0u}, {12u, 200u, 0u, 0u}},
    {"stuck_button", 0u, NONE, "operator: press, button: 1", "operator: release, button: 1", {NULL}, {0u}, {0u}},
    {"presses", 0u, NONE, "operator: press, button: 1$w|+$c operator: release, button: 1$w",
     "+1 operator: release, button: 1", {NULL}, {0u, 0u, 200u, 0u}, {0u, 0u, 2500u, 0u}},
    {"reset_and_engage", 0u, NONE,
     "operator: press, button: 1|+$a operator: release, button: 1|+$c operator: engage|+$c ai: drive, gear: D, "
     "throttle_pct: $d, steer_deg: $b",
     "", {NULL}, {1100u, 0u, 2600u, 10u}, {2500u, 90u, 4500u, 60u}},
    {"reengage", 0u, NONE, "operator: disengage|+$b operator: engage", "", {NULL}, {0u, 10u, 0u, 0u},
     {0u, 3000u, 0u, 0u}},
    {"engage_flaps", 0u, NONE, "operator: disengage$g|+$b operator: engage$g", "", {NULL}, {0u, 10u, 0u, 100u},
     {0u, 300u, 0u, 2000u}},
    {"hand_steers", 0u, NONE, "operator: steer, steer_deg: $z", "", {NULL}, {0u}, {0u, 0u, 180u, 0u}},
    {"remote_drive", 0u, NONE, "operator: drive, gear: $a, throttle_pct: $b", "", {"D|R|N|P"}, {0u}, {0u, 60u, 0u, 0u}},
    {"remote_lost", 0u, NONE, "operator: lose_remote_signal", "operator: regain_remote_signal", {NULL}, {0u}, {0u}},
    {"take_over", 0u, NONE, "operator: disengage", "", {NULL}, {0u}, {0u}},
};

const size_t HUNT_ATTACK_COUNT = sizeof HUNT_ATTACKS / sizeof HUNT_ATTACKS[0];

size_t hunt_attack_of_reset(void) {
    for (size_t i = 0u; i < HUNT_ATTACK_COUNT; i++) {
        if (strcmp(HUNT_ATTACKS[i].name, "reset_and_engage") == 0) {
            return i;
        }
    }
    return 0u;
}

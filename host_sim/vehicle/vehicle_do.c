/* The actions. */
#include <stdlib.h>

#include "vehicle/vehicle_internal.h"

#define UM_PER_MM 1000

static bool gear_is_valid(uint8_t gear) {
    return (gear == AGV_GEAR_P) || (gear == AGV_GEAR_R) || (gear == AGV_GEAR_N) || (gear == AGV_GEAR_D);
}

static bool drive_is_valid(const vehicle_action_t *action) {
    return gear_is_valid(action->gear) && (action->throttle_permille <= AGV_THROTTLE_MAX_PERMILLE);
}

static bool angle_is_valid(const vehicle_action_t *action) {
    return (action->angle_ddeg >= -AGV_ANGLE_MAX_DDEG) && (action->angle_ddeg <= AGV_ANGLE_MAX_DDEG);
}

/** Wheels and steering have run until now as they were. */
static void recover(vehicle_t *vehicle, uint64_t now_ms, vehicle_node_t node) {
    vehicle_dynamics_move(vehicle, now_ms);
    vehicle_eps_move(vehicle, now_ms);
    vehicle_recover(vehicle, node);
}

static bool do_to_node(vehicle_t *vehicle, uint64_t now_ms, const vehicle_action_t *action) {
    vehicle_node_state_t *node = &vehicle->nodes[action->node];

    switch (action->what) {
    case VEHICLE_DO_START:
    case VEHICLE_DO_STOP:
        vehicle_power(vehicle, action->node, action->what == VEHICLE_DO_START, now_ms);
        break;
    case VEHICLE_DO_RESTART:
        vehicle_power(vehicle, action->node, false, now_ms);
        node->start_ms = now_ms + action->ms;
        break;
    case VEHICLE_DO_FREEZE:
    case VEHICLE_DO_UNFREEZE:
        node->frozen = action->what == VEHICLE_DO_FREEZE;
        break;
    case VEHICLE_DO_LAG:
        node->lag_ms = action->ms;
        break;
    case VEHICLE_DO_REPEAT:
        node->repeat = action->count;
        break;
    case VEHICLE_DO_GARBAGE:
        node->garbage = (uint8_t)action->garbage;
        break;
    default:
        recover(vehicle, now_ms, action->node);
        break;
    }
    return true;
}

static void set_delay(vehicle_message_t *message, uint32_t ms) {
    if (message->delay_ms == 0) {
        message->past.count = 0;
    }
    message->delay_ms = ms;
}

static bool do_to_message(vehicle_t *vehicle, uint64_t now_ms, const vehicle_action_t *action) {
    vehicle_message_t *message = &vehicle->messages[action->message];
    uint64_t *due_ms = &vehicle->message_ms[action->message];

    switch (action->what) {
    case VEHICLE_DO_MUTE:
    case VEHICLE_DO_UNMUTE:
        message->muted =
            vehicle_stretch((action->what == VEHICLE_DO_MUTE) ? action->count : (uint16_t)0, action->every);
        break;
    case VEHICLE_DO_PERIOD:
        message->period_ms = action->ms;
        if ((*due_ms != UINT64_MAX) && (*due_ms > now_ms + action->ms)) {
            *due_ms = now_ms + action->ms;
        }
        break;
    case VEHICLE_DO_PATCH:
    case VEHICLE_DO_HOLD:
        vehicle_patch(message, action);
        break;
    case VEHICLE_DO_DELAY:
        set_delay(message, action->ms);
        break;
    case VEHICLE_DO_IGNORE:
        message->ignored = action->on;
        break;
    default:
        vehicle_unpatch(message);
        break;
    }
    return true;
}

static bool do_to_vcu(vehicle_t *vehicle, uint64_t now_ms, const vehicle_action_t *action) {
    vehicle_vcu_faults_t *faults = &vehicle->vcu_faults;

    vehicle_dynamics_move(vehicle, now_ms); /* until now it was as it was */
    switch (action->what) {
    case VEHICLE_DO_VCU_RAMP:
        faults->ramps = true;
        faults->throttle_fall_pct_s = action->count;
        break;
    case VEHICLE_DO_VCU_ROLL:
        faults->rolls = action->on;
        faults->roll_um_s = action->speed_mm_s * UM_PER_MM;
        break;
    case VEHICLE_DO_VCU_ROLL_ON:
        faults->rolls = true;
        faults->roll_um_s = vehicle->dynamics.speed_um_s;
        break;
    case VEHICLE_DO_VCU_REFUSE_PARK:
        faults->refuses_park = action->on;
        break;
    default:
        faults->is_sloppy = action->on;
        break;
    }
    return true;
}

static vehicle_swing_t swing_of(uint64_t now_ms, const vehicle_action_t *action) {
    return (vehicle_swing_t){.from_ms = now_ms, .period_ms = action->ms, .amplitude_ddeg = action->angle_ddeg};
}

static bool do_to_eps(vehicle_t *vehicle, uint64_t now_ms, const vehicle_action_t *action) {
    vehicle_eps_move(vehicle, now_ms);
    if (action->what == VEHICLE_DO_EPS_STUCK) {
        vehicle->operator.eps_stuck = action->on;
    } else {
        vehicle->operator.eps_hunt = swing_of(now_ms, action);
    }
    return true;
}

static bool do_to_ai(vehicle_t *vehicle, uint64_t now_ms, const vehicle_action_t *action) {
    vehicle_operator_t *operator= & vehicle->operator;

    switch (action->what) {
    case VEHICLE_DO_AI_DRIVE:
        operator->ai_gear = action->gear;
        operator->ai_throttle_permille = action->throttle_permille;
        operator->ai_angle_ddeg = action->angle_ddeg;
        vehicle_ai_reconsider(vehicle);
        return true;
    case VEHICLE_DO_AI_IDLE:
        operator->ai_gear = AGV_GEAR_N;
        operator->ai_throttle_permille = 0;
        operator->ai_angle_ddeg = 0;
        vehicle_ai_reconsider(vehicle);
        return true;
    case VEHICLE_DO_AI_STUBBORN:
        operator->ai_stubborn = action->on;
        vehicle_ai_reconsider(vehicle);
        return true;
    case VEHICLE_DO_AI_WEAVE:
        operator->ai_weave = swing_of(now_ms, action);
        return true;
    default:
        operator->ai_autopilot_off = action->on;
        return true;
    }
}

static bool press(vehicle_operator_t *operator, const vehicle_action_t * action) {
    if (action->count == 1) {
        operator->button_1 = action->on;
    } else {
        operator->button_2 = action->on;
    }
    return (action->count == 1) || (action->count == 2);
}

/** Signal or power of the remote controller came or went: wheels and gear box have run until now as it was before. */
static bool switch_remote(vehicle_t *vehicle, uint64_t now_ms, bool *lost, bool is_lost) {
    vehicle_dynamics_move(vehicle, now_ms);
    *lost = is_lost;
    if (is_lost) {
        vehicle->operator.remote_throttle_permille = 0;
        vehicle->vcu.throttle_permille = vehicle->vcu.autopilot ? vehicle->vcu.throttle_permille : (uint16_t)0;
    }
    return true;
}

static bool do_as_operator(vehicle_t *vehicle, uint64_t now_ms, const vehicle_action_t *action) {
    vehicle_operator_t *operator= & vehicle->operator;

    switch (action->what) {
    case VEHICLE_DO_ENGAGE:
        vehicle_vcu_engage(vehicle, now_ms);
        return true;
    case VEHICLE_DO_DISENGAGE:
        vehicle_vcu_disengage(vehicle, now_ms);
        return true;
    case VEHICLE_DO_BUTTON:
        return press(operator, action);
    case VEHICLE_DO_REMOTE_DRIVE:
        operator->remote_gear = action->gear;
        operator->remote_throttle_permille = action->throttle_permille;
        vehicle_vcu_remote(vehicle, now_ms);
        return true;
    case VEHICLE_DO_HAND_STEER:
        vehicle_eps_move(vehicle, now_ms);
        operator->hand_steers = true;
        operator->hand_ddeg = action->angle_ddeg;
        return true;
    case VEHICLE_DO_REMOTE_SIGNAL:
        return switch_remote(vehicle, now_ms, &operator->remote_signal_lost, !action->on);
    default:
        return switch_remote(vehicle, now_ms, &operator->remote_power_lost, !action->on);
    }
}

static bool is_in_range(const vehicle_action_t *action) {
    switch (action->what) {
    case VEHICLE_DO_AI_DRIVE:
        return drive_is_valid(action) && angle_is_valid(action);
    case VEHICLE_DO_REMOTE_DRIVE:
        return drive_is_valid(action);
    case VEHICLE_DO_HAND_STEER:
    case VEHICLE_DO_AI_WEAVE:
    case VEHICLE_DO_EPS_HUNT:
        return angle_is_valid(action);
    case VEHICLE_DO_DELAY:
        return action->ms <= VEHICLE_DELAY_MAX_MS;
    case VEHICLE_DO_VCU_ROLL:
        return abs(action->speed_mm_s) <= VEHICLE_ROLL_MAX_MM_S;
    case VEHICLE_DO_SEND:
        return (unsigned)action->side < HAL_CAN_SIDES;
    default:
        return true;
    }
}

static void stop_rogue_nodes(vehicle_t *vehicle) {
    for (unsigned i = 0; i < VEHICLE_ROGUES_MAX; i++) {
        vehicle->rogues[i].left = 0;
    }
}

bool vehicle_do(vehicle_t *vehicle, uint64_t now_ms, const vehicle_action_t *action) {
    vehicle_look_again(vehicle, now_ms);
    if (!is_in_range(action)) {
        return false;
    }
    if (action->what <= VEHICLE_DO_RECOVER) {
        return ((unsigned)action->node < VEHICLE_NODES) && do_to_node(vehicle, now_ms, action);
    }
    if (action->what <= VEHICLE_DO_UNPATCH) {
        return ((unsigned)action->message < AGV_MSG_COUNT) && do_to_message(vehicle, now_ms, action);
    }
    if (action->what <= VEHICLE_DO_VCU_SLOPPY) {
        return do_to_vcu(vehicle, now_ms, action);
    }
    if (action->what <= VEHICLE_DO_AI_WEAVE) {
        return do_to_ai(vehicle, now_ms, action);
    }
    if (action->what <= VEHICLE_DO_EPS_HUNT) {
        return do_to_eps(vehicle, now_ms, action);
    }
    if (action->what <= VEHICLE_DO_REMOTE_POWER) {
        return do_as_operator(vehicle, now_ms, action);
    }
    if (action->what == VEHICLE_DO_SEND) {
        return vehicle_add_rogue(vehicle, now_ms, action);
    }
    stop_rogue_nodes(vehicle);
    return action->what == VEHICLE_DO_STOP_SENDING;
}

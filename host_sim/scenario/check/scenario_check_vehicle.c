/* Judging: the state of the vehicle. */
#include "scenario/check/scenario_check.h"

bool scenario_check_wants_vehicle(const scenario_check_t *check, uint32_t t_ms) {
    for (size_t i = 0; i < check->expect.vehicle.count; i++) {
        if (scenario_check_is_in(t_ms, check->expect.vehicle.items[i].at_ms) && !check->vehicle_seen[i]) {
            return true;
        }
    }
    return false;
}

/** What of an expectation does not hold: each is reported, or (no check) counted only. */
typedef struct {
    scenario_check_t *check;
    const scenario_vehicle_t *expected;
    size_t count;
} judging_t;

static void judge_range(judging_t *judging, bool has, const char *what, const int32_t range[2], int32_t seen) {
    if (!has || ((seen >= range[0]) && (seen <= range[1]))) {
        return;
    }
    judging->count++;
    if (judging->check != NULL) {
        char window[SCENARIO_WINDOW_TEXT_SIZE];
        scenario_check_window_text(judging->expected->at_ms, window);
        scenario_check_fail(judging->check, judging->expected->line, "vehicle %s: %s %d..%d is expected, seen: %d",
                            window, what, (int)range[0], (int)range[1], (int)seen);
    }
}

static void judge_code(judging_t *judging, bool has, const char *what, unsigned wanted, unsigned seen) {
    if (!has || (wanted == seen)) {
        return;
    }
    judging->count++;
    if (judging->check != NULL) {
        char window[SCENARIO_WINDOW_TEXT_SIZE];
        scenario_check_window_text(judging->expected->at_ms, window);
        scenario_check_fail(judging->check, judging->expected->line, "vehicle %s: %s %Xh is expected, seen: %Xh",
                            window, what, wanted, seen);
    }
}

/** Compare. @param check NULL: nothing is reported @return whether all of it holds */
static bool judge(scenario_check_t *check, const scenario_vehicle_t *expected, const vehicle_view_t *view) {
    judging_t judging = {check, expected, 0};

    judge_code(&judging, expected->has_gear, "gear (P 8, R 2, N 4, D 1)", expected->gear, view->gear);
    judge_code(&judging, expected->has_mode, "mode (manual 0, autopilot 1)", expected->autopilot, view->autopilot);
    judge_code(&judging, expected->has_eps_mode, "EPS mode", expected->eps_mode, view->eps_mode);
    judge_code(&judging, expected->has_alarms, "VCU alarms", expected->alarms, view->alarms);
    judge_range(&judging, expected->has_speed, "speed in mm/s", expected->speed_mm_s, view->speed_mm_s);
    judge_range(&judging, expected->has_throttle, "throttle in %", expected->throttle_pct,
                view->throttle_permille / 10);
    judge_range(&judging, expected->has_angle, "steering in degrees", expected->angle_deg, view->angle_ddeg / 10);
    judge_range(&judging, expected->has_fastest_park, "highest speed in mm/s at which P was engaged",
                expected->fastest_park_mm_s, view->fastest_park_mm_s);
    return judging.count == 0;
}

void scenario_check_vehicle(scenario_check_t *check, uint32_t t_ms, const vehicle_view_t *view) {
    for (size_t i = 0; i < check->expect.vehicle.count; i++) {
        const scenario_vehicle_t *expected = &check->expect.vehicle.items[i];
        if (!scenario_check_is_in(t_ms, expected->at_ms) || check->vehicle_seen[i]) {
            continue;
        }
        const bool is_last = t_ms == expected->at_ms.to;
        check->vehicle_seen[i] = judge(is_last ? check : NULL, expected, view) || is_last;
    }
}

void scenario_check_vehicle_finish(scenario_check_t *check) {
    for (size_t i = 0; i < check->expect.vehicle.count; i++) {
        const scenario_vehicle_t *expected = &check->expect.vehicle.items[i];
        char window[SCENARIO_WINDOW_TEXT_SIZE];
        if (!check->vehicle_seen[i]) {
            scenario_check_window_text(expected->at_ms, window);
            scenario_check_fail(check, expected->line,
                                "vehicle %s: the expected values were not seen before the end of the run", window);
        }
    }
}

/*
 * Benchmark of supervisor and vehicle on the simulated bus: an hour of healthy driving, in which every tick is run.
 *
 *     bench_sim [SECONDS] [LEAST]     simulated seconds (3600); minimum speed in multiples of real time (0)
 *
 * Prints one line for each part and topology. "vehicle alone" is the vehicle on a bus without a supervisor.
 * The exit status is 1 below the minimum speed.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "scenario/scenario_testbed.h"

enum { SETTLED_MS = 3000, DEFAULT_S = 3600 };

#define MS_PER_S 1000u

static double seconds_now(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now); /* so that other load on the machine does not count */
    return (double)now.tv_sec + ((double)now.tv_nsec * 1e-9);
}

static void act(scenario_testbed_t *testbed, uint32_t at_ms, vehicle_action_t action) {
    const scenario_step_t step = {.at_ms = at_ms, .of_vehicle = true, .vehicle = action};
    scenario_testbed_do(testbed, &step);
}

/** Healthy driving on autopilot. @return speed in multiples of real time; 0: a fault occurred */
static double drive(scenario_testbed_t *testbed, uint16_t topology, uint32_t duration_ms) {
    static scenario_t scenario;
    scenario = (scenario_t){.bitrate = SCENARIO_DEFAULT_BITRATE};
    agv_config_defaults(&scenario.config);
    vehicle_defaults(&scenario.vehicle);
    scenario.config.topology = topology;
    scenario.vehicle.gateway = topology == AGV_TOPOLOGY_GATEWAY;
    if (!scenario_testbed_init(testbed, &scenario)) {
        return 0.0;
    }
    scenario_testbed_start(testbed);
    const double begin = seconds_now();
    for (uint32_t t_ms = 0; t_ms < duration_ms; t_ms++) {
        if (t_ms == SETTLED_MS) {
            act(testbed, t_ms,
                (vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = AGV_GEAR_D, .throttle_permille = 300});
            act(testbed, t_ms, (vehicle_action_t){.what = VEHICLE_DO_ENGAGE});
        }
        scenario_testbed_tick(testbed, t_ms);
    }
    const double took = seconds_now() - begin;
    vehicle_view_t view;
    scenario_testbed_vehicle(testbed, &view);
    sim_bus_stats_t stats;
    scenario_testbed_bus_stats(testbed, HAL_CAN_VEHICLE, &stats);
    scenario_testbed_view_t seen;
    scenario_testbed_view(testbed, &seen);
    const agv_supervisor_t *supervisor = &scenario_testbed_session(testbed)->supervisor;
    const bool healthy = (agv_supervisor_state(supervisor) == AGV_STATE_ACTIVE) &&
                         (agv_supervisor_counters(supervisor)->warnings == 0) && (view.speed_mm_s > 0) &&
                         (seen.lost_frames == 0);
    const double factor = ((double)duration_ms / MS_PER_S) / took;
    (void)printf("%-14s %8.0f times real time, %6.1f ns a tick, %" PRIu64 " frames, %s\n",
                 (topology == AGV_TOPOLOGY_GATEWAY) ? "gateway" : "shared bus", factor, took * 1e9 / duration_ms,
                 stats.frames, healthy ? "healthy" : "NOT HEALTHY");
    return healthy ? factor : 0.0;
}

static void ignore(void *ctx, vehicle_node_t from, hal_can_side_t side, const hal_can_frame_t *frame) {
    (void)from;
    (void)side;
    (void)frame;
    ++*(uint64_t *)ctx;
}

static void vehicle_alone(uint32_t duration_ms) {
    static vehicle_t vehicle;
    vehicle_config_t config;
    uint64_t frames = 0;
    vehicle_defaults(&config);
    vehicle_init(&vehicle, &config, ignore, &frames);
    const double begin = seconds_now();
    for (uint32_t t_ms = 0; t_ms < duration_ms; t_ms++) {
        vehicle_tick(&vehicle, t_ms);
    }
    const double took = seconds_now() - begin;
    (void)printf("%-14s %8.0f times real time, %6.1f ns a tick, %" PRIu64 " frames\n", "vehicle alone",
                 ((double)duration_ms / MS_PER_S) / took, took * 1e9 / duration_ms, frames);
}

/** A whole number of decimal digits. @return -1: not a number */
static long number_of(int argc, char **argv, int index, long otherwise) {
    if (index >= argc) {
        return otherwise;
    }
    char *end = NULL;
    const long number = strtol(argv[index], &end, 10);
    return ((argv[index][0] >= '0') && (argv[index][0] <= '9') && (*end == '\0')) ? number : -1;
}

int main(int argc, char **argv) {
    const long seconds = number_of(argc, argv, 1, DEFAULT_S);
    const long least = number_of(argc, argv, 2, 0);
    if ((argc > 3) || (seconds < 4) || (seconds > 4000000) || (least < 0)) {
        (void)fprintf(stderr, "usage: bench_sim [SECONDS (4 .. 4000000)] [LEAST]\n");
        return 2;
    }
    scenario_testbed_t *testbed = malloc(sizeof *testbed);
    if (testbed == NULL) {
        (void)fprintf(stderr, "bench_sim: out of memory\n");
        return 2;
    }
    const uint32_t duration_ms = (uint32_t)seconds * MS_PER_S;
    const double shared = drive(testbed, AGV_TOPOLOGY_SHARED, duration_ms);
    const double gateway = drive(testbed, AGV_TOPOLOGY_GATEWAY, duration_ms);
    vehicle_alone(duration_ms);
    free(testbed);
    if ((shared <= (double)least) || (gateway <= 0.0)) {
        (void)fprintf(stderr, "bench_sim: the shared bus must run without faults and faster than %ld times real time\n",
                      least);
        return 1;
    }
    return 0;
}

/*
 * Benchmark of the simulated bus: time of an idle millisecond, and of a frame.
 *
 * bench_bus [SIMULATED_SECONDS]   (default 600)
 *
 * Five rows, each the best of five passes:
 *   idle              a tick of 1 ms on a quiet bus, four nodes attached
 *   frames            700 frames a second (as the vehicle sends), one sender, one receiver with a callback
 *   vehicle           the same, two nodes that send, four that receive, one of them a simulated port that takes its
 *                     frames from its queue each tick and reads its controller's state
 *   direct            hal_can_send() of a port without a bus, a frame
 *   all of it         a simulated second of the row "vehicle", in microseconds, and its speed in multiples of real time
 */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "hal_sim/sim_bus.h"
#include "hal_sim/sim_hal.h"

#define PASSES 5
#define BITRATE 500000u
#define FRAMES_A_SECOND 700u

typedef struct {
    sim_bus_t bus;
    struct hal hal;
    sim_bus_node_t nodes[4];
    unsigned node_count;
    bool with_hal;
    bool with_frames;
    uint64_t received;
} bench_t;

static double cpu_ns(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now); /* so that other load on the machine does not count */
    return (double)now.tv_sec * 1e9 + (double)now.tv_nsec;
}

static void count(void *ctx, const hal_can_frame_t *frame) {
    bench_t *bench = ctx;
    bench->received += frame->length / 8;
}

static void count_sent(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame) {
    (void)side;
    count(ctx, frame);
}

static void setup(bench_t *bench, unsigned nodes, bool with_hal, bool with_frames) {
    if (!sim_bus_init(&bench->bus, BITRATE)) {
        abort();
    }
    bench->node_count = nodes;
    bench->with_hal = with_hal;
    bench->with_frames = with_frames;
    bench->received = 0;
    const sim_bus_node_config_t config = {.on_receive = count, .ctx = bench};
    for (unsigned i = 0; i < nodes; i++) {
        bench->nodes[i] = sim_bus_attach(&bench->bus, &config);
    }
    sim_hal_init(&bench->hal, NULL);
    if (with_hal) {
        sim_hal_attach(&bench->hal, HAL_CAN_VEHICLE, &bench->bus, NULL);
    }
}

/* Seven frames every 10 ms: in the first millisecond four, in the sixth three. */
static void send(bench_t *bench, uint64_t tick) {
    static const uint16_t IDS[7] = {0x363, 0x067, 0x167, 0x267, 0x050, 0x101, 0x0A3};
    const unsigned phase = (unsigned)(tick % 10);
    const unsigned first = phase == 0 ? 0 : 4;
    const unsigned last = phase == 0 ? 4 : phase == 5 ? 7 : 0;
    for (unsigned i = first; i < last; i++) {
        hal_can_frame_t frame = {.id = IDS[i], .length = 8, .data = {(uint8_t)tick}};
        if (!sim_bus_send(&bench->bus, bench->nodes[i & 1], &frame)) {
            abort();
        }
    }
}

static void pump(bench_t *bench) {
    hal_can_frame_t frame;
    hal_can_status_t status;
    while (sim_hal_receive(&bench->hal, HAL_CAN_VEHICLE, &frame)) {
        count(bench, &frame);
    }
    hal_can_status(&bench->hal, HAL_CAN_VEHICLE, &status);
    hal_watchdog_feed(&bench->hal);
}

static double run_ns(bench_t *bench, uint64_t ticks) {
    const double start = cpu_ns();
    for (uint64_t tick = 0; tick < ticks; tick++) {
        if (bench->with_frames) {
            send(bench, tick);
        }
        sim_bus_run_until(&bench->bus, (tick + 1) * 1000);
        if (bench->with_hal) {
            pump(bench);
        }
    }
    return cpu_ns() - start;
}

static double best_ns(bench_t *bench, uint64_t seconds, unsigned nodes, bool with_hal, bool with_frames) {
    double best = 1e300;
    for (int pass = 0; pass < PASSES; pass++) {
        setup(bench, nodes, with_hal, with_frames);
        const double ns = run_ns(bench, seconds * 1000);
        best = ns < best ? ns : best;
    }
    return best / (double)seconds;
}

static double direct_ns(bench_t *bench, uint64_t frames) {
    double best = 1e300;
    hal_can_frame_t frame = {.id = 0x168, .length = 8};
    for (int pass = 0; pass < PASSES; pass++) {
        sim_hal_init_direct(&bench->hal, NULL, 1, count_sent, bench);
        const double start = cpu_ns();
        for (uint64_t i = 0; i < frames; i++) {
            frame.data[0] = (uint8_t)i;
            hal_can_send(&bench->hal, HAL_CAN_VEHICLE, &frame);
        }
        const double ns = cpu_ns() - start;
        best = ns < best ? ns : best;
    }
    return best / (double)frames;
}

int main(int argc, char **argv) {
    const long seconds = argc > 1 ? strtol(argv[1], NULL, 10) : 600;
    bench_t *bench = calloc(1, sizeof *bench);
    if (bench == NULL || seconds < 1 || seconds > 1000000) {
        fprintf(stderr, "bench_bus: the simulated seconds must be 1..1000000\n");
        free(bench);
        return 2;
    }
    const uint64_t run_s = (uint64_t)seconds;
    const double idle = best_ns(bench, run_s, 4, false, false);
    const double frames = best_ns(bench, run_s, 2, false, true);
    const double vehicle_idle = best_ns(bench, run_s, 4, true, false);
    const double vehicle = best_ns(bench, run_s, 4, true, true);
    printf("idle       %6.1f ns a tick\n", idle / 1000.0);
    printf("frames     %6.1f ns a frame\n", (frames - idle) / FRAMES_A_SECOND);
    printf("vehicle    %6.1f ns a frame, %.1f ns a tick without\n", (vehicle - vehicle_idle) / FRAMES_A_SECOND,
           vehicle_idle / 1000.0);
    printf("direct     %6.1f ns a frame sent\n", direct_ns(bench, run_s * FRAMES_A_SECOND));
    printf("all of it  %6.1f us a simulated second: %.0f times real time\n", vehicle / 1000.0, 1e9 / vehicle);
    free(bench);
    return 0;
}

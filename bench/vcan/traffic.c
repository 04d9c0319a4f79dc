/*
 * Simulates the vehicle for one measured program, the subject. Reads its commands from standard input.
 *
 *     bench_vcan_traffic [--ai INTERFACE] [--keep] [--stateless] VEHICLE-INTERFACE [COMMAND...]
 *
 *     --ai         a gateway: the AI computer is on this interface
 *     --keep       the subject runs on between trials and the operator resets it; default: it is started for each trial
 *     --stateless  the subject prints no states: it counts as ready as soon as it runs
 *     COMMAND      starts the subject; without: the kernel's gateway is measured
 *
 * Commands, one a line, and their output:
 *
 *     frame N        N trials with a fault in 167h. Each prints "first NS gear NS": times from that frame to the first
 *                    frame of the safe state, and to gear P
 *     silence N      N trials in which 065h stops: the same from the last 065h + 125 ms
 *                    Both also print "repeated N" (trials with a trip before the fault) and "missed N" (no gear P within
 *                    2 s)
 *     pass MS        "status NS", "command NS" for each 101h and 065h that passed a gateway; "lost N"
 *     flood RATE MS  RATE frames a second: "sent N ns N cpu_ns N lost N tripped N"; "lost" are the sent frames that are
 *                    missing in the subject's own count of received frames
 *
 * "done" ends the output of a command. With --keep the subject is stopped (SIGSTOP) between two commands.
 */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "player.h"
#include "subject.h"

#define STEERING_DEADLINE_NS 125000000u
#define START_TIMEOUT_MS 180000u
#define READY_TIMEOUT_MS 30000u
#define MISSED_AFTER_MS 2000u
#define SETTLE_MS 30u /* longer than the cycle of 065h */
#define SETTLE_MORE_MS 25u
#define RELEASED_MS 40u
#define DRAIN_MS 1000u
#define REPEATED_MORE 10u
#define WAKE_MS 200u
#define WAKE_TRIES 15u
#define DRAIN_TRIES 50u /* frames that are still queued after that count as lost */
#define REGULAR_FRAMES_A_SECOND 710u

typedef enum { FAULT_FRAME, FAULT_SILENCE } fault_t;

typedef struct {
    player_t player;
    subject_t subject;
    bool keep;
    bool stateless;
    uint64_t sent_then; /* value of player.sent when the subject was started */
} bench_t;

typedef bool condition_fn(const bench_t *bench);

static void fail(const char *why) {
    (void)fprintf(stderr, "bench_vcan_traffic: %s\n", why);
    exit(2);
}

static bool never(const bench_t *bench) {
    (void)bench;
    return false;
}

static bool is_safe(const bench_t *bench) {
    uint64_t any = 0;
    for (unsigned i = 0; i < PLAYER_SAFE_COUNT; i++) {
        any |= bench->player.safe_ns[i];
    }
    return any != 0;
}

static bool is_parked(const bench_t *bench) {
    return bench->player.safe_ns[PLAYER_SAFE_GEAR] != 0;
}

static bool is_standby(const bench_t *bench) {
    return bench->stateless || subject_is(&bench->subject, "STANDBY");
}

static bool is_active(const bench_t *bench) {
    return bench->stateless || subject_is(&bench->subject, "ACTIVE");
}

static bool has_told(const bench_t *bench) {
    return bench->subject.told_received;
}

/** Simulate the vehicle until the condition holds. @return false: timeout */
static bool play_until(bench_t *bench, condition_fn *condition, uint32_t timeout_ms) {
    const uint64_t end = player_now_ns() + ((uint64_t)timeout_ms * NS_PER_MS);
    while (!condition(bench) && (player_now_ns() < end)) {
        const int said = (bench->subject.pid != 0) ? bench->subject.output_fd : -1;
        if (player_step(&bench->player, said) && !subject_listen(&bench->subject)) {
            fail("the subject ended unexpectedly");
        }
    }
    return condition(bench);
}

static void play(bench_t *bench, uint32_t ms) {
    (void)play_until(bench, never, ms);
}

/* ---- the subject ---- */

/** Wait until a subject without states answers a fault. If it never does, the trials count it as missed. */
static void wake(bench_t *bench) {
    player_start(&bench->player);
    for (unsigned i = 0; (i < WAKE_TRIES) && !is_safe(bench); i++) {
        bench->player.eps_fault = true;
        (void)play_until(bench, is_safe, WAKE_MS);
    }
    play(bench, WAKE_MS); /* time for the answer to an earlier fault */
}

/** Start the subject on a silent bus. A subject with states sends the safe commands as soon as its socket is open. */
static void start_subject(bench_t *bench) {
    player_stop(&bench->player);
    player_forget(&bench->player);
    bench->sent_then = bench->player.sent;
    if (!subject_start(&bench->subject)) {
        exit(2);
    }
    if (bench->stateless) {
        wake(bench);
    } else if (!play_until(bench, is_safe, START_TIMEOUT_MS)) {
        fail("the subject sends nothing at its start");
    }
}

/** The operator releases the button, then presses it until the subject is reset. */
static bool reset_subject(bench_t *bench) {
    play(bench, RELEASED_MS);
    bench->player.button = true;
    const bool ready = play_until(bench, is_standby, READY_TIMEOUT_MS);
    bench->player.button = false;
    return ready;
}

/** Start the subject if necessary, and wait until it is in STANDBY on healthy traffic, in manual. */
static void get_ready(bench_t *bench) {
    const bool has_one = bench->subject.command[0] != NULL;
    bench->player.engaged = false;
    bench->player.steering_silent = false;
    if (has_one && (bench->subject.pid != 0) && !bench->keep) {
        subject_end(&bench->subject);
    }
    if (has_one && (bench->subject.pid == 0)) {
        start_subject(bench);
    }
    if (!bench->player.sending) {
        player_start(&bench->player);
    }
    if (!play_until(bench, is_standby, bench->keep ? RELEASED_MS : READY_TIMEOUT_MS) && !reset_subject(bench)) {
        fail("the subject does not reach STANDBY");
    }
}

/**
 * Engage the autopilot, and wait until the subject is ACTIVE and a random time longer. @return false: it has tripped
 */
static bool engage(bench_t *bench) {
    player_forget(&bench->player);
    bench->player.engaged = true;
    const bool active = play_until(bench, is_active, MISSED_AFTER_MS);
    play(bench, SETTLE_MS + (uint32_t)rand() % SETTLE_MORE_MS);
    return active && !is_safe(bench);
}

static void halt(bench_t *bench) {
    player_stop(&bench->player);
    bench->player.engaged = false;
    if (bench->subject.pid == 0) {
        return;
    }
    if (bench->keep) {
        play(bench, 2 * STEERING_DEADLINE_NS / NS_PER_MS); /* it trips */
        subject_signal(&bench->subject, SIGSTOP);
    } else {
        subject_end(&bench->subject);
    }
}

/* ---- commands ---- */

typedef enum { TRIAL_MEASURED, TRIAL_TOO_EARLY, TRIAL_MISSED } trial_t;

static trial_t judge(const bench_t *bench, uint64_t from_ns) {
    const uint64_t *safe = bench->player.safe_ns;
    uint64_t first = safe[PLAYER_SAFE_GEAR];
    for (unsigned i = 0; i < PLAYER_SAFE_COUNT; i++) {
        first = ((safe[i] != 0) && (safe[i] < first)) ? safe[i] : first;
    }
    if (first < from_ns) {
        return TRIAL_TOO_EARLY;
    }
    (void)printf("first %llu gear %llu\n", (unsigned long long)(first - from_ns),
                 (unsigned long long)(safe[PLAYER_SAFE_GEAR] - from_ns));
    return TRIAL_MEASURED;
}

static trial_t trial(bench_t *bench, fault_t fault) {
    const player_t *player = &bench->player;
    if (!engage(bench)) {
        return TRIAL_TOO_EARLY;
    }
    bench->player.eps_fault = fault == FAULT_FRAME;
    bench->player.steering_silent = fault == FAULT_SILENCE;
    if (!play_until(bench, is_parked, MISSED_AFTER_MS)) {
        return TRIAL_MISSED;
    }
    return judge(bench, (fault == FAULT_FRAME) ? player->fault_ns : player->steering_ns + STEERING_DEADLINE_NS);
}

static void run_trials(bench_t *bench, fault_t fault, uint32_t count) {
    uint32_t results[TRIAL_MISSED + 1] = {0};
    while (results[TRIAL_MEASURED] + results[TRIAL_MISSED] < count) {
        get_ready(bench);
        results[trial(bench, fault)]++;
        if (results[TRIAL_TOO_EARLY] > count + REPEATED_MORE) {
            fail("the subject trips repeatedly without a fault");
        }
    }
    (void)printf("repeated %u\nmissed %u\n", results[TRIAL_TOO_EARLY], results[TRIAL_MISSED]);
}

static void print_passed(const char *name, const player_passing_t *passing) {
    for (uint32_t i = 0; (i < passing->passed) && (i < PLAYER_SAMPLES); i++) {
        (void)printf("%s %llu\n", name, (unsigned long long)passing->took_ns[i]);
    }
}

static void run_pass(bench_t *bench, uint32_t ms) {
    player_t *player = &bench->player;
    get_ready(bench);
    if (!engage(bench)) {
        fail("the gateway trips without a fault");
    }
    (void)memset(&player->status, 0, sizeof player->status);
    (void)memset(&player->command, 0, sizeof player->command);
    play(bench, ms);
    print_passed("status", &player->status);
    print_passed("command", &player->command);
    (void)printf("lost %u\n", player->status.lost + player->command.lost);
}

/** Make the subject print how many frames it has received. */
static uint64_t ask_received(bench_t *bench) {
    bench->subject.told_received = false;
    if (bench->keep) {
        subject_signal(&bench->subject, SIGUSR1);
        (void)play_until(bench, has_told, READY_TIMEOUT_MS);
    } else {
        subject_end(&bench->subject);
    }
    if (!bench->subject.told_received) {
        fail("the subject does not print how many frames it has received");
    }
    return bench->subject.received;
}

/**
 * Frames that were sent since the subject started and that it has not received. With --keep it may still be reading.
 */
static uint64_t lost_until_now(bench_t *bench) {
    uint64_t received = ask_received(bench);
    for (unsigned i = 0; bench->keep && (i < DRAIN_TRIES); i++) {
        const uint64_t before = received;
        play(bench, DRAIN_MS);
        received = ask_received(bench);
        if (received == before) {
            break;
        }
    }
    return (bench->player.sent - bench->sent_then) - received;
}

/**
 * The same before a flood: with --keep the subject may have lost frames before, or received frames of other senders
 * while it was stopped (the number is then below zero, and wraps).
 */
static uint64_t lost_before(bench_t *bench) {
    const bool kept = bench->keep && (bench->subject.pid != 0);
    return kept ? lost_until_now(bench) : 0;
}

static void run_flood(bench_t *bench, uint32_t rate, uint32_t ms) {
    const uint64_t before = lost_before(bench);
    get_ready(bench);
    (void)engage(bench);
    const uint64_t sent = bench->player.sent;
    const uint64_t cpu_ns = subject_cpu_ns(&bench->subject);
    const uint64_t start_ns = player_now_ns();
    (void)player_flood(&bench->player, (rate > REGULAR_FRAMES_A_SECOND) ? rate - REGULAR_FRAMES_A_SECOND : 0);
    play(bench, ms);
    const uint64_t took_ns = player_now_ns() - start_ns;
    const uint64_t used_ns = subject_cpu_ns(&bench->subject) - cpu_ns;
    const uint64_t count = bench->player.sent - sent;
    const bool tripped = is_safe(bench);
    (void)player_flood(&bench->player, 0);
    player_stop(&bench->player);
    play(bench, DRAIN_MS);
    const uint64_t lost = lost_until_now(bench);
    (void)printf("sent %llu ns %llu cpu_ns %llu lost %llu tripped %d\n", (unsigned long long)count,
                 (unsigned long long)took_ns, (unsigned long long)used_ns, (unsigned long long)(lost - before),
                 tripped ? 1 : 0);
}

static void obey(bench_t *bench, const char *line) {
    unsigned count = 0;
    unsigned ms = 0;
    if ((bench->subject.pid != 0) && bench->keep) {
        subject_signal(&bench->subject, SIGCONT);
    }
    if (sscanf(line, "frame %u", &count) == 1) {
        run_trials(bench, FAULT_FRAME, count);
    } else if (sscanf(line, "silence %u", &count) == 1) {
        run_trials(bench, FAULT_SILENCE, count);
    } else if (sscanf(line, "pass %u", &ms) == 1) {
        run_pass(bench, ms);
    } else if (sscanf(line, "flood %u %u", &count, &ms) == 2) {
        run_flood(bench, count, ms);
    } else {
        fail("unknown command");
    }
    halt(bench);
    (void)printf("done\n");
    (void)fflush(stdout);
}

static char **take_options(bench_t *bench, const char **ai, char **argument) {
    for (; (*argument != NULL) && (strncmp(*argument, "--", 2) == 0); argument++) {
        if ((strcmp(*argument, "--ai") == 0) && (argument[1] != NULL)) {
            argument++;
            *ai = *argument;
        } else if (strcmp(*argument, "--keep") == 0) {
            bench->keep = true;
        } else if (strcmp(*argument, "--stateless") == 0) {
            bench->stateless = true;
        } else {
            fail("unknown option");
        }
    }
    return argument;
}

int main(int argc, char **argv) {
    static bench_t bench;
    const char *ai = NULL;
    char line[64];
    (void)argc;
    char **rest = take_options(&bench, &ai, argv + 1);
    if (*rest == NULL) {
        fail("the interface is missing");
    }
    if (!player_open(&bench.player, *rest, ai)) {
        return 2;
    }
    bench.subject.command = rest + 1;
    srand(1);
    while (fgets(line, sizeof line, stdin) != NULL) {
        obey(&bench, line);
    }
    if (bench.subject.pid != 0) {
        subject_end(&bench.subject);
    }
    return 0;
}

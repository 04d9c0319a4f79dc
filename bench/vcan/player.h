/**
 * @file player.h
 * Simulates VCU, EPS and AI computer for the benchmark: it sends eleven messages on their cycles, with one fault or one
 * missing message, and records the kernel's time stamps of the frames that the measured program sends.
 *
 * All times are nanoseconds. A stamp is the kernel's (SO_TIMESTAMPNS), on a socket that only listens. On a virtual bus
 * the kernel stamps a frame when it is sent, so delays of this program do not change the figures.
 */
#ifndef BENCH_VCAN_PLAYER_H
#define BENCH_VCAN_PLAYER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PLAYER_MESSAGES 11u
#define PLAYER_SIDES 2u
#define PLAYER_PENDING 64u
#define PLAYER_SAMPLES 16384u

#define NS_PER_US 1000u
#define NS_PER_MS 1000000u
#define NS_PER_S 1000000000u

typedef enum { PLAYER_VEHICLE, PLAYER_AI } player_side_t;

/** The three safe commands, and the steering held where it was measured. */
typedef enum {
    PLAYER_SAFE_THROTTLE,
    PLAYER_SAFE_GEAR,
    PLAYER_SAFE_LIGHTS,
    PLAYER_SAFE_STEERING,
    PLAYER_SAFE_COUNT
} player_safe_t;

/** A message whose frames are matched on both sides of a gateway. */
typedef struct {
    uint64_t in_ns[PLAYER_PENDING];  /**< stamps by running number; 0: passed, or never sent */
    uint64_t out_ns[PLAYER_PENDING]; /**< stamps that were read before the in_ns of the same frame */
    uint64_t took_ns[PLAYER_SAMPLES];
    uint32_t passed; /**< frames; took_ns has the times of the first PLAYER_SAMPLES */
    uint32_t lost;   /**< frames that had not passed when their number was used again */
} player_passing_t;

/** The program may set the members of the first group, and read all. */
typedef struct {
    bool engaged;         /**< autopilot, gear D, some speed; else manual, P, standstill */
    bool button;          /**< remote button 1 is pressed */
    bool eps_fault;       /**< the next 167h carries a fault, once */
    bool steering_silent; /**< the AI computer sends no 065h */

    int send_fd[PLAYER_SIDES];
    int listen_fd[PLAYER_SIDES]; /**< [PLAYER_AI]: -1 on a shared bus */
    int timer_fd;
    bool sending;
    uint64_t due_ns[PLAYER_MESSAGES];
    uint32_t count[PLAYER_MESSAGES];
    uint64_t extra_ns; /**< time from one additional status frame to the next; 0: none */
    uint64_t extra_due_ns;
    unsigned extra_next;
    uint64_t sent; /**< frames, since the player was opened */

    uint64_t safe_ns[PLAYER_SAFE_COUNT]; /**< stamp of the first since player_forget(); 0: none */
    uint64_t fault_ns;                   /**< stamp of the last 167h with a fault */
    uint64_t steering_ns;                /**< stamp of the AI computer's last 065h */
    player_passing_t status;             /**< 101h, from the vehicle side to the AI side */
    player_passing_t command;            /**< 065h, the other way */
} player_t;

/** CLOCK_MONOTONIC. */
uint64_t player_now_ns(void);

/** Open the sockets; nothing is sent yet. @param ai NULL: a shared bus. @return false: printed to standard error */
bool player_open(player_t *player, const char *vehicle, const char *ai);

/** Send all messages on their cycles from now on, the first of each at its phase. */
void player_start(player_t *player);

/** Stop sending. */
void player_stop(player_t *player);

/** Send additional status frames; 0 frames a second: stop. In the meantime only safe commands are received. */
bool player_flood(player_t *player, uint32_t frames_a_second);

/** Clear the stamps of the safe commands. */
void player_forget(player_t *player);

/**
 * Wait at most 10 ms until a frame is due or received, or `other_fd` (-1: none) can be read; then send and receive.
 * @return true: other_fd can be read
 */
bool player_step(player_t *player, int other_fd);

#endif

/*
 * What happens around the supervisor in each window, and the judge: from the bus and the safety output alone. No code of the
 * product is in it.
 */
#ifndef WORLD_H
#define WORLD_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    uint32_t side; /* hal_can_side_t */
    uint32_t id;
    uint32_t length;
    uint8_t data[8];
} frame_t;

/* Harm, one bit each. */
enum {
    HARM_MOTION =
        1, /* a frame of the supervisor moves the vehicle: another gear than P, throttle, autopilot, another angle */
    HARM_UNDONE = 2,  /* nobody reset it, but the safety output closes, or its status frame reports STANDBY or ACTIVE */
    HARM_SILENCE = 4, /* safe commands are missing for more than 500 ms, and the watchdog has not bitten */
    HARM_CLOSED = 8   /* the vehicle does not obey, and the output does not open in time */
};

enum { WORLD_KINDS = 3 }; /* of safe commands: 43Fh, 168h, 075h */

/* What the judge remembers. */
typedef struct {
    uint32_t harm;
    uint32_t safe_ms[WORLD_KINDS]; /* the last one, or since when it is due */
    bool output_closed;
    uint32_t opened_ms; /* when the output opened last */
    bool latched;       /* safe commands were seen since they are due */
    uint8_t reason;     /* of the trip, in the last status frame */
    uint64_t hash;      /* of frames and output in this millisecond */
} bus_t;

typedef struct {
    const char *name;
    uint32_t first_ms;  /* of the window; 0: the supervisor's first safe command after the start decides */
    uint32_t length_ms; /* of the window: all instructions in it are disturbed */
    uint32_t follow_ms; /* is followed for this long, from its beginning */
    bool restarts;      /* it begins with a reset of the processor by the watchdog */
} window_t;

enum { WORLD_WINDOWS = 6 };
extern const window_t WORLD[WORLD_WINDOWS];

/* Choose a window: its traffic is made. */
void world_choose(unsigned window, uint32_t topology);

/* The window begins here, as found in the undisturbed run. */
void world_begin(uint32_t first_ms);

/* The n-th frame that arrives in a millisecond; NULL: there is none. */
const frame_t *world_frame(uint32_t now_ms, uint32_t n);

/* The supervisor sent a frame, or set its output; the processor was reset, which opens the output; a millisecond is over. */
void world_sent(bus_t *bus, uint32_t now_ms, const frame_t *frame);
void world_output(bus_t *bus, uint32_t now_ms, bool closed);
void world_reset(bus_t *bus, uint32_t now_ms);
void world_passed(bus_t *bus, uint32_t now_ms);

#endif

/**
 * @file web_bus.h
 * What is on the bus of a run: the identifiers with their rates, the last frames, the last commands.
 */
#ifndef WEB_BUS_H
#define WEB_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "hal/can.h"
#include "scenario/scenario_testbed.h"
#include "web_sim.h"

enum { WEB_BUS_ROWS = 48, WEB_BUS_FRAMES = 512 };

/** A frame that was on the wire. */
typedef struct {
    uint64_t t_us;
    uint32_t number;  /**< counts from 1 */
    uint32_t message; /**< agv_message_t, SIGNALS_STATUS_FRAME, or UINT32_MAX: unknown */
    int8_t from;      /**< scenario_from_t or vehicle_node_t */
    uint8_t side;
    hal_can_frame_t frame;
} web_frame_t;

/** An identifier of one sender on one side. */
typedef struct {
    web_frame_t last;
    uint64_t gap_us; /**< between the last two */
    uint32_t total;
    uint32_t second;    /**< the second that is being counted */
    uint32_t in_second; /**< frames in it so far */
    uint32_t in_last;   /**< and in the one before */
} web_row_t;

/** All zero but for `config`: nothing yet. */
typedef struct {
    agv_config_t config;
    uint32_t bitrate;
    uint32_t count; /**< of rows */
    uint32_t frame_count;
    uint32_t second;
    uint64_t bits;      /**< of the vehicle's bus, in the second that is being counted */
    uint64_t last_bits; /**< and in the one before */
    web_row_t rows[WEB_BUS_ROWS];
    web_frame_t frames[WEB_BUS_FRAMES];
    web_frame_t commands[2][AGV_COMMAND_COUNT]; /**< of the AI computer, of the supervisor */
} web_bus_t;

/** Begin. */
void web_bus_init(web_bus_t *bus, const agv_config_t *config, uint32_t bitrate);

/** Take a frame. @param message its message with the identifiers of the run; AGV_MSG_NONE */
void web_bus_frame(web_bus_t *bus, agv_message_t message, uint64_t t_us, hal_can_side_t side, int from,
                   const hal_can_frame_t *frame);

/** Fill in the commands and the load. */
void web_bus_view(const web_bus_t *bus, uint64_t now_us, web_view_t *view);

#endif

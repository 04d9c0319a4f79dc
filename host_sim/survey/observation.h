/**
 * @file observation.h
 * What a survey gathers while frames come in: their statistics under both ID sets, the load, the interfaces.
 */
#ifndef HOST_SIM_OBSERVATION_H
#define HOST_SIM_OBSERVATION_H

#include "logs/candump_line.h"
#include "survey/identify/evidence.h"
#include "text/text.h"
#include "traffic/bus_load.h"
#include "traffic/traffic.h"

#define OBSERVATION_INTERFACES_MAX 8u

/** Room for observation_interfaces(). */
#define OBSERVATION_NAMES_SIZE 160u

/** The ID sets: the one that was configured, and the other. */
enum { OBSERVATION_GIVEN, OBSERVATION_OTHER, OBSERVATION_SETS };

/** What was gathered. */
typedef struct {
    agv_config_t configs[OBSERVATION_SETS];
    traffic_t *sets[OBSERVATION_SETS];
    evidence_t *evidence; /**< what the identifiers may carry */
    bus_load_t loads[HAL_CAN_SIDES];
    char interfaces[OBSERVATION_INTERFACES_MAX][CANDUMP_INTERFACE_MAX + 1];
    uint32_t interface_count;
    bool more_interfaces; /**< than have room */
    uint64_t first_us;    /**< stamp of the first frame */
    uint64_t last_us;     /**< stamp of the last frame, never going backwards */
    uint64_t frames;
    uint64_t backward_stamps;
    uint64_t back_us;    /**< how far they go back at most */
    uint64_t back_at_us; /**< the time since the start until then */
    uint64_t lost;       /**< frames that the interfaces' queues lost */
} observation_t;

/** Begin. @return false: out of memory; was reported */
bool observation_begin(observation_t *observation, const agv_config_t *config);

/** Take a frame with its time stamp. */
void observation_frame(observation_t *observation, hal_can_side_t side, const hal_can_frame_t *frame,
                       uint64_t stamp_us);

/** An interface was heard. The first are kept, and one that an option names. */
void observation_interface(observation_t *observation, const char *name, size_t length, bool is_named);

/** Write the interfaces: "can0, can1 and others". */
void observation_interfaces(const observation_t *observation, char text[OBSERVATION_NAMES_SIZE]);

/** How far the time stamps go back, in words. @return false: less than 10 ms, so frames that were logged late */
bool observation_goes_back(const observation_t *observation, text_t *text);

/** No more frames. @param last_us the end of the time */
void observation_end(observation_t *observation, uint64_t last_us);

/** The ID set with more frames of VCU and AI computer. @return OBSERVATION_GIVEN or OBSERVATION_OTHER */
unsigned observation_heard_set(const observation_t *observation);

/** Frames of the two identifiers in which the ID sets differ. @param id_set of agv_id_set_t */
void observation_set_counts(const observation_t *observation, uint32_t id_set, uint64_t counts[2]);

/** Time from the first frame to the end. */
uint64_t observation_us(const observation_t *observation);

/** Free. */
void observation_free(observation_t *observation);

#endif

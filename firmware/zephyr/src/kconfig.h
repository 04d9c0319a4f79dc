/**
 * @file kconfig.h
 * The configuration that was chosen at build time.
 */
#ifndef AGV_APP_KCONFIG_H
#define AGV_APP_KCONFIG_H

#include <stdbool.h>

#include "agv/config.h"

/** The chosen configuration. */
void kconfig_read(agv_config_t *config);

/** Whether an identifier is one of the protocol's, in one of the ID sets: what status_frame_id may not be. */
#define KCONFIG_ID_IS_TAKEN(id)                                                                                        \
    (((id) == 0x43F) || ((id) == 0x201) || ((id) == 0x363) || ((id) == 0x203) || ((id) == 0x168) || ((id) == 0x075) || \
     ((id) == 0x065) || ((id) == 0x0A3) || ((id) == 0x050) || ((id) == 0x067) || ((id) == 0x167) || ((id) == 0x267) || \
     ((id) == 0x101))

#endif

/**
 * @file version.h
 * The version of a program, which the supervisor reports in its status frame (HW-6, docs/protocol.md).
 */
#ifndef AGV_VERSION_H
#define AGV_VERSION_H

#include <stdint.h>

/** A version. The program gives it, because only its build knows the revision of the sources. */
typedef struct {
    uint8_t major;
    uint8_t minor;
    uint8_t patch;
    uint32_t revision; /**< first 8 hexadecimal digits of the git revision; 0: not known */
} agv_version_t;

#endif

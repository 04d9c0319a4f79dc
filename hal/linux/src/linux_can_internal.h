/**
 * @file linux_can_internal.h
 * Declarations that the source files of a socket share.
 */
#ifndef HAL_LINUX_LINUX_CAN_INTERNAL_H
#define HAL_LINUX_LINUX_CAN_INTERNAL_H

/**
 * Look for an interface by rtnetlink. An ioctl with a name that does not exist would start modprobe and wait for it, at
 * every search for an adapter that was unplugged.
 * @param kind ARPHRD_CAN for one that carries CAN
 * @return 0, or an errno
 */
int linux_can_find(const char *name, int *index, unsigned *kind);

#endif

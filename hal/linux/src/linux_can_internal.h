/**
 * @file linux_can_internal.h
 * What the files of a socket share.
 */
#ifndef HAL_LINUX_LINUX_CAN_INTERNAL_H
#define HAL_LINUX_LINUX_CAN_INTERNAL_H

/**
 * Look for an interface. By rtnetlink, because an ioctl with a name that does not exist starts modprobe and waits for it,
 * each time that an adapter that was pulled out is looked for.
 * @param kind ARPHRD_CAN for one that carries CAN
 * @return 0, or why not (an errno)
 */
int linux_can_find(const char *name, int *index, unsigned *kind);

#endif

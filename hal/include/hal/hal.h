/**
 * @file hal.h
 * The context that all parts of the hardware abstraction layer share. Include the header of the part that you need.
 *
 * The headers of this folder are the contract. A port implements all their functions and defines `struct hal`; a program
 * selects its port by linking it. The core never accesses the members of `struct hal` and never keeps the pointer: it is
 * passed to every call. No function allocates, and none waits for anything, except hal_store_append (store.h).
 */
#ifndef HAL_HAL_H
#define HAL_HAL_H

/** Context of a port. The program owns it; each supervisor has its own. */
typedef struct hal hal_t;

#endif

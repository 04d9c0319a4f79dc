/**
 * @file hal.h
 * What every part of the hardware abstraction shares. Include the part you need; this one holds the context only.
 *
 * The contract is this folder. A port implements every function of it and defines `struct hal`; which port a program has
 * is decided by what it links. The core never looks inside `struct hal`, and never keeps the pointer: it is passed in at
 * every call. No function blocks, none allocates.
 */
#ifndef HAL_HAL_H
#define HAL_HAL_H

/** Context of a port: one for each supervisor, owned by the program. */
typedef struct hal hal_t;

#endif

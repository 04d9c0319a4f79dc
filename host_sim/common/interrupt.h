/**
 * @file interrupt.h
 * Delays SIGINT, SIGTERM, SIGHUP and SIGQUIT while a temporary file exists. The program polls for them between two steps,
 * removes the file, and then lets them act. A shell starts a script's background jobs with SIGINT ignored: here it ends the
 * program all the same. Only an ignored SIGHUP stays ignored (nohup).
 */
#ifndef HOST_SIM_INTERRUPT_H
#define HOST_SIM_INTERRUPT_H

#include <stdbool.h>

/** What to wait for. */
typedef enum { INTERRUPT_READ, INTERRUPT_WRITE } interrupt_for_t;

/** Hold these signals back from now on. */
void interrupt_hold(void);

/** Whether one of them came while they are held back. Cheap enough for every thousandth step, not for every one. */
bool interrupt_pending(void);

/** Wait until a file can be read or written. @return false: interrupt_pending() */
bool interrupt_wait(int fd, interrupt_for_t what);

/** Let them through: one that came ends the program here. */
void interrupt_release(void);

#endif

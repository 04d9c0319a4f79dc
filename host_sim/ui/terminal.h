/**
 * @file terminal.h
 * The terminal on standard output.
 */
#ifndef HOST_SIM_TERMINAL_H
#define HOST_SIM_TERMINAL_H

/**
 * Columns of a line that is rewritten in place. The last column stays free: a line that fills the terminal would begin a new
 * one. @return 79 where the width is unknown
 */
int terminal_columns(void);

#endif

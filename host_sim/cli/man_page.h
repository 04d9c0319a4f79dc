/**
 * @file man_page.h
 * Man pages, made from the tables of commands and options.
 */
#ifndef HOST_SIM_MAN_PAGE_H
#define HOST_SIM_MAN_PAGE_H

#include "cli/commands/commands.h"

/**
 * Print a page on standard output, for section 1.
 * @param command NULL: the page of the program
 */
void man_page_print(const command_t *command);

#endif

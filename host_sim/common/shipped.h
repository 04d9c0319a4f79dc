/**
 * @file shipped.h
 * Where the files are that come with the program: beside an installed one (share/agv-supervisor), or in the source tree of
 * one that was built and not installed. Both are found from the place of the program, so that it can be moved.
 */
#ifndef HOST_SIM_SHIPPED_H
#define HOST_SIM_SHIPPED_H

/**
 * The folder of the shipped scenarios.
 * @return its path, valid until the end of the program; where neither folder exists, that of an installed program
 */
const char *shipped_scenarios(void);

#endif

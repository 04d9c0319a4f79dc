/**
 * @file shipped.h
 * Where the files are that come with the program: beside an installed one (share/agv-supervisor), or in the source tree of
 * one that was built and not installed. Both are found from the place of the program, so that it can be moved.
 */
#ifndef HOST_SIM_SHIPPED_H
#define HOST_SIM_SHIPPED_H

/** The names of the shipped scenarios, "a|b|c", sorted; "" if there are none. */
const char *shipped_scenario_names(void);

/** Where the Debian package puts them. */
#define SHIPPED_PACKAGE "/usr/share/agv-supervisor"

/** Room for a path. */
#define SHIPPED_PATH_SIZE 4096u

/**
 * Write the folder in which the scenarios and the examples lie, as a user would type it: relative if it lies below the
 * folder in which the program runs. Without such a folder, that of the Debian package.
 * @return path
 */
const char *shipped_shown(char path[SHIPPED_PATH_SIZE]);

/**
 * The folder of the shipped scenarios.
 * @return its path, valid until the end of the program; where neither folder exists, that of an installed program
 */
const char *shipped_scenarios(void);

#endif

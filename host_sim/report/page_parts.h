/**
 * @file page_parts.h
 * The sources of the page as texts: the files of page/, put into the program when it is built (embed.cmake).
 */
#ifndef HOST_SIM_PAGE_PARTS_H
#define HOST_SIM_PAGE_PARTS_H

extern const char page_frame[]; /**< report.html: "@TITLE@", "@CSS@", "@SENTENCE@", "@DATA@", "@JS@" are replaced */
extern const char page_styles[];
extern const char page_modules[]; /**< one script: each module stands after those that it imports */

#endif

/**
 * @file page_parts.h
 * The sources of the page as texts: the files of page/, put into the program when it is built (embed.cmake).
 */
#ifndef HOST_SIM_PAGE_PARTS_H
#define HOST_SIM_PAGE_PARTS_H

extern const char page_report_html[]; /**< the frame: "@TITLE@", "@CSS@", "@SENTENCE@", "@DATA@", "@JS@" are replaced */
extern const char page_report_css[];
extern const char page_report_js[];
extern const char page_timeline_css[];
extern const char page_timeline_js[];

#endif

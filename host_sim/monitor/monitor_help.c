/* The page of help. */
#include "monitor/monitor_page.h"

/** A line of it. */
typedef struct {
    const char *left;
    const char *right;
} line_t;

static const line_t help_lines[] = {
    {"age", "longest gap of the last second, or time since the last frame, ms"},
    {"deadline", "a bar that is full at the deadline; red and LATE: exceeded"},
    {"gap", "shortest and longest time between two frames, ms"},
    {"cnt", "alive counter; red and STUCK: frames come, it does not change"},
    {"grey", "never received, or an AI command that is silent while not engaged"},
    {"supervisor", "its state, from its status frame"},
    {"shadow", "the state of a supervisor in this program, which only listens"},
    {"alarms", "of VCU and EPS, and faults; LED: flashes of the alarm LED"},
    {"", ""},
    {"space, p", "pause; frames of a bus are still counted, a log stops"},
    {"r", "reset shortest and longest gaps"},
    {"c", "start or stop recording the bus into a new candump log"},
    {"+, -", "a log: twice or half as fast"},
    {"up, down", "scroll the transitions; also page up, page down, home, end"},
    {":", "host_sim vehicle: type a command, as without a screen"},
    {"h, ?", "this help, and back"},
    {"q", "quit"},
};

enum { LEFT = 2, RIGHT = 14 };

void monitor_help_draw(monitor_view_t *view, int y) {
    for (size_t i = 0; i < sizeof help_lines / sizeof help_lines[0]; i++) {
        (void)monitor_view_put(view, y + (int)i, LEFT, STYLE_BOLD, help_lines[i].left);
        (void)monitor_view_put(view, y + (int)i, RIGHT, STYLE_PLAIN, help_lines[i].right);
    }
}

#include "ui/terminal.h"

#include <stdbool.h>
#include <sys/ioctl.h>
#include <unistd.h>

enum { DEFAULT_WIDTH = 80 };

int terminal_columns(void) {
    struct winsize size;
    const bool known = (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0) && (size.ws_col > 0);
    return (known ? (int)size.ws_col : DEFAULT_WIDTH) - 1;
}

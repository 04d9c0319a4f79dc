/* Planted: a signed number grows beyond its range. */
#include <limits.h>

int main(int argc, char **argv) {
    (void)argv;
    const int most = INT_MAX - 1 + argc;
    return most + argc == 0;
}

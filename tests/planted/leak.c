/* Planted: a block that nobody frees. */
#include <stdlib.h>
#include <string.h>

static char *volatile block;

int main(int argc, char **argv) {
    (void)argc;
    block = malloc(strlen(argv[0]) + 1);
    if (block != NULL) {
        strcpy(block, argv[0]);
    }
    block = NULL;
    return 0;
}

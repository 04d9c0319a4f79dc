/* Seeded fault: a read one byte behind a block. */
#include <stdlib.h>
#include <string.h>

int main(int argc, char **argv) {
    const size_t length = strlen(argv[0]);
    char *copy = malloc(length);
    if (copy == NULL) {
        return 0;
    }
    memcpy(copy, argv[0], length);
    const int result = copy[length - 1 + (size_t)argc];
    free(copy);
    return result == 0;
}

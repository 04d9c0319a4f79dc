/* Planted: a value is cut off silently. */
unsigned char planted_warning(int value);

unsigned char planted_warning(int value) {
    return value;
}

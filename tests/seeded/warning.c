/* Seeded fault: a value is cut off silently. */
unsigned char seeded_warning(int value);

unsigned char seeded_warning(int value) {
    return value;
}

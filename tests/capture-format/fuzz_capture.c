/* Reads damaged captures. As a program it takes a capture, the number of seeds and the first seed; built by clang with
   -fsanitize=fuzzer -DGLINT_LIBFUZZER it is a libFuzzer target. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hostile.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct glint_error err = {0};
    hostile_use_bytes(data, size, &err);
    return 0;
}

#ifndef GLINT_LIBFUZZER
int main(int argc, char **argv) {
    if (argc < 3) {
        fprintf(stderr, "usage: fuzz_capture CAPTURE COUNT [FIRST]\n");
        return 2;
    }
    FILE *file = fopen(argv[1], "rb");
    if (!file) return 1;
    fseek(file, 0, SEEK_END);
    const size_t size = (size_t)ftell(file);
    rewind(file);
    uint8_t *whole = malloc(size), *copy = malloc(size);
    const bool ok = whole && copy && fread(whole, 1, size, file) == size;
    fclose(file);
    const uint32_t count = (uint32_t)strtoul(argv[2], NULL, 10),
                   first = argc > 3 ? (uint32_t)strtoul(argv[3], NULL, 10) : 0;
    for (uint32_t i = 0; ok && i < count; i++) {
        memcpy(copy, whole, size);
        if (getenv("GLINT_FUZZ_TRACE")) fprintf(stderr, "seed %u\n", first + i);
        LLVMFuzzerTestOneInput(copy, hostile_damage(copy, size, first + i));
    }
    free(whole);
    free(copy);
    return ok ? 0 : 1;
}
#endif

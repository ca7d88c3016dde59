/* The disassembly of a SPIR-V module that spirv-val accepts. */
#ifndef GLINT_TEST_LISTING_H
#define GLINT_TEST_LISTING_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "unit.h"

enum { LINE = 8192, LINES_MAX = 20000 };
/* The lines that spirv-dis writes of a module, which spirv-val finds valid. */
struct listing {
    char *lines[LINES_MAX];
    size_t count;
};
static inline void list(const struct fixture *fixture, const uint32_t *words, size_t bytes, struct listing *listing) {
    char command[600], path[256];
    static char line[LINE];
    snprintf(path, sizeof path, "%s/listed.spv", fixture->folder);
    FILE *file = fopen(path, "wb");
    assert_true(file && fwrite(words, bytes, 1, file) == 1 && fclose(file) == 0);
    snprintf(command, sizeof command, "spirv-val --target-env vulkan1.3 %s && spirv-dis --raw-id --no-indent %s", path,
             path);
    assert_non_null(file = popen(command, "r"));
    listing->count = 0;
    while (fgets(line, sizeof line, file)) {
        assert_true(listing->count < LINES_MAX);
        assert_non_null(listing->lines[listing->count++] = strdup(line));
    }
    assert_int_equal(pclose(file), 0);
}
static inline void list_free(struct listing *listing) {
    while (listing->count) free(listing->lines[--listing->count]);
}

#endif

/* Content hashes: XXH3-128 over a file's bytes. */
#include "hash.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#define STEP ((size_t)1 << 20)

bool glint_hash_file(glint_file file, const char *path, char hex[33], struct glint_error *err) {
    bool ok = false;
    uint64_t at = 0;
    XXH3_state_t *state = XXH3_createState();
    char *buffer = malloc(STEP);
    if (!state || !buffer) {
        glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
        goto done;
    }
    XXH3_128bits_reset(state);
    for (size_t got = STEP; got == STEP; at += got) {
        if (!glint_file_read(file, buffer, STEP, at, &got)) {
            glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
            goto done;
        }
        XXH3_128bits_update(state, buffer, got);
    }
    const XXH128_hash_t hash = XXH3_128bits_digest(state);
    snprintf(hex, 33, "%016llx%016llx", (unsigned long long)hash.high64, (unsigned long long)hash.low64);
    ok = true;
done:
    free(buffer);
    XXH3_freeState(state);
    return ok;
}

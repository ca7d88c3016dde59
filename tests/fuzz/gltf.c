/* Fuzzes the reader of glTF scenes: the check of their numbers, and where that finds nothing, the importer and what takes its scene over. */
#include <string.h>

#include "fuzz.h"
#include "gltf.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    /* A triangle, and its indices. */
    static const struct {
        float places[9];
        uint16_t indices[4];
    } buffer = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}};
    struct glint_error err = {0};
    struct scene scene;
    scene_init(&scene);
    const bool binary = size >= 4 && !memcmp(data, "glTF", 4);
    fuzz_file("buffer.bin", &buffer, sizeof buffer);
    const char *path = fuzz_file(binary ? "input.glb" : "input.gltf", data, size);
    fuzz_reason(gltf_load(path, &scene, &err), &err);
    scene_finish(&scene);
    return 0;
}

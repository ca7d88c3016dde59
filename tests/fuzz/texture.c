/* Fuzzes the readers of textures that glint pack has itself: the input is a DDS, KTX 2, NumPy or raw file, by how it begins, and the manifest
   is always the same. */
#include <stdio.h>
#include <string.h>

#include "fuzz.h"
#include "glint/pack.h"

static const char *name_of(const uint8_t *data, size_t size) {
    static const struct {
        const char *bytes, *name;
    } kinds[] = {{"DDS ", "input.dds"}, {"\xabKTX 20", "input.ktx2"}, {"\x93NUMPY", "input.npy"}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (size >= strlen(kinds[i].bytes) && !memcmp(data, kinds[i].bytes, strlen(kinds[i].bytes)))
            return kinds[i].name;
    return "input.bin";
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct glint_error err = {0};
    const struct glint_pack_options options = {.threads = 1};
    const char *name = name_of(data, size);
    const bool raw = !strcmp(name, "input.bin");
    char manifest[600];
    const int length =
        snprintf(manifest, sizeof manifest,
                 "{\"glint\": 1, \"textures\": {\"t\": {\"file\": \"%s\"%s}}, \"parts\": {\"cubemap.000\": {\"RGB\": "
                 "\"t.rgb\", \"distance.Z\": \"t.r\", \"A\": 1, \"cubemap\": {\"center\": [0, 0, 0]}}}}",
                 name, raw ? ", \"format\": \"VK_FORMAT_R8G8B8A8_UNORM\", \"width\": 1, \"height\": 6" : "");
    fuzz_file(name, data, size);
    fuzz_reason(glint_pack(fuzz_file("manifest.json", manifest, (size_t)length), NULL, &options, &err), &err);
    return 0;
}

/* Fuzzes manifests of glint pack: the input is the manifest; textures of each kind lie beside it. Nothing is written. */
#include <string.h>

#include "fuzz.h"
#include "glint/pack.h"

enum { WIDTH = 4, HEIGHT = 24 };

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerInitialize(int *argc, char ***argv) {
    static const uint8_t raw[WIDTH * HEIGHT * 16];
    char npy[128 + sizeof raw] = "\x93NUMPY\1\0\x76";
    (void)argc, (void)argv;
    strcpy(npy + 10, "{'descr': '<f4', 'fortran_order': False, 'shape': (24, 4, 4), }");
    fuzz_file("one.npy", npy, sizeof npy);
    fuzz_file("one.bin", raw, sizeof raw);
    return 0;
}

static void check_fault(void *user, const char *text) {
    (void)user;
    fuzz_must(text[0] != '\0', "a fault has a message");
}

static void check_note(void *user, enum glint_pack_note kind, const char *key, const char *text) {
    (void)user, (void)kind;
    fuzz_must(key[0] && text[0], "a note has a key and a text");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct glint_error err = {0};
    const struct glint_pack_options options = {.threads = 1, .note = check_note, .fault = check_fault};
    fuzz_reason(glint_pack(fuzz_file("manifest.json", data, size), NULL, &options, &err), &err);
    return 0;
}

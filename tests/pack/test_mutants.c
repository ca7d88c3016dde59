/* A thousand damaged manifests and textures: glint_pack either says what is wrong, with the file and, where the manifest can be parsed, the line, or
   writes a capture that follows the rules of the format. Runs under the sanitizers, too. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>
#include <jansson.h>

#include "fixture.h"
#include "glint/pack.h"

static size_t mutants = 150; /* or as many as the argument says */

static uint64_t state = 20;

static uint32_t draw(uint32_t below) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(state >> 33) % below;
}

static char folder[512], manifest[600], texture[600], out[600];

/* ---- Files ---- */

static char *read_file(const char *path, size_t *size) {
    FILE *in = fopen(path, "rb");
    assert_non_null(in);
    char *data = NULL;
    FILE *memory = open_memstream(&data, size);
    for (int c; (c = fgetc(in)) != EOF;) fputc(c, memory);
    fclose(in);
    fclose(memory);
    return data;
}

static void write_file(const char *path, const void *data, size_t size) {
    FILE *to = fopen(path, "wb");
    assert_non_null(to);
    assert_int_equal(fwrite(data, 1, size, to), size);
    assert_int_equal(fclose(to), 0);
}

/* Texture files of the kinds that pack reads itself, all of FIX_W x FIX_H halves of one component. */
static size_t make_npy(uint8_t *file) {
    const int head = snprintf((char *)file + 10, 200, "{'descr': '<f2', 'fortran_order': False, 'shape': (%d, %d), }\n",
                              FIX_H, FIX_W);
    memcpy(file, "\x93NUMPY\1\0", 8);
    file[8] = (uint8_t)head;
    return 10 + (size_t)head;
}

static void put_u32(uint8_t *at, uint32_t value) {
    for (int i = 0; i < 4; i++) at[i] = (uint8_t)(value >> (8 * i));
}

static size_t make_dds(uint8_t *file) {
    memset(file, 0, 148);
    memcpy(file, "DDS ", 4);
    const uint32_t words[][2] = {{4, 124},         {12, FIX_H}, {16, FIX_W}, {76, 32}, {80, 4},
                                 {84, 0x30315844}, {128, 54},   {132, 3},    {140, 1}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) put_u32(file + words[i][0], words[i][1]);
    return 148;
}

static size_t make_ktx2(uint8_t *file) {
    const uint32_t words[][2] = {{12, 76},
                                 {16, 2},
                                 {20, FIX_W},
                                 {24, FIX_H},
                                 {36, 1},
                                 {40, 1},
                                 {80, 104},
                                 {88, 2 * FIX_W * FIX_H},
                                 {96, 2 * FIX_W * FIX_H}};
    memset(file, 0, 104);
    memcpy(file, "\xabKTX 20\xbb\r\n\x1a\n", 12);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) put_u32(file + words[i][0], words[i][1]);
    return 104;
}

static const char *const kinds[] = {"one.npy", "one.dds", "one.ktx2"};

static void write_texture(int kind, size_t flips, bool cut) {
    static uint8_t file[300 + 2 * FIX_W * FIX_H];
    size_t size = kind == 0 ? make_npy(file) : kind == 1 ? make_dds(file) : make_ktx2(file);
    const size_t head = size;
    memset(file + size, 0x3c, 2 * FIX_W * FIX_H);
    size += 2 * FIX_W * FIX_H;
    while (flips--) file[draw((uint32_t)head)] = (uint8_t)(draw(2) ? draw(256) : draw(2) ? 0xff : 0);
    if (cut) size = draw((uint32_t)size);
    snprintf(texture, sizeof texture, "%.500s/%s", folder, kinds[kind]);
    write_file(texture, file, size);
}

/* ---- Mutations of the manifest ---- */

static json_t *hostile_value(void) {
    static const char *const texts[] = {"",
                                        "../../../../../../dev/zero",
                                        "/",
                                        "VK_FORMAT_R8_UNORM",
                                        "DXGI_FORMAT_D32_FLOAT",
                                        "lit",
                                        "lit.r",
                                        "one",
                                        "planar",
                                        "bottom_first",
                                        "reversed",
                                        "half",
                                        "uint",
                                        "float",
                                        "opaque",
                                        "packed16",
                                        "octahedral",
                                        ".",
                                        "lit.rgbargb",
                                        "row",
                                        "column_major"};
    static const double numbers[] = {0, -1, 1, 2, 1e308, -1e-300, 0.5, 65536, 4294967295.0, 1e19};
    static const json_int_t integers[] = {0, -1, 1, 3, 65536, 4294967295, 4294967296, INT64_MAX, INT64_MIN};
    char *long_text;
    json_t *value;
    switch (draw(8)) {
    case 0:
        return json_string(texts[draw(sizeof texts / sizeof *texts)]);
    case 1:
        return json_real(numbers[draw(sizeof numbers / sizeof *numbers)]);
    case 2:
        return json_integer(integers[draw(sizeof integers / sizeof *integers)]);
    case 3:
        return draw(2) ? json_null() : json_true();
    case 4:
        return draw(2) ? json_array() : json_object();
    case 5:
        return json_pack("[i, i, i, f]", 0, 1, 2, 1e300);
    case 6:
        return json_string(texts[draw(sizeof texts / sizeof *texts)]);
    default:
        long_text = malloc(5000);
        memset(long_text, 'a' + (int)draw(26), 4999);
        long_text[4999] = '\0';
        value = json_string(long_text);
        free(long_text);
        return value;
    }
}

/* Replaces, removes or adds a value somewhere. */
static void mutate(json_t *value, int depth) {
    const size_t count = json_is_object(value) ? json_object_size(value) : json_array_size(value);
    if (!count) return;
    const uint32_t which = draw((uint32_t)count);
    if (json_is_array(value)) {
        json_t *item = json_array_get(value, which);
        if (json_is_array(item) || json_is_object(item)) mutate(item, depth + 1);
        else if (draw(4)) json_array_set_new(value, which, hostile_value());
        else json_array_remove(value, which);
        return;
    }
    void *at = json_object_iter(value);
    for (uint32_t i = 0; i < which; i++) at = json_object_iter_next(value, at);
    json_t *item = json_object_iter_value(at);
    char *key = strdup(json_object_iter_key(at));
    const bool deeper = json_object_size(item) || json_array_size(item);
    if (deeper && (depth < 2 || draw(3))) mutate(item, depth + 1);
    else if (draw(6) == 0) json_object_del(value, key);
    else if (draw(8) == 0) json_object_set(value, draw(2) ? "channels" : "texture", item);
    else json_object_set_new(value, key, hostile_value());
    free(key);
}

static void flip_bytes(char *text, size_t size) {
    static const char bytes[] = "\"{}[]:,0-9.e\\ \n\x80\xff";
    for (uint32_t n = 1 + draw(3); n--;)
        text[draw((uint32_t)size)] = draw(2) ? bytes[draw(sizeof bytes - 1)] : (char)draw(256);
}

/* ---- The verdict ---- */

struct broken {
    char rule[64], message[256];
};

static void on_violation(void *user, const char *rule, const char *message) {
    struct broken *broken = user;
    if (!strncmp(rule, "pixels-", 7)) return; /* which pack does not check */
    snprintf(broken->rule, sizeof broken->rule, "%s", rule);
    snprintf(broken->message, sizeof broken->message, "%s", message);
}

/* "…/manifest.json:12: …" */
static bool names_line(const char *message) {
    const char *file = strstr(message, manifest), *rest = file ? file + strlen(manifest) : "";
    return rest[0] == ':' && rest[1] >= '1' && rest[1] <= '9';
}

static bool check(size_t number) {
    struct glint_error err = {0};
    const bool ok = glint_pack(manifest, out, NULL, &err);
    if (!ok) {
        if (!names_line(err.message)) fail_msg("mutant %zu: no line in: %s", number, err.message);
        if (!access(out, F_OK)) fail_msg("mutant %zu: %s, and yet a file", number, err.message);
        return false;
    }
    struct broken broken = {.rule = ""};
    size_t violations = 0;
    if (!glint_capture_validate(out, NULL, on_violation, &broken, &violations, &err))
        fail_msg("mutant %zu: %s", number, err.message);
    if (broken.rule[0]) fail_msg("mutant %zu: %s [%s]", number, broken.message, broken.rule);
    unlink(out);
    return true;
}

static void test_mutants(void **user) {
    (void)user;
    size_t size = 0, packed = 0;
    char *text = read_file(manifest, &size);
    for (size_t i = 0; i < mutants; i++) {
        json_t *root = json_loadb(text, size, 0, NULL);
        const int kind = (int)draw(3);
        const bool files = i % 3 == 2;
        json_object_set_new(json_object_get(root, "textures"), "one", json_pack("{s:s}", "file", kinds[kind]));
        json_object_set_new(json_object_get(root, "parts"), "engine.one", json_pack("{s:s}", "c", "one.r"));
        write_texture(kind, files ? 1 + draw(3) : 0, files && draw(3) == 0);
        for (uint32_t n = i % 3 == 1 ? 1 + draw(2) : 0; n--;) mutate(root, 0);
        char *changed = json_dumps(root, JSON_INDENT(1) | JSON_REAL_PRECISION(17));
        json_decref(root);
        size_t length = strlen(changed);
        if (i % 3 == 0 && i) flip_bytes(changed, length);
        write_file(manifest, changed, length);
        free(changed);
        packed += check(i);
    }
    free(text);
    print_message("%zu of %zu were packed, the others refused with a line\n", packed, mutants);
    assert_in_range(packed, mutants / 20, mutants * 3 / 4);
}

static int set_up(void **user) {
    (void)user;
    static struct fixture fixture;
    struct glint_error err = {0};
    char capture[512];
    fixture_path(folder, "pack-mutants");
    fixture_path(capture, "pack-mutants.exr");
    snprintf(manifest, sizeof manifest, "%s/manifest.json", folder);
    snprintf(out, sizeof out, "%s/out.exr", folder);
    fixture_init(&fixture);
    const bool ok =
        fixture_write(&fixture, capture, FIXTURE_PARTS, NULL, &err) && glint_extract(capture, folder, NULL, &err);
    if (!ok) print_error("%s\n", err.message);
    return ok ? 0 : 1;
}

int main(int argc, char **argv) {
    if (argc > 1) mutants = (size_t)atoi(argv[1]);
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_mutants)};
    return cmocka_run_group_tests(tests, set_up, NULL);
}

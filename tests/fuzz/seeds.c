/* Writes what fuzzing begins with, where code can make it: fuzz_seeds FOLDER leaves captures of few pixels in FOLDER/capture, other OpenEXR files in
   FOLDER/exr, textures in FOLDER/texture, and the words of each format in FOLDER/NAME.dict. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "fixture.h"
#include "glint/edit.h"
#include "glint/replay.h"
#include "keys.h"

static const char *base;

static const char *path_of(const char *folder, const char *name) {
    static char path[4096];
    snprintf(path, sizeof path, "%s/%s", base, folder);
    mkdir(path, 0777);
    snprintf(path, sizeof path, "%s/%s/%s", base, folder, name);
    return path;
}

static void check(bool ok, const char *what) {
    if (ok) return;
    fprintf(stderr, "fuzz_seeds: %s\n", what);
    exit(1);
}

/* ---- Captures ---- */

/* A few of the fixture's pixels. Cube maps stay six faces. */
static void shrink(struct glint_part *part) {
    const bool cube = part->width == FIX_CUBE && part->height == 6 * FIX_CUBE;
    if (part->width == FIX_W && part->height == FIX_H) part->width = 4, part->height = 3;
    else if (cube) part->width = 2, part->height = 12;
    else if (part->width == FIX_SHADOW) part->width = part->height = 3;
}

/* Declares the e-th encoding of each kind; the values are then others, in their range or not. */
static void encode(const struct fixture *f, struct glint_part *part, struct fixture_channels *channels, int e) {
    size_t kept = 0;
    part->encodings = (struct glint_encodings){.depth = (enum glint_depth_encoding)e,
                                               .normal = (enum glint_normal_encoding)(e % 5),
                                               .vertex_normal = (enum glint_normal_encoding)((e + 1) % 5),
                                               .normal_space = (enum glint_normal_space)(e % 2),
                                               .roughness = (enum glint_roughness_encoding)(e % 5),
                                               .motion = (enum glint_motion_encoding)(e % 4),
                                               .motion_depth = (enum glint_motion_depth_encoding)(e % 2),
                                               .color = (enum glint_color_encoding)(e % 3)};
    for (size_t c = 0; c < part->channel_count; c++) {
        struct glint_channel *channel = &channels->all[c];
        const bool depth = !strcmp(channel->name, "motion.Z"), motion = !strncmp(channel->name, "motion.", 7);
        if ((depth && part->encodings.motion_depth == GLINT_MOTION_DEPTH_PACKED16) ||
            (motion && !depth && part->encodings.motion == GLINT_MOTION_PACKED16))
            *channel = (struct glint_channel){.name = channel->name, .type = GLINT_U32, .data = f->stencil};
        const enum glint_normal_encoding normal =
            strstr(channel->name, "vertex") ? part->encodings.vertex_normal : part->encodings.normal;
        if (strstr(channel->name, "ormal.Z") && normal >= GLINT_NORMAL_OCTAHEDRAL) continue;
        channels->all[kept++] = *channel;
    }
    part->channel_count = kept;
}

/* Depth of these encodings is 1 at the near plane. */
static void fit_depth(struct glint_camera *camera, int encoding) {
    const double near = 0.1, far = 500;
    if (encoding != GLINT_DEPTH_REVERSED && encoding != GLINT_DEPTH_REVERSED_INFINITE) return;
    camera->view_to_clip[10] = encoding == GLINT_DEPTH_REVERSED ? near / (far - near) : 0;
    camera->view_to_clip[11] = encoding == GLINT_DEPTH_REVERSED ? near * far / (far - near) : near;
}

enum { ENCODINGS = 6 };
static void write_capture(const struct fixture *f, enum fixture_part third, enum glint_compression compression,
                          int encoding) {
    struct glint_error err = {0};
    char name[64];
    struct glint_frame frame = fixture_frame();
    fit_depth(&frame.camera, encoding);
    fit_depth(&frame.previous, encoding);
    snprintf(name, sizeof name, "%02d-%d-%d.exr", (int)third, (int)compression, encoding);
    struct glint_writer *writer = glint_writer_create(
        path_of("capture", name), &(struct glint_writer_options){.compression = compression, .threads = 1}, &err);
    check(writer && glint_writer_set_frame(writer, &frame, &err), err.message);
    const enum fixture_part parts[] = {FIXTURE_GBUFFER, FIXTURE_LIT, FIXTURE_PROBE, third};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        struct fixture_channels channels;
        struct glint_part part = fixture_part(f, parts[i], &channels);
        /* A level is half of the one before it. */
        if (parts[i] == FIXTURE_PROBE && third != FIXTURE_PROBE_1) continue;
        if (encoding) encode(f, &part, &channels, encoding);
        shrink(&part);
        if (parts[i] == FIXTURE_PROBE_1) part.width = 1, part.height = 6;
        if (!glint_writer_add_part(writer, &part, &err)) check(false, err.message);
    }
    check(glint_writer_finish(writer, &err), err.message);
    glint_writer_destroy(&writer);
}

/* ---- Other OpenEXR files ---- */

static void write_images(enum glint_compression compression) {
    static float values[40 * 24];
    char name[32];
    struct glint_error err = {0};
    const double numbers[16] = {1, 2.5, -3};
    const char *const texts[] = {"one", "two"};
    const struct glint_exr_channel channels[] = {{"A", GLINT_STORED_HALF, values, 0, 0},
                                                 {"X", GLINT_STORED_UINT, values, 0, 0},
                                                 {"Z", GLINT_STORED_FLOAT, values, 0, 0}};
    const struct glint_exr_attribute attributes[] = {
        {.name = "text", .type = GLINT_EXR_STRING, .string = "of the run"},
        {.name = "int", .type = GLINT_EXR_INT, .numbers = numbers, .count = 1},
        {.name = "matrix", .type = GLINT_EXR_M44D, .numbers = numbers, .count = 16},
        {.name = "floats", .type = GLINT_EXR_FLOATS, .numbers = numbers, .count = 3},
        {.name = "texts", .type = GLINT_EXR_STRINGS, .strings = texts, .count = 2},
        {.name = "bytes", .type = GLINT_EXR_OPAQUE, .type_name = "own", .bytes = "abc", .count = 3}};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) values[i] = (float)(i % 7);
    const struct glint_exr_part part = {.name = "image",
                                        .width = 9,
                                        .height = 19,
                                        .channels = channels,
                                        .channel_count = 3,
                                        .attributes = attributes,
                                        .attribute_count = 6,
                                        .compression = compression};
    snprintf(name, sizeof name, "compression%d.exr", (int)compression);
    check(glint_exr_write(path_of("exr", name), &part, 1, 1, &err), err.message);
}

/* A file of one part in tiles of 4 x 4 pixels, not compressed: glint reads such files and writes none. */
static uint8_t tiled[2048];
static size_t tiled_size;

static void put(const void *bytes, size_t size) {
    check(tiled_size + size <= sizeof tiled, "a tiled file is larger");
    memcpy(tiled + tiled_size, bytes, size);
    tiled_size += size;
}

static void put_attribute(const char *name, const char *type, const void *value, uint32_t size) {
    put(name, strlen(name) + 1);
    put(type, strlen(type) + 1);
    put(&size, 4);
    put(value, size);
}

static void write_tiled(void) {
    static const uint32_t magic[] = {20000630, 0x202}, window[] = {0, 0, 5, 3};
    /* A channel's name, then the type float, four bytes, and 1 x 1 pixels a sample. */
    static const char channels[] = "Z\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0";
    static const uint8_t tiles[9] = {4, 0, 0, 0, 4};
    static const float one = 1, center[2] = {0, 0}, pixels[16] = {1, 2, 3};
    enum { TILES = 2 };
    static const uint32_t widths[TILES] = {4, 2};
    put(magic, sizeof magic);
    put_attribute("channels", "chlist", channels, sizeof channels);
    put_attribute("compression", "compression", "", 1);
    put_attribute("dataWindow", "box2i", window, sizeof window);
    put_attribute("displayWindow", "box2i", window, sizeof window);
    put_attribute("lineOrder", "lineOrder", "", 1);
    put_attribute("pixelAspectRatio", "float", &one, sizeof one);
    put_attribute("screenWindowCenter", "v2f", center, sizeof center);
    put_attribute("screenWindowWidth", "float", &one, sizeof one);
    put_attribute("tiles", "tiledesc", tiles, sizeof tiles);
    put("", 1);
    uint64_t offset = tiled_size + TILES * sizeof offset;
    for (size_t i = 0; i < TILES; offset += 20 + 16 * widths[i++]) put(&offset, sizeof offset);
    for (uint32_t i = 0; i < TILES; i++) {
        const uint32_t head[] = {i, 0, 0, 0, 16 * widths[i]};
        put(head, sizeof head);
        put(pixels, 16 * widths[i]);
    }
    FILE *out = fopen(path_of("exr", "tiled.exr"), "wb");
    check(out && fwrite(tiled, 1, tiled_size, out) == tiled_size && !fclose(out), "a tiled file cannot be written");
    struct glint_error err = {0};
    float read[24];
    struct glint_exr *exr = glint_exr_open(path_of("exr", "tiled.exr"), NULL, &err);
    check(exr && glint_exr_read(exr, 0, (const char *const[]){"Z"}, 1, GLINT_F32, read, 1, &err), err.message);
    glint_exr_close(&exr);
}

/* ---- Textures ---- */

static void put_u32(uint8_t *at, uint32_t value) {
    for (int i = 0; i < 4; i++) at[i] = (uint8_t)(value >> (8 * i));
}

static void write_texture(const char *name, const uint8_t *bytes, size_t size) {
    FILE *out = fopen(path_of("texture", name), "wb");
    check(out && fwrite(bytes, 1, size, out) == size && !fclose(out), "a texture cannot be written");
}

/* Cube maps of 4 x 4 and 2 x 2 texels. */
static void write_textures(void) {
    uint8_t file[1024] = "DDS ";
    const uint32_t dds[][2] = {{4, 124},         {12, 24},  {16, 4},  {76, 32}, {80, 4},
                               {84, 0x30315844}, {128, 10}, {132, 3}, {140, 1}};
    for (size_t i = 0; i < sizeof dds / sizeof *dds; i++) put_u32(file + dds[i][0], dds[i][1]);
    write_texture("half.dds", file, 148 + 8 * 96);
    put_u32(file + 128, 71);
    write_texture("bc1.dds", file, 148 + 48);
    put_u32(file + 84, 0x31545844);
    write_texture("dxt1.dds", file, 128 + 48);
    memset(file, 0, sizeof file);
    memcpy(file, "\xabKTX 20\xbb\r\n\x1a\n", 12);
    const uint32_t ktx[][2] = {{12, 109}, {16, 4}, {20, 2}, {24, 2}, {36, 6}, {40, 1}, {80, 104}, {88, 384}, {96, 384}};
    for (size_t i = 0; i < sizeof ktx / sizeof *ktx; i++) put_u32(file + ktx[i][0], ktx[i][1]);
    write_texture("cube.ktx2", file, 104 + 384);
    /* The same, of which zstd stores a byte and that it comes 384 times. */
    static const uint8_t packed[] = {0x28, 0xb5, 0x2f, 0xfd, 0x60, 0x80, 0, 3, 12, 0, 0x3c};
    put_u32(file + 44, 2);
    put_u32(file + 88, sizeof packed);
    memcpy(file + 104, packed, sizeof packed);
    write_texture("zstd.ktx2", file, 104 + sizeof packed);
    memset(file, 0, sizeof file);
    const int head =
        snprintf((char *)file + 10, 200, "{'descr': '<f2', 'fortran_order': False, 'shape': (12, 2, 4), }\n");
    memcpy(file, "\x93NUMPY\1\0", 8);
    file[8] = (uint8_t)head;
    write_texture("half.npy", file, 10 + (size_t)head + 192);
    write_texture("raw", file + 400, 24);
}

/* ---- Words ---- */

static FILE *dictionary(const char *name) {
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.dict", base, name);
    FILE *out = fopen(path, "w");
    check(out != NULL, "a dictionary cannot be written");
    return out;
}

static void put_word(FILE *out, const char *text) {
    if (!text || !text[0] || strlen(text) > 60) return;
    fputc('"', out);
    for (; *text; text++)
        if (*text == '"' || *text == '\\') fprintf(out, "\\%c", *text);
        else if (*text >= ' ' && (signed char)*text > 0) fputc(*text, out);
        else fprintf(out, "\\x%02x", (unsigned)(unsigned char)*text);
    fputs("\"\n", out);
}

/* Each word of a list in one text. */
static void put_words(FILE *out, const char *text) {
    char word[64];
    for (const char *at = text ? text : ""; *at; at += strcspn(at, " "), at += strspn(at, " ")) {
        snprintf(word, sizeof word, "%.*s", (int)strcspn(at, " "), at);
        put_word(out, word);
    }
}

static void write_roles(FILE *out) {
    size_t count;
    const struct glint_role *roles = glint_roles(&count);
    for (size_t i = 0; i < count; i++) {
        put_word(out, roles[i].name);
        for (size_t c = 0; c < roles[i].channel_count; c++) put_word(out, roles[i].channels[c].name);
    }
}

static void write_exr_words(const char *name) {
    FILE *out = dictionary(name);
    struct glint_edit_key key;
    static const char *const types[] = {
        "box2i",         "chlist",        "compression", "double", "float",        "floatvector", "int",
        "lineOrder",     "m44d",          "m44f",        "string", "stringvector", "tiledesc",    "tiledimage",
        "scanlineimage", "deepscanline",  "v2d",         "v2f",    "v3d",          "v3f",         "chunkCount",
        "dataWindow",    "displayWindow", "channels",    "tiles",  "name",         "type",        "version"};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) put_word(out, types[i]);
    for (size_t i = 0; glint_edit_key(i, &key); i++) {
        char full[64];
        snprintf(full, sizeof full, "glint.%s", key.name);
        put_word(out, full);
        put_word(out, key.name);
        for (size_t k = 0; glint_edit_value_name(i, k); k++) put_word(out, glint_edit_value_name(i, k));
    }
    write_roles(out);
    check(!fclose(out), "a dictionary cannot be written");
}

static void write_pipeline_words(const char *name, const char *more) {
    FILE *out = dictionary(name);
    size_t count;
    const struct glint_pass *passes = glint_passes(&count);
    for (size_t i = 0; i < count; i++) {
        put_word(out, passes[i].slot);
        put_word(out, passes[i].variant);
        for (size_t r = 0; r < passes[i].row_count; r++) {
            const struct glint_row *row = &passes[i].rows[r];
            char full[160];
            snprintf(full, sizeof full, "%.70s.%.70s", passes[i].slot, row->name);
            if (glint_row_is_parameter(row)) put_word(out, full);
            else if (row->kind == GLINT_ROW_WRITE) put_word(out, row->name);
            for (size_t c = 0; row->choices && row->choices[c]; c++) put_word(out, row->choices[c]);
        }
    }
    for (size_t i = 0; glint_preset(i); i++) put_word(out, glint_preset(i));
    put_words(out, more);
    check(!fclose(out), "a dictionary cannot be written");
}

static void write_manifest_words(void) {
    FILE *out = dictionary("manifest");
    for (const struct object *object = pack_objects; object->name; object++)
        for (const struct key *key = object->keys; key->name; key++) {
            put_word(out, key->name);
            put_words(out, key->detail);
        }
    write_roles(out);
    put_words(out, "VK_FORMAT_R8_UNORM VK_FORMAT_R16G16B16A16_SFLOAT DXGI_FORMAT_D32_FLOAT half float uint one.npy "
                   "one.bin manifest.json bottom_first");
    check(!fclose(out), "a dictionary cannot be written");
}

int main(int argc, char **argv) {
    static struct fixture f;
    check(argc == 2, "expected a folder");
    base = argv[1];
    mkdir(base, 0777);
    fixture_init(&f);
    for (int third = FIXTURE_LIT + 1; third < FIXTURE_PARTS; third++)
        if (third != FIXTURE_PROBE) write_capture(&f, (enum fixture_part)third, GLINT_NONE, 0);
    for (int compression = GLINT_ZIP; compression <= GLINT_RLE; compression++) {
        write_capture(&f, FIXTURE_SCENE, (enum glint_compression)compression, 0);
        write_images((enum glint_compression)compression);
    }
    for (int encoding = 1; encoding < ENCODINGS; encoding++)
        write_capture(&f, FIXTURE_PREVIOUS_GBUFFER, GLINT_NONE, encoding);
    write_tiled();
    write_textures();
    write_exr_words("capture");
    write_exr_words("exr");
    write_exr_words("edit");
    write_pipeline_words("preset", "slots set name title source provenance pipeline.rays pipeline.first_ray");
    write_pipeline_words("assign", "pipeline.rays= pipeline.first_ray= =true =false =none");
    write_pipeline_words("live", "state capture preset use set skip force draft quick urgent reference client effect "
                                 "name of against metrics image "
                                 "x y run pipeline.rays");
    write_pipeline_words("run", "format passes images slot variant name unit meaning channels encoding file part width "
                                "height compared images.exr "
                                "srgb R16F R32UI .level1 R G B A");
    write_manifest_words();
    return 0;
}

/* The EXR layer alone: unknown attributes and parts are preserved, layers are read separately, and usage errors are reported. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fixture.h"
#include "rewrite.h"
#include "unit.h"

/* box2i, rational, v2f and an unknown type, as bytes in the file's order. */
static const int32_t box[4] = {1, -2, 3, 4};
static const int32_t ratio[2] = {24000, 1001};
static const float pair[2] = {0.5f, -0.25f};
static const uint8_t secret[5] = {1, 2, 3, 0, 255};
static const uint8_t one[1] = {1}, tiles[9] = {32, 0, 0, 0, 16};
static const double curve[3] = {0.5, 1.25, 3};
static const char *const words[] = {"one", "", "three and more"};
static const double matrix[16] = {1.1, 2.2, 3.3, 4.4, 5.5, 6.6, 7.7, 8.8, 9.9, 1e300, 1e-300, -0.1, 0, 0, 0, 1};

#define OPAQUE(n, t, b)                                                                                                \
    { .name = n, .type = GLINT_EXR_OPAQUE, .type_name = t, .bytes = b, .count = sizeof b }

static const struct glint_exr_attribute odd[] = {
    OPAQUE("framing", "box2i", box),
    OPAQUE("framesPerSecond", "rational", ratio),
    OPAQUE("pivot", "v2f", pair),
    OPAQUE("aVeryLongAttributeNameThatNeedsTheLongNamesFlag", "studio.secret", secret),
    {.name = "curve", .type = GLINT_EXR_FLOATS, .type_name = "floatvector", .numbers = curve, .count = 3},
    {.name = "words", .type = GLINT_EXR_STRINGS, .type_name = "stringvector", .strings = words, .count = 3},
    {.name = "matrix", .type = GLINT_EXR_M44D, .type_name = "m44d", .numbers = matrix, .count = 16},
    {.name = "place", .type = GLINT_EXR_V3D, .type_name = "v3d", .numbers = matrix, .count = 3},
    {.name = "offset", .type = GLINT_EXR_V2D, .type_name = "v2d", .numbers = matrix, .count = 2},
    {.name = "tint", .type = GLINT_EXR_V3F, .type_name = "v3f", .numbers = curve, .count = 3},
    {.name = "gain", .type = GLINT_EXR_FLOAT, .type_name = "float", .numbers = curve, .count = 1},
    {.name = "fine", .type = GLINT_EXR_DOUBLE, .type_name = "double", .numbers = matrix, .count = 1},
    {.name = "take", .type = GLINT_EXR_INT, .type_name = "int", .numbers = curve + 2, .count = 1},
    {.name = "note", .type = GLINT_EXR_STRING, .type_name = "string", .string = "größer"},
    OPAQUE("packing", "compression", one),
    OPAQUE("order", "lineOrder", one),
    OPAQUE("blocks", "tiledesc", tiles),
};

static void check_same(const struct glint_exr_attribute *a, const struct glint_exr_attribute *b) {
    assert_non_null(b);
    assert_int_equal(a->type, b->type);
    assert_string_equal(a->type_name, b->type_name);
    if (a->type == GLINT_EXR_STRING) assert_string_equal(a->string, b->string);
    else assert_int_equal(a->count, b->count);
    if (a->type == GLINT_EXR_OPAQUE) assert_memory_equal(a->bytes, b->bytes, a->count);
    if (a->type == GLINT_EXR_STRINGS)
        for (size_t i = 0; i < a->count; i++) assert_string_equal(a->strings[i], b->strings[i]);
    if (a->numbers) assert_memory_equal(a->numbers, b->numbers, a->count * sizeof *a->numbers);
}

/* A capture with foreign parts and attributes, read and written twice. */
static void what_is_not_known_is_kept_and_passed_on(UNUSED void **state) {
    static struct rewrite r;
    char path[512];
    struct glint_error err = {0};
    assert_true(fixture_write(&fixture, fixture_path(path, "passed.exr"), FIXTURE_PARTS, NULL, &err));
    rewrite_load(&r, path);
    struct rewrite_part *extra = &r.parts[r.count++];
    snprintf(extra->name, sizeof extra->name, "studio.matte");
    extra->part = r.parts[1].part;
    extra->channels[0] = (struct glint_exr_channel){
        .name = "matte.mask", .stored = GLINT_STORED_FLOAT, .data = fixture.color, .x_stride_bytes = 16};
    extra->part.width = FIX_W;
    extra->part.height = FIX_H;
    extra->part.channel_count = 1;
    extra->part.attribute_count = sizeof odd / sizeof *odd;
    memcpy(extra->attributes, odd, sizeof odd);
    struct rewrite_part *gbuffer = rewrite_find(&r, "gbuffer");
    gbuffer->attributes[gbuffer->part.attribute_count++] = odd[13];
    rewrite_save(&r, path);
    extra->part.channel_count = 0; /* its pixels belong to the fixture */
    rewrite_finish(&r);
    for (int round = 0; round < 2; round++) {
        struct glint_capture *capture = glint_capture_open(path, NULL, &err);
        if (!capture) fail_msg("%s", err.message);
        const struct glint_part_info *part = glint_capture_find(capture, "studio.matte");
        assert_non_null(part);
        assert_null(part->role);
        static float out[FIX_W * FIX_H];
        const char *const names[] = {"matte.mask"};
        if (!glint_capture_read(capture, part, names, 1, GLINT_F32, out, 0, &err)) fail_msg("%s", err.message);
        for (size_t i = 0; i < FIX_W * FIX_H; i++) assert_true(out[i] == fixture.color[4 * i]);
        const struct glint_part_info *known = glint_capture_find(capture, "gbuffer");
        assert_int_equal(known->attribute_count, 1);
        assert_string_equal(known->attributes[0].name, "note");
        assert_string_equal(known->attributes[0].string, "größer");
        glint_capture_close(&capture);
        struct glint_exr *exr = glint_exr_open(path, NULL, &err);
        assert_non_null(exr);
        for (size_t p = 0; p < glint_exr_part_count(exr); p++)
            if (!strcmp(glint_exr_part(exr, p)->name, "studio.matte"))
                for (size_t a = 0; a < sizeof odd / sizeof *odd; a++)
                    check_same(&odd[a], glint_exr_attribute(glint_exr_part(exr, p), odd[a].name));
        glint_exr_close(&exr);
        rewrite_load(&r, path);
        rewrite_save(&r, path);
        rewrite_finish(&r);
    }
    unlink(path);
}

/* Attributes that an engine adds through the public writer. */
static void the_engines_own_attributes_come_back(UNUSED void **state) {
    char path[512];
    struct glint_error err = {0};
    const struct glint_attribute mine[] = {
        {.name = "level", .type = GLINT_ATTRIBUTE_STRING, .string = "harbour"},
        {.name = "seed", .type = GLINT_ATTRIBUTE_INT, .number = -7},
        {.name = "noise", .type = GLINT_ATTRIBUTE_DOUBLE, .number = 0.1},
    };
    const struct glint_frame frame = fixture_frame();
    struct glint_writer *writer = glint_writer_create(fixture_path(path, "own.exr"), NULL, &err);
    bool ok = writer && glint_writer_set_frame(writer, &frame, &err);
    for (int p = 0; ok && p <= FIXTURE_LIT; p++) {
        struct fixture_channels channels;
        struct glint_part part = fixture_part(&fixture, (enum fixture_part)p, &channels);
        part.attributes = mine;
        part.attribute_count = 3;
        ok = glint_writer_add_part(writer, &part, &err);
    }
    ok = ok && glint_writer_finish(writer, &err);
    glint_writer_destroy(&writer);
    struct glint_capture *capture = ok ? glint_capture_open(path, NULL, &err) : NULL;
    if (!capture) fail_msg("%s", err.message);
    const struct glint_part_info *part = glint_capture_find(capture, "lit");
    assert_int_equal(part->attribute_count, 3);
    for (size_t i = 0; i < 3; i++) {
        assert_string_equal(part->attributes[i].name, mine[i].name);
        assert_int_equal(part->attributes[i].type, mine[i].type);
        if (mine[i].string) assert_string_equal(part->attributes[i].string, mine[i].string);
        assert_true(part->attributes[i].number == mine[i].number);
    }
    glint_capture_close(&capture);
    unlink(path);
}

/* A damaged part does not prevent reading the others: only the chunks of the requested part are read. */
static void a_layer_is_read_without_the_others(UNUSED void **state) {
    char path[512];
    struct glint_error err = {0};
    /* Constant enough for ZIP to be used; noise would be stored uncompressed. */
    for (size_t i = 0; i < FIX_W * FIX_H * 4; i++) fixture.color[i] = 0.5f;
    for (size_t i = 0; i < FIX_W * FIX_H * 17; i++) fixture.gbuffer[i] = i % 17 == 1 ? 1 : i % 17 < 4 ? 0 : 0.25f;
    assert_true(fixture_write(&fixture, fixture_path(path, "single.exr"), FIXTURE_PARTS, NULL, &err));
    fixture_init(&fixture);
    struct stat info;
    assert_int_equal(stat(path, &info), 0);
    FILE *file = fopen(path, "r+b");
    /* After the header of the last chunk (part, line, size): the zlib stream of the last part, `water`. */
    fseek(file, -40, SEEK_END);
    for (int i = 0; i < 40; i++) fputc(0xff, file);
    fclose(file);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    if (!capture) fail_msg("%s", err.message);
    static float out[FIX_W * FIX_H];
    size_t broken = 0;
    for (size_t p = 0; p < glint_capture_part_count(capture); p++) {
        const struct glint_part_info *part = glint_capture_part(capture, p);
        const char *names[] = {part->channels[0].name};
        if (!glint_capture_read_raw(capture, part, names, 1, GLINT_F32, out, 0, &err)) {
            broken++;
            if (!strstr(err.message, "part water") || !strstr(err.message, "ZIP")) fail_msg("%s", err.message);
        }
    }
    assert_int_equal(broken, 1);
    glint_capture_close(&capture);
    unlink(path);
}

static void mistakes_of_the_caller_are_told(UNUSED void **state) {
    char path[512];
    struct glint_error err = {0};
    assert_true(fixture_write(&fixture, fixture_path(path, "calls.exr"), FIXTURE_PARTS, NULL, &err));
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    assert_non_null(capture);
    const struct glint_part_info *part = glint_capture_find(capture, "gbuffer");
    static float out[FIX_W * FIX_H * 4];
    static const struct {
        const char *name;
        enum glint_type type;
        enum glint_code code;
        const char *words;
    } calls[] = {
        {"nothing.Z", GLINT_F32, GLINT_ERROR_FORMAT, "part gbuffer: nothing.Z missing"},
        {"depth.Z", GLINT_U32, GLINT_ERROR_USAGE, "depth.Z: expected uint, found float"},
        {"stencil.id", GLINT_F32, GLINT_ERROR_USAGE, "stencil.id: expected half or float, found uint"},
        {"depth.Z", GLINT_UNORM8, GLINT_ERROR_USAGE, "a plain type"},
    };
    for (size_t i = 0; i < sizeof calls / sizeof *calls; i++) {
        const char *const names[] = {calls[i].name};
        err = (struct glint_error){0};
        assert_false(glint_capture_read(capture, part, names, 1, calls[i].type, out, 0, &err));
        if (err.code != calls[i].code || !strstr(err.message, calls[i].words)) fail_msg("%zu: %s", i, err.message);
        assert_false(glint_capture_read(capture, part, names, 1, calls[i].type, out, 0, NULL));
    }
    const struct glint_part_info other = *part;
    assert_false(glint_capture_read(capture, &other, (const char *const[]){"depth.Z"}, 1, GLINT_F32, out, 0, &err));
    assert_int_equal(err.code, GLINT_ERROR_USAGE);
    /* stencil.id reaches 250 here, which fits 8 bits; one more does not. */
    static uint8_t ids[FIX_W * FIX_H];
    assert_true(glint_capture_read(capture, part, (const char *const[]){"stencil.id"}, 1, GLINT_U8, ids, 0, &err));
    for (size_t i = 0; i < FIX_W * FIX_H; i++) assert_int_equal(ids[i], fixture.stencil[i]);
    glint_capture_close(&capture);
    fixture.stencil[77] = 256;
    assert_true(fixture_write(&fixture, path, FIXTURE_PARTS, NULL, &err));
    fixture_init(&fixture);
    capture = glint_capture_open(path, NULL, &err);
    part = glint_capture_find(capture, "gbuffer");
    assert_false(glint_capture_read(capture, part, (const char *const[]){"stencil.id"}, 1, GLINT_U8, ids, 0, &err));
    assert_non_null(strstr(err.message, "2^8"));
    glint_capture_close(&capture);
    unlink(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_not_known_is_kept_and_passed_on),
        cmocka_unit_test(the_engines_own_attributes_come_back),
        cmocka_unit_test(a_layer_is_read_without_the_others),
        cmocka_unit_test(mistakes_of_the_caller_are_told),
    };
    return cmocka_run_group_tests(tests, fixture_setup, NULL);
}

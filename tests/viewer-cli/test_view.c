/* glint view, pixel by pixel, on small EXR files with known values. */
#include "cli.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/exr.h"

static const uint8_t magenta[3] = {255, 0, 255};

static void write_exr(const char *path, const char *part, uint32_t width, uint32_t height, const char *channels,
                      const void *values, enum glint_stored stored, const char *unit) {
    struct glint_exr_channel list[4] = {{0}};
    char names[4][32];
    size_t count = 0;
    for (const char *p = channels; *p; p += strcspn(p, " ") + (p[strcspn(p, " ")] ? 1 : 0), count++)
        snprintf(names[count], sizeof names[count], "%.*s", (int)strcspn(p, " "), p);
    for (size_t i = 0; i < count; i++)
        list[i] = (struct glint_exr_channel){.name = names[i],
                                             .stored = stored,
                                             .data = (const char *)values + 4 * i,
                                             .x_stride_bytes = 4 * count,
                                             .y_stride_bytes = 4 * count * width};
    const struct glint_exr_attribute attribute = {.name = "glint.unit", .type = GLINT_EXR_STRING, .string = unit};
    const struct glint_exr_part file = {.name = part,
                                        .width = width,
                                        .height = height,
                                        .channels = list,
                                        .channel_count = count,
                                        .attributes = &attribute,
                                        .attribute_count = unit ? 1 : 0};
    struct glint_error err = {0};
    if (!glint_exr_write(path, &file, 1, 1, &err)) fail_msg("%s", err.message);
}

static void assert_pixel(const struct pixels *p, uint32_t x, uint32_t y, const uint8_t *expected, int tolerance) {
    const uint8_t *found = pixel(p, x, y);
    for (int k = 0; k < 3; k++)
        if (abs(found[k] - expected[k]) > tolerance)
            fail_msg("pixel %u,%u is %d,%d,%d, expected %d,%d,%d", x, y, found[0], found[1], found[2], expected[0],
                     expected[1], expected[2]);
}

static void assert_grey(const struct pixels *p, uint32_t x, uint32_t y, double value) {
    uint8_t v = (uint8_t)lround(value * 255);
    assert_pixel(p, x, y, (const uint8_t[3]){v, v, v}, 1); /* 1: OpenColorIO's sRGB curve is an approximation */
}

static double srgb(double v) {
    return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055;
}

static void colour_without_tone_mapping_is_the_srgb_curve(UNUSED void **state) {
    const float v[] = {0, 0, 0, 0.18F, 0.18F, 0.18F, 1, 1, 1, 0.002F, 0.002F, 0.002F, 7, 7, 7, NAN, 0, 0};
    struct pixels p;
    write_exr(in_folder("c.exr"), "color", 6, 1, "R G B", v, GLINT_STORED_FLOAT, "radiance");
    free(glint_ok("view", in_folder("c.exr"), "--view", "sRGB", "-o", in_folder("c.png")));
    p = read_png(in_folder("c.png"));
    assert_int_equal(p.width, 6);
    assert_int_equal(p.height, 1);
    const double expected[] = {0, srgb(0.18), 1, srgb(0.002), 1};
    for (uint32_t i = 0; i < 5; i++) assert_grey(&p, i, 0, expected[i]);
    assert_pixel(&p, 5, 0, magenta, 0);
    free(p.rgb);

    free(glint_ok("view", in_folder("c.exr"), "--view=sRGB", "--exposure=-1", "-o", in_folder("c.png")));
    p = read_png(in_folder("c.png"));
    assert_grey(&p, 1, 0, srgb(0.09));
    free(p.rgb);

    free(glint_ok("view", in_folder("c.exr"), "--view=raw", "-o", in_folder("c.png")));
    p = read_png(in_folder("c.png"));
    assert_grey(&p, 1, 0, 0.18);
    free(p.rgb);
}

/* The same configuration and view through another program; both use OpenColorIO and round separately. */
/* Catches: a second tone curve over a picture that has one, values taken for linear ones. */
static void what_is_encoded_for_a_display_is_shown_as_it_is(UNUSED void **state) {
    const float v[] = {0, 0.5F, 1, 0.02F, 0.25F, 0.75F};
    struct glint_exr_channel channels[3];
    for (size_t c = 0; c < 3; c++)
        channels[c] = (struct glint_exr_channel){.name = (const char *[]){"R", "G", "B"}[c],
                                                 .stored = GLINT_STORED_FLOAT,
                                                 .data = v + c,
                                                 .x_stride_bytes = 3 * sizeof *v};
    const struct glint_exr_attribute color = {.name = "glint.color", .type = GLINT_EXR_STRING, .string = "srgb"};
    const struct glint_exr_part part = {.name = "graded",
                                        .width = 2,
                                        .height = 1,
                                        .channels = channels,
                                        .channel_count = 3,
                                        .attributes = &color,
                                        .attribute_count = 1};
    struct glint_error err = {0};
    struct pixels p;
    if (!glint_exr_write(in_folder("encoded.exr"), &part, 1, 1, &err)) fail_msg("%s", err.message);
    for (int named = 0; named < 2; named++) { /* the view without a tone curve encodes it again as it was */
        if (named) free(glint_ok("view", in_folder("encoded.exr"), "--view", "sRGB", "-o", in_folder("encoded.png")));
        else free(glint_ok("view", in_folder("encoded.exr"), "-o", in_folder("encoded.png")));
        p = read_png(in_folder("encoded.png"));
        for (uint32_t x = 0; x < 2; x++)
            assert_pixel(&p, x, 0,
                         (const uint8_t[3]){(uint8_t)lroundf(255 * v[3 * x]), (uint8_t)lroundf(255 * v[3 * x + 1]),
                                            (uint8_t)lroundf(255 * v[3 * x + 2])},
                         named);
        free(p.rgb);
    }
}

static void colour_equals_oiiotool(UNUSED void **state) {
    enum { W = 32, H = 24 };
    static float v[W * H * 3];
    for (int i = 0; i < W * H; i++) {
        v[3 * i] = exp2f((float)(i % W) / 3 - 7);
        v[3 * i + 1] = exp2f((float)(i / W) / 2 - 8);
        v[3 * i + 2] = exp2f((float)((7 * i) % 31) / 3 - 8);
    }
    write_exr(in_folder("o.exr"), "color", W, H, "R G B", v, GLINT_STORED_FLOAT, "radiance");
    static const char *const views[] = {"ACES", "sRGB", "raw"};
    for (size_t k = 0; k < 3; k++) {
        free(glint_ok("view", in_folder("o.exr"), "--view", views[k], "-o", in_folder("ours.png")));
        struct outcome other =
            run_program("oiiotool", "--colorconfig", GLINT_OCIO, in_folder("o.exr"), "--ociodisplay:from=lin_rec709",
                        "sRGB", views[k], "-d", "uint8", "-o", in_folder("theirs.png"), NULL);
        if (other.status != 0) fail_msg("oiiotool: %s%s", other.err, other.out);
        outcome_free(&other);
        struct pixels ours = read_png(in_folder("ours.png")), theirs = read_png(in_folder("theirs.png"));
        assert_int_equal(ours.width, theirs.width);
        assert_int_equal(ours.height, theirs.height);
        for (uint32_t y = 0; y < H; y++)
            for (uint32_t x = 0; x < W; x++) assert_pixel(&ours, x, y, pixel(&theirs, x, y), 1);
        free(ours.rgb);
        free(theirs.rgb);
    }
    /* The same file as an external configuration. */
    free(glint_ok("view", in_folder("o.exr"), "--ocio", GLINT_OCIO, "-o", in_folder("again.png")));
    free(glint_ok("view", in_folder("o.exr"), "-o", in_folder("ours.png")));
    struct pixels a = read_png(in_folder("again.png")), b = read_png(in_folder("ours.png"));
    assert_memory_equal(a.rgb, b.rgb, W * H * 3);
    free(a.rgb);
    free(b.rgb);
}

/* matplotlib's table at its ends and in the middle; 4: the polynomial's error at the dark end is 3/255. */
static void distance_is_viridis_between_the_ends_of_the_range(UNUSED void **state) {
    const float v[] = {2, 6, 10, INFINITY, NAN, 0, 99};
    write_exr(in_folder("d.exr"), "travelled", 7, 1, "Z", v, GLINT_STORED_FLOAT, "m");
    free(glint_ok("view", in_folder("d.exr"), "--range=2,10", "--no-legend", "-o", in_folder("d.png")));
    struct pixels p = read_png(in_folder("d.png"));
    const uint8_t dark[] = {68, 1, 84}, middle[] = {33, 145, 140}, bright[] = {253, 231, 37};
    assert_int_equal(p.height, 1);
    assert_pixel(&p, 0, 0, dark, 4);
    assert_pixel(&p, 1, 0, middle, 4);
    assert_pixel(&p, 2, 0, bright, 4);
    assert_pixel(&p, 4, 0, magenta, 0);
    assert_pixel(&p, 5, 0, pixel(&p, 0, 0), 0);
    assert_pixel(&p, 6, 0, pixel(&p, 2, 0), 0);
    const uint8_t *sky = pixel(&p, 3, 0);
    assert_true(sky[2] > sky[0] && memcmp(sky, pixel(&p, 2, 0), 3) != 0);
    free(p.rgb);

    free(glint_ok("view", in_folder("d.exr"), "--range=1,100", "--scale=log", "--no-legend", "-o", in_folder("d.png")));
    p = read_png(in_folder("d.png"));
    assert_pixel(&p, 2, 0, middle, 4); /* 10 is halfway between 1 and 100 */
    free(p.rgb);
}

/* Lengths from 0.1 to 10 have a logarithmic scale by default; other quantities do not. */
static void wide_lengths_are_shown_logarithmically(UNUSED void **state) {
    const float v[] = {0.1F, 1, 10, 0};
    static const char *const units[] = {"m", "steps"};
    for (size_t k = 0; k < 2; k++) {
        write_exr(in_folder("a.exr"), "travelled", 4, 1, "Z", v, GLINT_STORED_FLOAT, units[k]);
        free(glint_ok("view", in_folder("a.exr"), "--no-legend", "-o", in_folder("a.png")));
        free(glint_ok("view", in_folder("a.exr"), k ? "--scale=linear" : "--scale=log", "--no-legend",
                      k ? "--range=0,10" : "--range=0.1,10", "-o", in_folder("b.png")));
        struct pixels a = read_png(in_folder("a.png")), b = read_png(in_folder("b.png"));
        assert_memory_equal(a.rgb, b.rgb, 12);
        free(a.rgb);
        free(b.rgb);
    }
}

static void range_is_the_percentiles_without_the_outliers(UNUSED void **state) {
    static float v[1000];
    for (int i = 0; i < 1000; i++) v[i] = (float)i / 999;
    v[500] = 1e9F;
    write_exr(in_folder("r.exr"), "travelled", 1000, 1, "Z", v, GLINT_STORED_FLOAT, "m");
    free(glint_ok("view", in_folder("r.exr"), "--no-legend", "-o", in_folder("r.png")));
    free(glint_ok("view", in_folder("r.exr"), "--no-legend", "--range=0.005,0.995", "-o", in_folder("s.png")));
    struct pixels p = read_png(in_folder("r.png")), s = read_png(in_folder("s.png"));
    for (uint32_t i = 0; i < 1000; i += 99) assert_pixel(&p, i, 0, pixel(&s, i, 0), 2);
    free(p.rgb);
    free(s.rgb);
}

static void legend_stands_below_the_picture(UNUSED void **state) {
    static float v[400 * 10];
    for (int i = 0; i < 4000; i++) v[i] = (float)(i % 400);
    write_exr(in_folder("l.exr"), "travelled", 400, 10, "Z", v, GLINT_STORED_FLOAT, "m");
    free(glint_ok("view", in_folder("l.exr"), "-o", in_folder("l.png")));
    struct pixels p = read_png(in_folder("l.png"));
    assert_int_equal(p.width, 400);
    assert_true(p.height > 50);
    /* the bar shows the whole scale, and the text is bright on dark */
    bool dark = false, bright = false, text = false;
    for (uint32_t y = 10; y < p.height; y++)
        for (uint32_t x = 0; x < p.width; x++) {
            const uint8_t *c = pixel(&p, x, y);
            dark = dark || (abs(c[0] - 68) < 5 && abs(c[1] - 1) < 5 && abs(c[2] - 84) < 5);
            bright = bright || (abs(c[0] - 253) < 5 && abs(c[1] - 231) < 5 && abs(c[2] - 37) < 5);
            text = text || (c[0] > 200 && c[1] > 200 && c[2] > 200);
        }
    assert_true(dark && bright && text);
    free(p.rgb);
}

static int ticks_of(const char *path, const char *range) {
    free(glint_ok("view", path, "--scale=linear", range, "-o", in_folder("t.png")));
    struct pixels p = read_png(in_folder("t.png"));
    uint32_t y = p.height;
    int ticks = 0;
    while (y > 0 && abs(pixel(&p, 10, y - 1)[2] - 84) > 4) y--; /* the last row of the bar, whose left end is 68,1,84 */
    assert_true(y > 0 && y < p.height);
    for (uint32_t x = 0; x < p.width; x++) ticks += memcmp(pixel(&p, x, y), "\xe6\xe8\xeb", 3) == 0;
    free(p.rgb);
    return ticks;
}

/* 360 pixels fit five short numbers, and three long ones. */
static void a_legend_has_as_many_ticks_as_its_labels_leave_room_for(UNUSED void **state) {
    const float v[] = {0, 1};
    write_exr(in_folder("t.exr"), "travelled", 2, 1, "Z", v, GLINT_STORED_FLOAT, "m");
    char *path = strdup(in_folder("t.exr"));
    assert_int_equal(ticks_of(path, "--range=0,1"), 5);
    assert_int_equal(ticks_of(path, "--range=1,4.29e9"), 3);
    free(path);
}

static void normals_are_half_and_offset(UNUSED void **state) {
    const float v[] = {1, 0, 0, 0, -1, 0, 0, 0, 1};
    write_exr(in_folder("n.exr"), "normal_half", 3, 1, "X Y Z", v, GLINT_STORED_FLOAT, "1");
    free(glint_ok("view", in_folder("n.exr"), "--no-legend", "-o", in_folder("n.png")));
    struct pixels p = read_png(in_folder("n.png"));
    assert_pixel(&p, 0, 0, (const uint8_t[3]){255, 128, 128}, 0);
    assert_pixel(&p, 1, 0, (const uint8_t[3]){128, 0, 128}, 0);
    assert_pixel(&p, 2, 0, (const uint8_t[3]){128, 128, 255}, 0);
    free(p.rgb);
}

static void indices_and_reasons_have_colours_of_their_own(UNUSED void **state) {
    uint32_t v[11];
    for (uint32_t i = 0; i < 11; i++) v[i] = i;
    static const char *const kinds[][2] = {{"index", "index"}, {"end reason", "reason"}};
    for (size_t k = 0; k < 2; k++) {
        write_exr(in_folder("i.exr"), "image", 11, 1, kinds[k][1], v, GLINT_STORED_UINT, kinds[k][0]);
        free(glint_ok("view", in_folder("i.exr"), "--no-legend", "-o", in_folder("i.png")));
        struct pixels p = read_png(in_folder("i.png"));
        for (uint32_t i = 0; i < (k ? 11 : 10); i++)
            for (uint32_t j = 0; j < i; j++) assert_memory_not_equal(pixel(&p, i, 0), pixel(&p, j, 0), 3);
        free(p.rgb);
    }
}

static void crop_and_zoom(UNUSED void **state) {
    float v[4 * 3 * 3];
    for (int i = 0; i < 12; i++) v[3 * i] = v[3 * i + 1] = v[3 * i + 2] = (float)i / 16;
    write_exr(in_folder("z.exr"), "color", 4, 3, "R G B", v, GLINT_STORED_FLOAT, "radiance");
    free(glint_ok("view", in_folder("z.exr"), "--view=raw", "--crop=1,1,2,2", "--zoom=3", "-o", in_folder("z.png")));
    struct pixels p = read_png(in_folder("z.png"));
    assert_int_equal(p.width, 6);
    assert_int_equal(p.height, 6);
    for (uint32_t y = 0; y < 6; y++)
        for (uint32_t x = 0; x < 6; x++) assert_grey(&p, x, y, (4 * (1 + y / 3) + 1 + x / 3) / 16.0);
    free(p.rgb);
    char *text = glint_ok("view", in_folder("z.exr"), "--crop=1,1,2,2", "--stats", "--json");
    json_t *figures = parse_json(text);
    free(text);
    const json_t *red = named(json_object_get(figures, "channels"), "channel", "R");
    assert_true(number(red, "min") == 5 / 16.0 && number(red, "max") == 10 / 16.0 && number(red, "mean") == 7.5 / 16);
    json_decref(figures);
    glint_fails(2, "reaches outside the picture of 4 × 3", "view", in_folder("z.exr"), "--crop=3,0,2,1", "--stats");
    glint_fails(2, "reaches outside the picture of 4 × 3", "view", in_folder("z.exr"), "--crop=3,0,2,1", "-o",
                in_folder("no.png"));
    assert_false(file_exists(in_folder("no.png")));
}

/* Neighbouring faces of the cross agree at their common edge: the colour of every texel is its direction, computed here from Vulkan's
   table of major axes, so that colours are nearly equal across each inner edge. */
static void cube_map_is_a_seamless_cross(UNUSED void **state) {
    enum { N = 32 };
    static const float axis[6][3][3] = {
        /* major axis, s direction, t direction */
        {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
        {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}},
    };
    static float v[6 * N * N * 3];
    for (int f = 0; f < 6; f++)
        for (int i = 0; i < N * N; i++) {
            float s = 2 * ((float)(i % N) + 0.5F) / N - 1, t = 2 * ((float)(i / N) + 0.5F) / N - 1, d[3], length = 0;
            for (int k = 0; k < 3; k++) d[k] = axis[f][0][k] + s * axis[f][1][k] + t * axis[f][2][k];
            for (int k = 0; k < 3; k++) length += d[k] * d[k];
            for (int k = 0; k < 3; k++) v[3 * (f * N * N + i) + k] = d[k] / sqrtf(length) / 2 + 0.5F;
        }
    write_exr(in_folder("q.exr"), "cubemap.000", N, 6 * N, "R G B", v, GLINT_STORED_FLOAT, "radiance");
    free(glint_ok("view", in_folder("q.exr"), "--view=raw", "-o", in_folder("q.png")));
    struct pixels p = read_png(in_folder("q.png"));
    assert_int_equal(p.width, 4 * N);
    assert_int_equal(p.height, 3 * N);
    for (uint32_t i = 0; i < N; i++) {
        /* Half a texel on each side of an edge: at most 2/N of a unit direction, halved for the colour. */
        for (uint32_t edge = 1; edge < 4; edge++)
            assert_pixel(&p, edge * N, N + i, pixel(&p, edge * N - 1, N + i), 255 / N + 1);
        for (uint32_t edge = 1; edge < 3; edge++)
            assert_pixel(&p, N + i, edge * N, pixel(&p, N + i, edge * N - 1), 255 / N + 1);
    }
    const uint8_t front[] = {128, 128, 255};
    assert_pixel(&p, N + N / 2, N + N / 2, front, 255 / N + 1);
    free(p.rgb);
    free(glint_ok("view", in_folder("q.exr"), "--faces", "-o", in_folder("q.png")));
    p = read_png(in_folder("q.png"));
    assert_int_equal(p.height, 6 * N);
    free(p.rgb);
}

static void layers_are_named_after_a_colon(UNUSED void **state) {
    const float v[] = {0.25F, 0.5F, 0.75F};
    write_exr(in_folder("g.exr"), "surface", 1, 1, "albedo.R albedo.G albedo.B", v, GLINT_STORED_FLOAT, NULL);
    char *path = strdup(in_folder("g.exr")), spec[300];
    snprintf(spec, sizeof spec, "%s:surface:albedo", path);
    free(glint_ok("view", spec, "--view=raw", "-o", in_folder("g.png")));
    struct pixels p = read_png(in_folder("g.png"));
    assert_pixel(&p, 0, 0, (const uint8_t[3]){64, 128, 191}, 0);
    free(p.rgb);
    snprintf(spec, sizeof spec, "%s::albedo.G", path);
    free(glint_ok("view", spec, "--as=raw", "--no-legend", "-o", in_folder("g.png")));
    p = read_png(in_folder("g.png"));
    assert_pixel(&p, 0, 0, (const uint8_t[3]){128, 128, 128}, 0);
    free(p.rgb);
    glint_fails(2, "did you mean albedo?", "view", path, "--layer=albeod", "-o", in_folder("no.png"));
    glint_fails(2, "did you mean surface?", "view", path, "--part=surfaces", "-o", in_folder("no.png"));
    free(path);
}

static void wrong_use_and_bad_files(UNUSED void **state) {
    const float v[] = {1, 1, 1};
    char *path = strdup(in_folder("w.exr"));
    write_exr(path, "color", 1, 1, "R G B", v, GLINT_STORED_FLOAT, NULL);
    const char *out = in_folder("no.png");
    glint_fails(2, "did you mean ACES?", "view", path, "--view=ACE", "-o", out);
    glint_fails(2, "there is no display", "view", path, "--display=P3", "-o", out);
    glint_fails(2, "did you mean normal?", "view", path, "--as=normals", "-o", out);
    glint_fails(2, "--zoom=0", "view", path, "--zoom=0", "-o", out);
    glint_fails(2, "the first value must be smaller than the second", "view", path, "--range=2,1", "-o", out);
    glint_fails(2, "no output given", "view", path);
    glint_fails(1, "nowhere.exr", "view", "nowhere.exr", "-o", out);
    glint_fails(1, "nofolder", "view", path, "-o", "/nofolder/x.png");
    glint_fails(1, "OpenColorIO", "view", path, "--ocio", "/nofolder/config.ocio", "-o", out);
    FILE *junk = fopen(in_folder("junk.exr"), "wb");
    assert_non_null(junk);
    fputs("not an image", junk);
    fclose(junk);
    glint_fails(1, "junk.exr", "view", in_folder("junk.exr"), "-o", out);
    assert_false(file_exists(out));
    free(path);
}

/* Six times as high as wide, like the faces of a cube map below each other. */
static void a_narrow_picture_is_no_cube_map(UNUSED void **state) {
    char *capture = strdup(in_folder("narrow.exr")), *run = strdup(in_folder("narrow"));
    free(glint_ok("sample", "matte", "-o", capture, "--size", "8x48", "--cube-size", "8", "--light", "1"));
    free(glint_ok("replay", capture, "-o", run));
    for (int k = 0; k < 2; k++) {
        free(glint_ok("view", k ? run : capture, "-o", in_folder("narrow.png")));
        struct pixels p = read_png(in_folder("narrow.png"));
        assert_int_equal(p.width, 8);
        assert_int_equal(p.height, 48);
        free(p.rgb);
    }
    free(capture), free(run);
}

/* A terminal would interpret control characters in names from untrusted files. */
static void control_characters_in_names_do_not_reach_the_terminal(UNUSED void **state) {
    const float v[] = {1, 1, 1};
    write_exr(in_folder("e.exr"), "a\033[31mb\302\233c", 1, 1, "R G B", v, GLINT_STORED_FLOAT, "\033]0;title");
    char *info = glint_ok("info", in_folder("e.exr"));
    assert_contains(info, "a\\x1b[31mb\\u009bc");
    assert_null(strchr(info, '\033'));
    struct outcome view = glint("view", in_folder("e.exr"), "--part=\033[2J", "-o", "x.png", NULL);
    assert_int_equal(view.status, 2);
    assert_null(strchr(view.err, '\033'));
    outcome_free(&view);
    free(info);
}

static void a_dash_is_stdout(UNUSED void **state) {
    const float v[] = {1, 1, 1};
    write_exr(in_folder("w.exr"), "color", 1, 1, "R G B", v, GLINT_STORED_FLOAT, NULL);
    char *png = glint_ok("view", "-o", "-", in_folder("w.exr"));
    assert_memory_equal(png, "\x89PNG\r\n\x1a\n", 8);
    free(png);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colour_without_tone_mapping_is_the_srgb_curve),
        cmocka_unit_test(what_is_encoded_for_a_display_is_shown_as_it_is),
        cmocka_unit_test(colour_equals_oiiotool),
        cmocka_unit_test(distance_is_viridis_between_the_ends_of_the_range),
        cmocka_unit_test(wide_lengths_are_shown_logarithmically),
        cmocka_unit_test(range_is_the_percentiles_without_the_outliers),
        cmocka_unit_test(legend_stands_below_the_picture),
        cmocka_unit_test(a_legend_has_as_many_ticks_as_its_labels_leave_room_for),
        cmocka_unit_test(normals_are_half_and_offset),
        cmocka_unit_test(indices_and_reasons_have_colours_of_their_own),
        cmocka_unit_test(crop_and_zoom),
        cmocka_unit_test(cube_map_is_a_seamless_cross),
        cmocka_unit_test(a_narrow_picture_is_no_cube_map),
        cmocka_unit_test(layers_are_named_after_a_colon),
        cmocka_unit_test(wrong_use_and_bad_files),
        cmocka_unit_test(control_characters_in_names_do_not_reach_the_terminal),
        cmocka_unit_test(a_dash_is_stdout),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

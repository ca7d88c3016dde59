/* The rules of FORMAT.md for names of attributes, for lists in attributes and for a file's own headers, each broken by itself. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "broken.h"
#include "fixture.h"
#include "unit.h"

static struct glint_exr_attribute *new_attribute(struct rewrite *r, const char *part, const char *name,
                                                 const char *value) {
    struct rewrite_part *p = rewrite_find(r, part);
    struct glint_exr_attribute *a = &p->attributes[p->part.attribute_count++];
    *a = (struct glint_exr_attribute){.name = name, .type = GLINT_EXR_STRING, .string = value, .count = 1};
    return a;
}
static void misspelt_exposure(struct rewrite *r) {
    rewrite_attribute(r, "gbuffer", "glint.exposure")->name = "glint.exposurE";
}
static void misspelt_roughness(struct rewrite *r) {
    rewrite_attribute(r, "gbuffer", "glint.roughness")->name = "glint.roughnesS";
}
static void unheard_of(struct rewrite *r) {
    new_attribute(r, "sky", "glint.weather", "rain");
}
static void exposed_lit(struct rewrite *r) {
    *new_attribute(r, "lit", "", "") = *rewrite_attribute(r, "gbuffer", "glint.exposure");
}
static void previous_jitter(struct rewrite *r) {
    *new_attribute(r, "previous.gbuffer", "", "") = *rewrite_attribute(r, "gbuffer", "glint.jitter");
}
static void coloured_surface(struct rewrite *r) {
    new_attribute(r, "gbuffer", "glint.color", "linear");
}
static void seventeenth_hull(struct rewrite *r) {
    rewrite_attribute(r, "cubemap.000", "glint.hull.01")->name = "glint.hull.16";
}
static void environment(struct rewrite *r) {
    new_attribute(r, "sky", "envmap", "cube");
}
static void storage_text(struct rewrite *r) {
    rewrite_remove_attribute(r, "lit", "glint.storage");
    new_attribute(r, "lit", "glint.storage", "R=half");
}
static const char *entry[] = {NULL};
static void set_storage(struct rewrite *r, const char *text) {
    struct glint_exr_attribute *a = rewrite_attribute(r, "gbuffer", "glint.storage");
    entry[0] = text;
    a->strings = entry;
    a->count = 1;
}
static void storage_without_format(struct rewrite *r) {
    set_storage(r, "depth.Z");
}
static void storage_of_nothing(struct rewrite *r) {
    set_storage(r, "dept.Z=D24");
}
static void hull_gap(struct rewrite *r) {
    rewrite_attribute(r, "cubemap.000", "glint.hull.01")->name = "glint.hull.02";
}
static void hull_after_zeros(struct rewrite *r) {
    broken_numbers(r, "cubemap.000", "glint.hull.01", 15, 1); /* planes 6 and 7 are rows of zeros */
}
static void thick_plane(struct rewrite *r) {
    broken_numbers(r, "planar.002", "glint.plane", 5, 1);
}
static void hash_alone(struct rewrite *r) {
    new_attribute(r, "cubemap.000", "glint.siblingHash", "0123456789abcdef0123456789abcdef");
}

static void falling_stops(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.lutStops", 1, -9.5);
}
static void far_stops(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.lutStops", 1, 65);
}

static const struct broken_case cases[] = {
    {"attributes", {"part gbuffer: glint.exposurE", "did you mean glint.exposure?"}, misspelt_exposure, false},
    {"attributes", {"part gbuffer: glint.roughnesS", "did you mean glint.roughness?"}, misspelt_roughness, false},
    {"attributes", {"part sky: glint.weather", "an attribute of the format"}, unheard_of, false},
    {"attributes", {"part lit: glint.exposure", "on `gbuffer` only"}, exposed_lit, false},
    {"attributes", {"part previous.gbuffer: glint.jitter", "on `gbuffer` only"}, previous_jitter, false},
    {"attributes", {"part gbuffer: glint.color", "parts with such channels only"}, coloured_surface, false},
    {"attributes", {"part cubemap.000: glint.hull.16", "did you mean glint.hull."}, seventeenth_hull, false},
    {"attributes", {"part sky: envmap", "none"}, environment, false},
    {"attributes", {"part lit: glint.storage", "stringvector"}, storage_text, false},
    {"attributes", {"part gbuffer: glint.storage", "channel=format"}, storage_without_format, false},
    {"attributes", {"part gbuffer: glint.storage", "did you mean depth.Z?"}, storage_of_nothing, false},
    {"attributes", {"glint.hull.02", "a gap"}, hull_gap, false},
    {"attributes",
     {"glint.hull", "no plane after a row of zeros, found one in glint.hull.01"},
     hull_after_zeros,
     false},
    {"attributes", {"planar.002: glint.plane", "zeros below row 0"}, thick_plane, false},
    {"attributes",
     {"gbuffer: glint.lutStops", "two increasing numbers from -64 to 64, found -9.5 and -9.5"},
     falling_stops,
     false},
    {"attributes", {"gbuffer: glint.lutStops", "found -9.5 and 65"}, far_stops, false},
    {"sibling", {"cubemap.000", "expected glint.sibling beside"}, hash_alone, false},
};

static void names_are_those_of_the_format(UNUSED void **state) {
    broken_check(cases, sizeof cases / sizeof *cases);
}

/* Names of others, and names of a run's images on an engine's own part, are passed on. */
static void other_names(struct rewrite *r) {
    new_attribute(r, "gbuffer", "glint", "a prefix without a dot");
    new_attribute(r, "gbuffer", "engine.exposure", "auto");
    new_attribute(r, "engine.screen_trace.anything", "glint.image", "travelled");
    set_storage(r, "vertexNormal.X=a format of tomorrow");
}
static void other_names_are_kept(UNUSED void **state) {
    char path[512];
    struct glint_error err = {0};
    broken_check_count(fixture_path(path, "others.exr"), other_names, 0);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    if (!capture) fail_msg("%s", err.message);
    assert_int_equal(glint_capture_find(capture, "gbuffer")->attribute_count, 2);
    glint_capture_close(&capture);
    unlink(path);
}

/* ---- headers, changed byte by byte ---- */

static uint8_t bytes[1 << 20];

static size_t load(const char *path) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    assert_true(size < sizeof bytes);
    fclose(file);
    return size;
}

/* Where the value of a part's attribute begins: after its name, its type and its size. Parts are counted by their headers. */
static uint8_t *value_of(size_t size, const char *name, size_t part) {
    const size_t length = strlen(name) + 1;
    for (size_t i = 0; i + length < size; i++) {
        if (memcmp(bytes + i, name, length) != 0) continue;
        i += length + strlen((const char *)bytes + i + length) + 1; /* the type may have the same name */
        if (!part--) return bytes + i + 4;
    }
    fail_msg("no %s", name);
    return NULL;
}

static void headers_are_those_of_the_format(UNUSED void **state) {
    static const struct {
        struct broken_case c;
        const char *name;
        uint8_t was, is;
        size_t at;
    } headers[] = {
        {{.rule = "scanline", .words = {"part lit", "increasing y"}}, "lineOrder", 0, 1, 0},
        {{.rule = "scanline", .words = {"part lit", "B44A"}}, "compression", 4, 7, 0},
        {{.rule = "display-window", .words = {"part lit", "to (39, 23), found (0, 0) to (40, 23)"}},
         "displayWindow",
         39,
         40,
         8},
        {{.rule = "display-window", .words = {"part lit", "pixelAspectRatio of gbuffer, 1, found 0.5"}},
         "pixelAspectRatio",
         0x80,
         0,
         2},
    };
    const struct glint_writer_options piz = {.compression =
                                                 GLINT_PIZ}; /* whose chunks have as many lines as those of B44A */
    char path[512];
    struct glint_error err = {0};
    fixture_path(path, "headers.exr");
    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++) {
        assert_true(fixture_write(&fixture, path, 2, &piz, &err)); /* gbuffer and lit */
        const size_t size = load(path);
        uint8_t *value = value_of(size, headers[i].name, 1) + headers[i].at;
        assert_int_equal(*value, headers[i].was);
        *value = headers[i].is;
        FILE *file = fopen(path, "wb");
        assert_non_null(file);
        assert_int_equal(fwrite(bytes, 1, size, file), size);
        fclose(file);
        broken_check_file(&headers[i].c, path, i);
    }
    unlink(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_are_those_of_the_format),
        cmocka_unit_test(other_names_are_kept),
        cmocka_unit_test(headers_are_those_of_the_format),
    };
    return cmocka_run_group_tests(tests, fixture_setup, NULL);
}

/* A table of colours made by glint set: the picture that grade makes with it is the one that glint view shows through the same configuration. */
#include "cli.h"

#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/capture.h"
#include "glint/exr.h"

enum { WIDE = 96, HIGH = 54, PIXELS = WIDE * HIGH };
static const double LOW = -10, HIGHEST = 7; /* the stops of glint set */

/* The ACES output for cinemas on an sRGB display, and a scene-linear space of its own name. */
static const char cinema[] =
    "ocio_profile_version: 2\n"
    "roles: {default: lin_rec709, scene_linear: lin_rec709, aces_interchange: AP0, cie_xyz_d65_interchange: XYZ}\n"
    "file_rules:\n  - !<Rule> {name: Default, colorspace: default}\n"
    "displays:\n  screen:\n    - !<View> {name: cinema, view_transform: output, display_colorspace: screen}\n"
    "view_transforms:\n  - !<ViewTransform>\n    name: output\n"
    "    from_scene_reference: !<BuiltinTransform> {style: ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-CINEMA_1.0}\n"
    "display_colorspaces:\n  - !<ColorSpace> {name: XYZ}\n  - !<ColorSpace>\n    name: screen\n"
    "    from_display_reference: !<BuiltinTransform> {style: DISPLAY - CIE-XYZ-D65_to_sRGB}\n"
    "colorspaces:\n  - !<ColorSpace> {name: AP0}\n  - !<ColorSpace>\n    name: lin_rec709\n"
    "    from_scene_reference: !<GroupTransform>\n      children:\n"
    "        - !<BuiltinTransform> {style: ACEScg_to_ACES2065-1, direction: inverse}\n"
    "        - !<BuiltinTransform> {style: UTILITY - ACES-AP1_to_LINEAR-REC709_BFD}\n";

static const char display[] = "{\"name\": \"shown\", \"title\": \"a picture and its grade\", \"source\": \"GTA V "
                              "article\", \"slots\": {\"downsample\": \"none\", "
                              "\"screen_trace\": \"linear\", \"cubemap_active\": \"nearest\", \"cubemap_select\": "
                              "\"nearest\", \"cubemap_trace\": \"lookup\", "
                              "\"resolve\": \"hit\", \"upscale\": \"bilinear\", \"compose\": \"brdf\", \"exposure\": "
                              "\"stops\", \"grade\": \"combined\"}, "
                              "\"set\": {\"exposure.stops\": 2}}\n";

static void write_text(const char *name, const char *text) {
    FILE *file = fopen(in_folder(name), "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static int make_all(void **state) {
    if (make_folder(state) != 0) return -1;
    write_text("cinema.ocio", cinema);
    write_text("shown.json", display);
    free(glint_ok("sample", "street", "--light=1", "--size", "96x54", "--cube-size", "16", "-o",
                  in_folder("street.exr")));
    return 0;
}

/* R G B of a part, floats. */
static float *read_part(const char *path, const char *name, uint32_t *width) {
    static const char *const channels[] = {"R", "G", "B"};
    struct glint_error err = {0};
    struct glint_exr *exr = glint_exr_open(path, NULL, &err);
    if (!exr) fail_msg("%s", err.message);
    for (size_t i = 0; i < glint_exr_part_count(exr); i++) {
        const struct glint_exr_part_info *part = glint_exr_part(exr, i);
        if (strcmp(part->name, name) != 0) continue;
        float *values = malloc((size_t)part->width * part->height * 3 * sizeof *values);
        assert_non_null(values);
        *width = part->width;
        if (!glint_exr_read(exr, i, channels, 3, GLINT_F32, values, 0, &err)) fail_msg("%s", err.message);
        glint_exr_close(&exr);
        return values;
    }
    fail_msg("%s: no part %s", path, name);
    return NULL;
}
static float *read_image(const char *run, const char *slot, const char *image) {
    char pattern[600];
    glob_t found;
    uint32_t width;
    snprintf(pattern, sizeof pattern, "%s/*-%s.exr", run, slot);
    assert_int_equal(glob(pattern, 0, NULL, &found), 0);
    float *values = read_part(found.gl_pathv[0], image, &width);
    globfree(&found);
    assert_int_equal(width, WIDE);
    return values;
}

/* ---- How far a table may be off ---- */

struct table {
    float *values;
    size_t size;
};
static double entry(const struct table *t, const size_t at[3], size_t channel) {
    return (double)t->values[3 * (at[0] + t->size * (at[1] + t->size * at[2])) + channel];
}
/* The second difference along an axis, of the entries around one; 0 at the ends. */
static double bend(const struct table *t, const size_t at[3], size_t axis, size_t channel) {
    if (at[axis] == 0 || at[axis] + 1 == t->size) return 0;
    size_t before[3], behind[3];
    memcpy(before, at, sizeof before), memcpy(behind, at, sizeof behind);
    before[axis]--, behind[axis]++;
    return fabs(entry(t, before, channel) - 2 * entry(t, at, channel) + entry(t, behind, channel));
}

/* What is interpolated along an axis between two entries is off by h² f″ / 8 at most, an eighth of the second difference, where f is smooth, and by
   s (1 − s) of the change of its slope where it has a kink at s, of which the second differences of the two entries hold 1 − s and s: half of their
   sum, since s (1 − s) is a quarter at most, bounds both and leaves a factor of two and more for what f bends between the lines of entries. The three
   axes add up; of each the four edges of the cell count. */
static double bound_at(const struct table *t, const double place[3], size_t channel) {
    size_t low[3];
    double sum = 0;
    for (size_t k = 0; k < 3; k++) {
        const double at = place[k] * (double)(t->size - 1);
        low[k] = at < (double)(t->size - 2) ? (size_t)at : t->size - 2;
    }
    for (size_t axis = 0; axis < 3; axis++) {
        double most = 0;
        for (size_t edge = 0; edge < 4; edge++) {
            const size_t others[2] = {(axis + 1) % 3, (axis + 2) % 3};
            size_t at[3] = {low[0], low[1], low[2]};
            at[others[0]] += edge & 1, at[others[1]] += edge >> 1;
            const double first = bend(t, at, axis, channel);
            at[axis]++;
            most = fmax(most, 0.5 * (first + bend(t, at, axis, channel)));
        }
        sum += most;
    }
    return sum;
}

/* ---- The pictures ---- */

struct found {
    double mean, worst,
        part; /* differences from the picture of glint view in 1/255, and the largest part of its bound */
};

static struct found compare(const char *view, const char *config, const char *size) {
    struct found f = {0};
    char run[512], table[512], png[512];
    struct table t;
    uint32_t width;
    snprintf(run, sizeof run, "%s", in_folder("run"));
    snprintf(table, sizeof table, "%s", in_folder("table.exr"));
    snprintf(png, sizeof png, "%s", in_folder("view.png"));
    free(glint_ok("set", in_folder("street.exr"), "--lut", view, "--ocio", config, "--lut-size", size, "-o", table,
                  "--overwrite"));
    free(glint_ok("validate", table));
    free(glint_ok("replay", table, "-p", in_folder("shown.json"), "--precision", "float", "--outputs", "exposed,graded",
                  "-o", run));
    free(glint_ok("view", run, "--image", "exposed", "--view", view, "--ocio", config, "--no-legend", "-o", png));
    t.values = read_part(table, "lut", &width);
    t.size = width;
    assert_int_equal(width, atoi(size));
    float *exposed = read_image(run, "exposure", "exposed"), *graded = read_image(run, "grade", "graded");
    struct pixels shown = read_png(png);
    assert_true(shown.width == WIDE && shown.height == HIGH);
    for (size_t i = 0; i < PIXELS; i++) {
        double place[3];
        for (size_t k = 0; k < 3; k++)
            place[k] = fmin((log2(fmax((double)exposed[3 * i + k], 0) + exp2(LOW)) - LOW) / (HIGHEST - LOW), 1);
        for (size_t k = 0; k < 3; k++) {
            const double off = fabs(255 * (double)graded[3 * i + k] - shown.rgb[3 * i + k]);
            const double bound = 0.5 + 255 * (bound_at(&t, place, k) +
                                              1e-4); /* rounded to a byte; exp and log of OpenColorIO's processor */
            f.mean += off / (3.0 * PIXELS);
            f.worst = fmax(f.worst, off);
            f.part = fmax(f.part, off / bound);
        }
    }
    free(t.values), free(exposed), free(graded), free(shown.rgb);
    print_message("# %s, %s entries: off by %.3f / 255 in the mean, %.2f at most, %.2f of the bound\n", view, size,
                  f.mean, f.worst, f.part);
    return f;
}

/* A byte alone is off by 0.25 in the mean. The error of interpolation falls with the square of the distance of entries: from 16 to 64 of them in a
   row it is a sixteenth, of which a quarter is asked for. Without a tone curve light is cut off at 1, where sRGB has a slope of 0.44 by the natural logarithm:
   between two entries, 0.184 of it apart, a quarter of 0.081 is missing, 5.2 / 255, and half a byte. */
static void grade_shows_what_view_does(void **state) {
    (void)state;
    static const char *const views[] = {"ACES", "cinema", "sRGB"};
    for (size_t v = 0; v < 3; v++) {
        char config[512];
        snprintf(config, sizeof config, "%s", v == 1 ? in_folder("cinema.ocio") : GLINT_OCIO);
        const struct found few = compare(views[v], config, "17"), many = compare(views[v], config, "65");
        assert_true(few.part <= 1 && many.part <= 1);
        assert_true(many.mean < 0.4 && many.worst < (v == 2 ? 5.7 : 3));
        assert_true(many.mean - 0.25 < (few.mean - 0.25) / 4);
    }
}

/* Another table takes the place of one that is there, and all else of the capture keeps its bits. */
static void a_table_is_replaced(void **state) {
    (void)state;
    char tables[2][512];
    float *values[2];
    uint32_t width;
    for (int i = 0; i < 2; i++) {
        snprintf(tables[i], sizeof tables[i], "%s", in_folder(i ? "second.exr" : "first.exr"));
        free(glint_ok("set", i ? tables[0] : in_folder("street.exr"), "--lut", i ? "sRGB" : "ACES", "--lut-size", "9",
                      "--lut-stops", i ? "-8,6" : "-9,5", "-o", tables[i]));
        free(glint_ok("validate", tables[i]));
        values[i] = read_part(tables[i], "lut", &width);
        assert_int_equal(width, 9);
        assert_true(values[i][0] < 1e-3F && values[i][3 * 728] > 0.99F); /* black, and light above white */
    }
    assert_true(memcmp(values[0], values[1], 3 * 729 * sizeof *values[0]) != 0);
    float *before = read_part(in_folder("street.exr"), "lit", &width), *after = read_part(tables[1], "lit", &width);
    assert_memory_equal(before, after, 3 * PIXELS * sizeof *before);
    struct glint_error err = {0};
    struct glint_capture *capture = glint_capture_open(tables[1], NULL, &err);
    if (!capture) fail_msg("%s", err.message);
    const struct glint_frame *frame = glint_capture_frame(capture);
    assert_true(frame->has_lut_stops && frame->lut_stops[0] == -8 && frame->lut_stops[1] == 6);
    glint_capture_close(&capture);
    free(values[0]), free(values[1]), free(before), free(after);
}

static void what_cannot_be_made_is_refused(void **state) {
    (void)state;
    char from[512], out[512];
    snprintf(from, sizeof from, "%s", in_folder("street.exr"));
    snprintf(out, sizeof out, "%s", in_folder("none.exr"));
    glint_fails(2, "there is no view ACS (did you mean ACES?)", "set", from, "--lut", "ACS", "-o", out);
    glint_fails(2, "two increasing numbers from -64 to 64", "set", from, "--lut", "ACES", "--lut-stops", "3,3", "-o",
                out);
    glint_fails(2, "lut-size", "set", from, "--lut", "ACES", "--lut-size", "1", "-o", out);
    glint_fails(2, "are for --lut", "set", from, "up=+z", "--ocio", GLINT_OCIO, "-o", out);
    assert_false(file_exists(out));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(grade_shows_what_view_does),
                                       cmocka_unit_test(a_table_is_replaced),
                                       cmocka_unit_test(what_cannot_be_made_is_refused)};
    return cmocka_run_group_tests_name("cli_lut", tests, make_all, remove_folder);
}

/* The group "functions": one shader that evaluates every function, one capture that holds the arguments. */
#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/functions/function_case.h"
#include "cases/groups.h"
#include "cases/images/image_case_lists.h"
#include "harness/texture_filter.h"

enum { COLUMNS = 256, LISTS = 7, IMAGE_LISTS = 7 };

static const struct function_list *const lists[LISTS] = {
    &functions_elementary, &functions_patterns, &functions_geometry, &functions_lobes,
    &functions_hemisphere, &functions_light,    &functions_sun};

static const struct image_list *const image_lists[IMAGE_LISTS] = {
    &images_surfaces, &images_lists, &images_cubes, &images_planes, &images_texture_filter, &images_shown, &decodings};

static size_t tabled(void) {
    size_t sum = 0;
    for (size_t i = 0; i < LISTS; i++) sum += lists[i]->count;
    return sum;
}
static size_t functions_count(void) {
    size_t sum = tabled();
    for (size_t i = 0; i < IMAGE_LISTS; i++) sum += image_lists[i]->count;
    return sum;
}

static const struct function *function(size_t i) {
    size_t list = 0;
    while (i >= lists[list]->count) i -= lists[list++]->count;
    return &lists[list]->items[i];
}

static const struct image_case *image_case(size_t i) {
    size_t list = 0;
    while (i >= image_lists[list]->count) i -= image_lists[list++]->count;
    return &image_lists[list]->items[i];
}

static struct glint_selftest_case functions_get(size_t i) {
    if (i >= tabled()) return image_case(i - tabled())->about;
    const struct function *f = function(i);
    return (struct glint_selftest_case){f->name,  f->what,  f->glsl, f->measure == ULP ? "ULP" : "absolute",
                                        f->bound, f->reason};
}

/* ---- Arguments ---- */

static size_t list_ends(const struct axis *axis, double ends[8]) {
    size_t n = 0;
    ends[n++] = axis->low;
    ends[n++] = axis->high;
    if (axis->more & ENDLESS) ends[n++] = INFINITY;
    for (size_t i = 0, positive = n; (axis->more & NEGATIVE) && i < positive; i++) ends[n++] = -ends[i];
    if (axis->more & ZERO) ends[n++] = 0;
    return n;
}

static double axis_value(const struct axis *axis, double u) {
    double sign = 1;
    if (axis->more & NEGATIVE) {
        sign = u < 0.5 ? -1 : 1;
        u = fmod(2 * u, 1);
    }
    if (axis->scale == LOG) return sign * axis->low * pow(axis->high / axis->low, u);
    if (axis->scale == WHOLE) return sign * floor(axis->low + (axis->high - axis->low + 1) * u);
    return sign * (axis->low + (axis->high - axis->low) * u);
}

/* All combinations of the ends, or an even selection that fills half of the table, and then points of a lattice that is dense in every axis. */
static void fill_arguments(const struct function *f, size_t i, size_t points, float x[ARGUMENTS]) {
    static const double steps[ARGUMENTS] = {1.4142135623730951, 1.7320508075688772, 2.23606797749979,
                                            2.6457513110645907, 3.3166247903554,    3.605551275463989,
                                            4.123105625617661,  4.358898943540674};
    size_t corners = 1;
    double ends[8];
    for (size_t k = 0; k < ARGUMENTS && f->axes[k].scale; k++) corners *= list_ends(&f->axes[k], ends);
    const size_t shown = corners < points / 2 ? corners : points / 2;
    size_t corner = i < shown ? i * corners / shown : 0;
    memset(x, 0, ARGUMENTS * sizeof *x);
    for (size_t k = 0; k < ARGUMENTS && f->axes[k].scale; k++) {
        const size_t n = list_ends(&f->axes[k], ends);
        x[k] = (float)(i < shown ? ends[corner % n] : axis_value(&f->axes[k], fmod((double)(i + 1) * steps[k], 1)));
        corner /= n;
    }
    if (f->make) f->make(x);
}

/* ---- The shader that the device runs instead of compose/brdf, which reads the eight floats of each pixel unchanged ---- */

static const char head[] = "#version 460\n"
                           "#extension GL_GOOGLE_include_directive : require\n"
                           "#extension GL_EXT_samplerless_texture_functions : require\n"
                           "#include \"shared/bindings.glsl\"\n"
                           "#include \"brdf.pass.h\"\n"
                           "#include \"shared/push_begin.glsl\"\n"
                           "#include \"brdf.pass.h\"\n"
                           "};\n";
static const char *const shared[] = {"constants", "stable",   "random",      "bayer",       "blue_noise",   "brdf",
                                     "camera",    "cone",     "cube_filter", "cubemap",     "edges",        "facet",
                                     "fog",       "sampling", "levels",      "cube_chain",  "paraboloid",   "plus",
                                     "reuse",     "steps",    "hemisphere",  "light_terms", "light_volume", "sun",
                                     "luminance", "froxels"};
static const char helpers[] = "mat2x3 frame_of(vec3 n) { vec3 t, b; tangent_frame(n, t, b); return mat2x3(t, b); }\n"
                              "vec4 words(uvec4 v) { uvec2 w = v.xz ^ v.yw; return vec4(w.x >> 16u, w.x & 0xFFFFu, "
                              "w.y >> 16u, w.y & 0xFFFFu); }\n";
static const char helpers_of_cubes[] =
    "vec4 on_face(vec3 d) { CubeTaps taps = cube_taps(d, 8.0); vec4 sum = vec4(0.0);\n"
    "    for (int i = 0; i < 4; ++i) sum += taps.weight[i] * vec4(taps.direction[i], 1.0);\n"
    "    return sum; }\n";
static const char tail[] =
    "    return y;\n" /* a single return, since devices may nest code after a return and limit the nesting depth */
    "}\n"
    "void main() {\n"
    "    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);\n"
    "    if (any(greaterThanEqual(pixel, imageSize(composed)))) return;\n"
    "    vec4 b = vec4(texelFetch(lit, pixel, 0).rgb, texelFetch(specular_full, pixel, 0).x);\n"
    "    imageStore(composed, pixel, evaluate(pixel.y / ROWS, texelFetch(albedo_full, pixel, 0), b));\n"
    "}\n";

static bool write_shader(const bool *selected, size_t rows, const char *path, struct glint_error *err) {
    char *text = NULL;
    size_t size = 0, row = 0;
    FILE *file = open_memstream(&text, &size);
    if (!file) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    fputs(head, file);
    for (size_t i = 0; i < sizeof shared / sizeof *shared; i++)
        fprintf(file, "#include \"shared/%s.glsl\"\n", shared[i]);
    fputs(helpers, file);
    fputs(helpers_of_cubes, file);
    fprintf(file, "const int ROWS = %zu;\nvec4 evaluate(int number, vec4 a, vec4 b) {\n    vec4 y = vec4(0.0);\n",
            rows);
    for (size_t i = 0; i < tabled(); i++)
        if (selected[i]) fprintf(file, "    if (number == %zu) y = vec4(%s);\n", row++, function(i)->glsl);
    fputs(tail, file);
    bool ok =
        fclose(file) == 0 ? case_write_text(path, text, err) : glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    free(text);
    return ok;
}

static bool add_part(struct glint_writer *writer, const char *name, const char *const *channels, size_t n,
                     float *const *planes, uint32_t height, struct glint_error *err) {
    struct glint_channel list[12] = {{0}};
    for (size_t k = 0; k < n; k++)
        list[k] = (struct glint_channel){.name = channels[k], .type = GLINT_F32, .data = planes[k]};
    return glint_writer_add_part(
        writer,
        &(struct glint_part){.name = name, .width = COLUMNS, .height = height, .channels = list, .channel_count = n},
        err);
}

static bool write_parts(struct glint_writer *writer, float *const *x, float *zero, float *one, uint32_t height,
                        struct glint_error *err) {
    static const char *const gbuffer[] = {
        "albedo.R", "albedo.G", "albedo.B", "material.metalness", "material.specular", "depth.Z",
        "normal.X", "normal.Y", "normal.Z", "material.roughness", "motion.X",          "motion.Y"};
    static const char *const colors[] = {"R", "G", "B", "A"};
    struct glint_frame frame = {.number = 1};
    const double near = 0.1, far = 1000;
    for (int i = 0; i < 4; i++) frame.camera.world_to_view[5 * i] = 1;
    frame.camera.view_to_clip[0] = frame.camera.view_to_clip[5] = 1;
    frame.camera.view_to_clip[10] = far / (near - far);
    frame.camera.view_to_clip[11] = near * far / (near - far);
    frame.camera.view_to_clip[14] = -1;
    float *const surface[] = {x[0], x[1], x[2], x[3], x[7], one, zero, zero, one, one, zero, zero};
    float *const none[] = {zero, zero, zero, zero};
    return glint_writer_set_frame(writer, &frame, err) &&
           add_part(writer, "gbuffer", gbuffer, 12, surface, height, err) &&
           add_part(writer, "lit", colors, 3, x + 4, height, err) &&
           add_part(writer, "engine.upscale.reflection", colors, 4, none, height, err) &&
           glint_writer_finish(writer, err);
}

static bool write_capture(const char *path, float *const *x, uint32_t height, struct glint_error *err) {
    const size_t texels = (size_t)COLUMNS * height;
    float *zero = calloc(2 * texels, sizeof *zero), *one = zero ? zero + texels : NULL;
    struct glint_writer *writer =
        glint_writer_create(path, &(struct glint_writer_options){.compression = GLINT_NONE}, err);
    for (size_t i = 0; one && i < texels; i++) one[i] = 1;
    bool ok = one ? writer && write_parts(writer, x, zero, one, height, err)
                  : glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    glint_writer_destroy(&writer);
    free(zero);
    return ok;
}

static bool evaluate_table(const struct case_context *context, const char *capture_path, const char *shader,
                           const char *preset, float *out, struct glint_error *err) {
    static const char *const passes[] = {"compose", NULL}, *const outputs[] = {"composed", NULL};
    const struct glint_replay_options options = {
        .passes = passes, .outputs = outputs, .all = true, .float_precision = true};
    char assignment[4200];
    snprintf(assignment, sizeof assignment, "compose=%s", shader);
    struct glint_capture *capture = glint_capture_open(capture_path, NULL, err);
    struct glint_replay *replay = capture ? glint_replay_create(context->device, err) : NULL;
    struct glint_pipeline *pipeline = replay ? glint_pipeline_create(preset, err) : NULL;
    bool ok = pipeline && glint_pipeline_shader(pipeline, assignment, err) && glint_replay_load(replay, capture, err) &&
              glint_replay_run(replay, pipeline, &options, context->progress, context->user, err);
    const struct glint_image *image = ok ? glint_replay_find_image(replay, "composed") : NULL;
    if (ok && !image) ok = glint_fail(err, GLINT_ERROR_DEVICE, "self-test: the replay made no image");
    ok = ok && glint_replay_read_image(replay, image, GLINT_F32, out, err);
    glint_pipeline_destroy(&pipeline);
    glint_replay_destroy(&replay);
    glint_capture_close(&capture);
    return ok;
}

/* ---- Errors ---- */

/* The last place of a float of this size. Below the smallest normal number a device may flush to 0. */
static double last_place(double value) {
    int exponent;
    frexp(fmax(fabs(value), (double)FLT_MIN), &exponent);
    return ldexp(1, exponent - 24);
}

static double error_of(const struct function *f, double found, double expected) {
    if (fabs(expected) > (double)FLT_MAX) expected = copysign(INFINITY, expected);
    if (found == expected || (isnan(found) && isnan(expected))) return 0;
    if (!isfinite(found) || !isfinite(expected)) return INFINITY;
    const double error = fabs(found - expected);
    if (f->measure == ABSOLUTE) return error;
    return fabs(expected) < (double)FLT_MIN && error < (double)FLT_MIN ? 0 : error / last_place(expected);
}

static double nearer(double error, double other) {
    return error <= other ? error : other;
}

static void describe(const struct function *f, const float *x, int value, double found, double expected, char at[320]) {
    size_t used = 0, k = 0;
    for (const char *name = f->names; *name && k < ARGUMENTS; k++) {
        const int length = (int)strcspn(name, " ");
        used += (size_t)snprintf(at + used, 320 - used, "%s%.*s %.9g", k ? ", " : "", length, name, (double)x[k]);
        if (used >= 320) return;
        name += length + (name[length] == ' ');
    }
    if (f->values > 1) used += (size_t)snprintf(at + used, 320 - used, ", value %d", value);
    if (used < 320) snprintf(at + used, 320 - used, ": found %.9g, expected %.9g", found, expected);
}

static void compare_values(const struct function *f, const float x[ARGUMENTS], const float found[VALUES],
                           struct glint_selftest_finding *finding) {
    double exact[ARGUMENTS], normal[ARGUMENTS], expected[VALUES] = {0}, flushed[VALUES] = {0};
    for (int k = 0; k < ARGUMENTS; k++) {
        exact[k] = (double)x[k];
        normal[k] = fabs(exact[k]) < (double)FLT_MIN ? 0 : exact[k];
    }
    f->expect(exact, expected);
    f->expect(normal, flushed); /* Vulkan permits devices to treat denormals as 0 */
    for (int k = 0; k < f->values; k++) {
        const double error =
            nearer(error_of(f, (double)found[k], expected[k]), error_of(f, (double)found[k], flushed[k]));
        if (error > finding->worst || !finding->values) {
            finding->worst = error;
            describe(f, x, k, (double)found[k], expected[k], finding->at);
        }
        finding->values++;
    }
}

static bool run_tables(const struct case_context *context, const bool *selected,
                       struct glint_selftest_finding *findings, struct glint_error *err) {
    static const char preset[] = "{\"name\": \"selftest\", \"title\": \"Functions\", \"source\": \"glint\", "
                                 "\"slots\": {\"upscale\": \"bilinear\", \"compose\": \"brdf\"}, \"set\": {}}\n";
    char paths[3][4096];
    static const char *const names[3] = {"functions.exr", "functions.comp", "functions.json"};
    for (int i = 0; i < 3; i++) snprintf(paths[i], sizeof paths[i], "%s/%s", context->folder, names[i]);
    size_t cases = 0, place = 0;
    for (size_t i = 0; i < tabled(); i++) cases += selected[i];
    if (!cases) return true;
    const size_t rows = context->quick ? 4 : 64, points = rows * COLUMNS, texels = cases * points;
    float *x[ARGUMENTS] = {NULL}, *all = calloc(texels * (ARGUMENTS + VALUES), sizeof *all);
    if (!all) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t k = 0; k < ARGUMENTS; k++) x[k] = all + k * texels;
    float *out = all + ARGUMENTS * texels, one[ARGUMENTS];
    for (size_t i = 0; i < tabled(); i++)
        for (size_t p = 0; selected[i] && p < points; p++, place++) {
            fill_arguments(function(i), p, points, one);
            for (size_t k = 0; k < ARGUMENTS; k++) x[k][place] = one[k];
        }
    bool ok = write_shader(selected, rows, paths[1], err) && case_write_text(paths[2], preset, err) &&
              write_capture(paths[0], x, (uint32_t)(cases * rows), err) &&
              evaluate_table(context, paths[0], paths[1], paths[2], out, err);
    place = 0;
    for (size_t i = 0; ok && i < tabled(); i++)
        for (size_t p = 0; selected[i] && p < points; p++, place++) {
            for (size_t k = 0; k < ARGUMENTS; k++) one[k] = x[k][place];
            compare_values(function(i), one, out + VALUES * place, &findings[i]);
        }
    free(all);
    return ok;
}

static bool functions_run(const struct case_context *context, const bool *selected,
                          struct glint_selftest_finding *findings, struct glint_error *err) {
    struct frames frames = {0};
    bool ok = run_tables(context, selected, findings, err) && frames_begin(&frames, context, err);
    for (size_t i = tabled(); ok && i < functions_count(); i++) {
        const struct image_case *c = image_case(i - tabled());
        if (selected[i]) ok = c->check(&frames, c, &findings[i], err);
    }
    frames_end(&frames);
    return ok;
}

const struct case_group functions_group = {"functions", "shared shader functions, against double precision",
                                           functions_count, functions_get, functions_run};

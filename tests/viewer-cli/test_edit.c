/* set, crop and strip: every key reads back, rays and motion stay those of the pixels, the rest keeps its bits, and no input is harmed. */
#include "cli.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../capture-format/fixture.h"
#include "../capture-format/rewrite.h"

static char made[512], room[512];

/* The fixture with an unknown part, an attribute of an editor's, and engine parts of half and of another size. */
static void write_made(void) {
    static const uint32_t sizes[4][2] = {{FIX_W, FIX_H}, {FIX_W / 2, FIX_H / 2}, {FIX_CUBE, 6 * FIX_CUBE}, {7, 5}};
    static const char *const names[] = {"editor.overlay", "engine.a.half", "engine.a.cube", "engine.a.list"};
    static const struct glint_exr_attribute note = {
        .name = "editor.note", .type = GLINT_EXR_STRING, .string = "as found"};
    static struct fixture f;
    static struct rewrite r;
    struct glint_error err = {0};
    fixture_init(&f);
    if (!fixture_write(&f, made, FIXTURE_PARTS, NULL, &err)) fail_msg("%s", err.message);
    rewrite_load(&r, made);
    for (int i = 0; i < 4; i++) {
        struct rewrite_part *to = &r.parts[r.count++];
        *to = *rewrite_find(&r, "engine.screen_trace.anything");
        snprintf(to->name, sizeof to->name, "%s", names[i]);
        to->part.width = sizes[i][0], to->part.height = sizes[i][1];
        to->attributes[to->part.attribute_count++] = note;
        for (size_t c = 0; c < to->part.channel_count; c++) {
            const size_t bytes = (size_t)FIX_W * FIX_H * 4;
            void *copy = malloc(bytes);
            assert_non_null(copy);
            memcpy(copy, to->data[c], bytes);
            to->channels[c].data = to->data[c] = copy;
        }
    }
    unlink(made);
    rewrite_save(&r, made);
    rewrite_finish(&r);
}

static int make_captures(void **state) {
    if (make_folder(state) != 0) return -1;
    snprintf(made, sizeof made, "%s", in_folder("made.exr"));
    snprintf(room, sizeof room, "%s", in_folder("room.exr"));
    write_made();
    free(glint_ok("sample", "room", "-o", room, "--size", "96x64", "--cube-size", "32", "--truth", "2"));
    return 0;
}

/* ---- Comparing files ---- */

static struct glint_exr *open_exr(const char *path) {
    struct glint_error err = {0};
    struct glint_exr *exr = glint_exr_open(path, NULL, &err);
    if (!exr) fail_msg("%s", err.message);
    return exr;
}

static size_t part_index(const struct glint_exr *exr, const char *name) {
    size_t i = 0;
    while (glint_exr_part(exr, i) && strcmp(glint_exr_part(exr, i)->name, name) != 0) i++;
    return i;
}

static void *stored(struct glint_exr *exr, size_t part, const char *channel, enum glint_stored as) {
    static const enum glint_type types[] = {GLINT_F16, GLINT_F32, GLINT_U32};
    const struct glint_exr_part_info *info = glint_exr_part(exr, part);
    struct glint_error err = {0};
    void *data = malloc((size_t)info->width * info->height * 4 + 1);
    assert_non_null(data);
    if (!glint_exr_read(exr, part, &channel, 1, types[as], data, 0, &err)) fail_msg("%s", err.message);
    return data;
}

static bool same_attribute(const struct glint_exr_attribute *a, const struct glint_exr_attribute *b) {
    if (!b || a->type != b->type || strcmp(a->type_name, b->type_name) != 0 || a->count != b->count) return false;
    if (a->type == GLINT_EXR_STRING) return !strcmp(a->string, b->string);
    for (size_t i = 0; a->type == GLINT_EXR_STRINGS && i < a->count; i++)
        if (strcmp(a->strings[i], b->strings[i]) != 0) return false;
    if (a->type == GLINT_EXR_OPAQUE) return !memcmp(a->bytes, b->bytes, a->count);
    return a->type == GLINT_EXR_STRINGS || !memcmp(a->numbers, b->numbers, a->count * sizeof *a->numbers);
}

/* Every channel and attribute of the copy is as in the original, pixel by pixel from (x, y) on; `but` names a channel and an attribute that
   may differ, or is NULL. Returns the number of compared channels. */
static size_t expect_same(const char *original, const char *copy, uint32_t x0, uint32_t y0, const char *but) {
    struct glint_exr *a = open_exr(original), *b = open_exr(copy);
    size_t compared = 0;
    for (size_t p = 0; glint_exr_part(b, p); p++) {
        const struct glint_exr_part_info *to = glint_exr_part(b, p);
        const size_t from_part = part_index(a, to->name);
        const struct glint_exr_part_info *from = glint_exr_part(a, from_part);
        assert_non_null(from);
        const bool moved = from->width != to->width || from->height != to->height;
        const uint32_t ratio = from->width < FIX_W && from->width > FIX_CUBE ? 2 : 1; /* the engine's half resolution */
        for (size_t i = 0; i < to->attribute_count; i++)
            if (!but || !strstr(but, to->attributes[i].name))
                if (!same_attribute(&to->attributes[i], glint_exr_attribute(from, to->attributes[i].name)))
                    fail_msg("%s: %s differs", to->name, to->attributes[i].name);
        for (size_t c = 0; c < to->channel_count; c++) {
            const char *name = to->channels[c].name;
            if (but && strstr(but, name)) continue;
            const enum glint_stored as = to->channels[c].stored;
            uint8_t *left = stored(a, from_part, name, as), *right = stored(b, p, name, as);
            const size_t bytes = as == GLINT_STORED_HALF ? 2 : 4;
            const size_t dx = moved ? x0 / ratio : 0, dy = moved ? y0 / ratio : 0;
            for (size_t y = 0; y < to->height; y++)
                if (memcmp(left + ((y + dy) * from->width + dx) * bytes, right + y * to->width * bytes,
                           to->width * bytes))
                    fail_msg("%s: %s differs in line %zu", to->name, name, y);
            free(left);
            free(right);
            compared++;
        }
    }
    glint_exr_close(&a);
    glint_exr_close(&b);
    return compared;
}

/* ---- set ---- */

/* A value that the key takes and that is not its default. */
static const char *value_of(const char *key, const char *form) {
    static const struct {
        const char *key, *value;
    } values[] = {
        /* a quarter turn about y, and a projection with near at 1 as the depth of the fixture has it */
        {"worldToView", "0,0,-1,0.5,0,1,0,-1.5,1,0,0,2.25,0,0,0,1"},
        {"previousWorldToView", "0,0,-1,0.25,0,1,0,-1.5,1,0,0,2.25,0,0,0,1"},
        {"viewToClip", "1.5,0,0.0625,0,0,2.5,-0.125,0,0,0,0,0.1,0,0,-1,0"},
        {"previousViewToClip", "1.25,0,0.0625,0,0,2.5,-0.125,0,0,0,0,0.1,0,0,-1,0"},
        {"frame", "4000000000"},
        {"stencilClasses", "3/7=foreground,16/0=sky"},
        {"hull", "1,0,0,-2,-1,0,0,-2,0,1,0,-2,0,-1,0,-2,0,0,1,-2"},
        {"plane", "0,1,0,-0.75"},
        {"boxMin", "-1,-2,-3"},
        {"fade", "0.25"},
        {"storage", "depth.Z=D24"},
        {"normal", "unorm"}, /* the fixture's normals have a Z */
        {"vertexNormal", "unorm"},
        {"depth", "view_linear"}, /* the other encodings depend on the projection and have their own test */
        {"motion", "pixels"},     /* packed16 is for uint channels */
        {"motionDepth", "view_linear"},
        {"inner", "box"},
    };
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        if (!strcmp(values[i].key, key)) return values[i].value;
    if (!strcmp(form, "0 or 1") || !strcmp(form, "a whole number")) return "1";
    if (!strcmp(form, "a number")) return "2.5";
    if (!strcmp(form, "2 numbers")) return "0.25,-0.125";
    if (!strcmp(form, "3 numbers")) return "1.5,2.25,3.125";
    /* the last of a list of names */
    return strrchr(form, ' ') ? strrchr(form, ' ') + 1 : form;
}

/* The attribute's text as it was set, from the file. */
static void expect_attribute(const struct glint_exr_part_info *part, const char *name, const char *value) {
    const struct glint_exr_attribute *a = glint_exr_attribute(part, name);
    char *end, *copy = strdup(value), *rest = copy, *item;
    if (!a) fail_msg("%s: %s is missing", part->name, name);
    if (a->type == GLINT_EXR_STRING) assert_string_equal(a->string, value);
    else if (a->type == GLINT_EXR_STRINGS) {
        size_t found = 0, count = 0;
        while ((item = strsep(&rest, ",")) != NULL) {
            count++;
            for (size_t i = 0; i < a->count; i++) found += !strcmp(a->strings[i], item);
        }
        assert_int_equal(found, count);
    } else
        for (size_t i = 0; (item = strsep(&rest, ",")) != NULL; i++) {
            assert_true(i < a->count);
            const double expected = strtod(item, &end);
            assert_true(a->numbers[i] == (a->type == GLINT_EXR_INT ? (int32_t)(uint32_t)expected : expected));
        }
    free(copy);
}

static void every_key_reads_back(void **state) {
    (void)state;
    char *text = glint_ok("set", "--list", "--json");
    json_t *json = parse_json(text);
    const json_t *keys = json_object_get(json, "keys"), *key;
    size_t i, set = 0;
    json_array_foreach(keys, i, key) {
        const char *name = json_string_value(json_object_get(key, "key")),
                   *on = json_string_value(json_object_get(key, "on")),
                   *value = value_of(name, json_string_value(json_object_get(key, "value")));
        const char *part = !strncmp(on, "cubemap", 7)  ? "cubemap.017"
                           : !strncmp(on, "planar", 6) ? "planar.002"
                                                       : "gbuffer";
        const bool color = !strcmp(name, "color"), hull = !strcmp(name, "hull"), box = !strncmp(name, "box", 3);
        char setting[400], attribute[80], full[400];
        if (color) part = "lit";
        snprintf(setting, sizeof setting, "%s:%s=%s", part, name, value);
        snprintf(attribute, sizeof attribute, "glint.%s%s", name, hull ? ".00" : "");
        /* a box needs both corners */
        snprintf(full, sizeof full, "%s:boxMax=4,5,6", part);
        if (box || !strcmp(name, "inner"))
            free(glint_ok("set", made, full, "cubemap.017:boxMin=-1,-2,-3", setting, "-o", in_folder("set.exr")));
        else free(glint_ok("set", made, setting, "-o", in_folder("set.exr")));
        struct glint_exr *exr = open_exr(in_folder("set.exr"));
        const struct glint_exr_part_info *info = glint_exr_part(exr, part_index(exr, part));
        char first[400];
        snprintf(first, sizeof first, "%s", value);
        if (hull) { /* four planes an attribute */
            expect_attribute(info, "glint.hull.01", "0,0,1,-2,0,0,0,0");
            *(strstr(first, ",0,0,1,-2")) = '\0';
        }
        expect_attribute(info, attribute, first);
        glint_exr_close(&exr);
        /* what was set, and what had to be set with it */
        char changed[400];
        snprintf(changed, sizeof changed, "%s glint.hull.01 glint.boxMin glint.boxMax glint.fade glint.inner",
                 attribute);
        expect_same(made, in_folder("set.exr"), 0, 0, changed);
        set++;
    }
    assert_true(set > 40);
    json_decref(json);
    free(text);
}

static void depth_is_declared_and_removed(void **state) {
    (void)state;
    struct glint_error err = {0};
    free(glint_ok("set", made, "depth=logarithmic", "depthNear=0.1", "depthFar=500", "editor.note=changed", "-o",
                  in_folder("set.exr")));
    struct glint_capture *capture = glint_capture_open(in_folder("set.exr"), NULL, &err);
    assert_non_null(capture);
    assert_int_equal(glint_capture_find(capture, "gbuffer")->encodings.depth, GLINT_DEPTH_LOGARITHMIC);
    assert_int_equal(glint_capture_find(capture, "previous.gbuffer")->encodings.depth, GLINT_DEPTH_LOGARITHMIC);
    assert_string_equal(glint_capture_find(capture, "editor.overlay")->attributes[0].string, "changed");
    glint_capture_close(&capture);
    free(glint_ok("set", in_folder("set.exr"), "depth=", "glint.depthNear=", "-o", in_folder("again.exr")));
    capture = glint_capture_open(in_folder("again.exr"), NULL, &err);
    assert_non_null(capture);
    assert_int_equal(glint_capture_find(capture, "gbuffer")->encodings.depth, GLINT_DEPTH_VIEW_LINEAR);
    assert_true(glint_capture_frame(capture)->depth_near == 0);
    glint_capture_close(&capture);
}

/* set may repair what no reader accepts. */
static void a_broken_capture_is_repaired(void **state) {
    (void)state;
    static struct rewrite r;
    rewrite_load(&r, made);
    rewrite_remove_attribute(&r, "cubemap.000", "glint.center");
    rewrite_save(&r, in_folder("broken.exr"));
    rewrite_finish(&r);
    glint_fails(1, "glint.center", "info", in_folder("broken.exr"));
    glint_fails(1, "glint.center", "set", in_folder("broken.exr"), "frame=3", "-o", in_folder("set.exr"));
    free(glint_ok("set", in_folder("broken.exr"), "cubemap.000:center=1,2,3", "-o", in_folder("set.exr")));
    free(glint_ok("info", in_folder("set.exr")));
}

static void bad_values_are_refused(void **state) {
    (void)state;
    static const struct {
        int status;
        const char *setting, *text;
    } bad[] = {
        {2, "metresPrUnit=1", "did you mean metresPerUnit?"},
        {2, "gbufer:depth=reversed", "did you mean gbuffer?"},
        {2, "depth=inverted", "expected one of view_linear, device"},
        {2, "sky:depth=reversed", "no part sky"},
        {2, "jitter=1", "expected 2 numbers"},
        {2, "jitter=1,2,3", "expected 2 numbers"},
        {2, "jitter=1,2x", "expected 2 numbers"},
        {2, "frame=-1", "expected a whole number"},
        {2, "frame=1e300", "expected a whole number"},
        {2, "cut=2", "expected 0 or 1"},
        {2, "hull=1,2,3", "expected 4 numbers"},
        {2, "storage=depth.Q=D24", "no part"},
        {2, "gbuffer:storage=depth.Z=", "channel=format"},
        {1, "metresPerUnit=0", "value in range"},
        {1, "metresPerUnit=nan", "finite"},
        {1, "exposure=inf", "finite"},
        {1, "cubemap:fade=1.5", "value in range"},
        {1, "worldToView=2,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1", "rotation"},
        {1, "viewToClip=1,0,0,0,0,1,0,0,0,0,0,0,0,0,-1,0", "invertible"},
        {1, "viewToClip=", "missing"},
        {1, "stencilClasses=a/b=c", "value/mask=name"},
        {1, "cubemap.017:inner=sphere", "sphereRadius"},
        {1, "normal=octahedral", "no Z"},
        {1, "depthNear=-1", "value in range"},
        {1, "fogColor=-1,0,0", "value in range"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        glint_fails(bad[i].status, bad[i].text, "set", made, bad[i].setting, "-o", in_folder("none.exr"));
        assert_false(file_exists(in_folder("none.exr")));
    }
    glint_fails(2, "expected KEY=VALUE", "set", made, "frame", "-o", in_folder("none.exr"));
    glint_fails(2, "no output", "set", made, "frame=1");
    glint_fails(2, "nothing to set", "set", made, "-o", in_folder("none.exr"));
}

/* ---- strip ---- */

static size_t part_count(const char *path) {
    struct glint_exr *exr = open_exr(path);
    const size_t count = glint_exr_part_count(exr);
    glint_exr_close(&exr);
    return count;
}

static bool has(const char *path, const char *part, const char *channel) {
    struct glint_exr *exr = open_exr(path);
    const struct glint_exr_part_info *info = glint_exr_part(exr, part_index(exr, part));
    bool found = info && !channel;
    for (size_t c = 0; info && channel && c < info->channel_count; c++)
        found |= !strcmp(info->channels[c].name, channel);
    glint_exr_close(&exr);
    return found;
}

static void strip_keeps_bits(void **state) {
    (void)state;
    const char *out = in_folder("strip.exr");
    free(glint_ok("strip", made, "--keep", "gbuffer,lit", "-o", out));
    assert_int_equal(part_count(out), 2);
    assert_int_equal(expect_same(made, out, 0, 0, NULL), 17 + 3);
    free(glint_ok("strip", made, "--keep", "gbuffer:motion,cubemap", "-o", out));
    assert_int_equal(part_count(out), 4); /* lit stays, since every capture has it */
    assert_int_equal(expect_same(made, out, 0, 0, NULL), 10 + 3 + 3 + 2 * 5);
    free(glint_ok("strip", made, "--drop", "previous,cubemap:distance.Z,gbuffer:vertexNormal", "-o", out));
    assert_false(has(out, "previous.lit", NULL) || has(out, "cubemap.017", "distance.Z") ||
                 has(out, "gbuffer", "vertexNormal.X"));
    assert_true(has(out, "editor.overlay", NULL) && has(out, "cubemap.000", "R") && has(out, "gbuffer", "normal.X"));
    expect_same(made, out, 0, 0, NULL);
    free(glint_ok("validate", out));
    struct outcome said = glint("strip", made, "--drop", "water", "-o", out, NULL);
    assert_contains(said.err, "left out: water");
    outcome_free(&said);
}

static void wrong_names_are_refused(void **state) {
    (void)state;
    const char *out = in_folder("none.exr");
    glint_fails(2, "did you mean water?", "strip", made, "--drop", "watr", "-o", out);
    glint_fails(2, "did you mean gbuffer:motion?", "strip", made, "--drop", "gbuffer:mottion", "-o", out);
    glint_fails(2, "every capture must have", "strip", made, "--drop", "lit", "-o", out);
    glint_fails(2, "must have this channel", "strip", made, "--drop", "gbuffer:normal", "-o", out);
    glint_fails(1, "motion.X", "strip", made, "--drop", "gbuffer:motion.X", "-o", out);
    glint_fails(2, "either --keep or --drop", "strip", made, "--keep", "lit", "--drop", "sky", "-o", out);
    assert_false(file_exists(out));
}

/* ---- crop ---- */

/* The position of a pixel's centre in view space at depth 1, from the decoded camera. */
static void ray_of(const struct glint_frame *frame, const struct glint_camera *camera, const uint32_t size[2], double x,
                   double y, double ray[2]) {
    const double *m = camera->view_to_clip, front = m[14] < 0 ? -1 : 1;
    const double down = frame->clip_y == GLINT_CLIP_Y_DOWN ? 1 : -1;
    ray[0] = (2 * (x + 0.5) / size[0] - 1 - m[2] * front) / m[0];
    ray[1] = (down * (2 * (y + 0.5) / size[1] - 1) - m[6] * front) / m[5];
}

/* Both cameras see every pixel of the rectangle along the same ray. The remaining difference is the rounding of doubles: a few units of the
   last place of a number of the size of 1. */
static void expect_rays(const char *from, const char *to, uint32_t x0, uint32_t y0) {
    struct glint_error err = {0};
    struct glint_capture *a = glint_capture_open(from, NULL, &err), *b = glint_capture_open(to, NULL, &err);
    if (!a || !b) fail_msg("%s", err.message);
    const struct glint_frame *f = glint_capture_frame(a), *g = glint_capture_frame(b);
    const struct glint_part_info *p = glint_capture_find(a, "gbuffer"), *q = glint_capture_find(b, "gbuffer");
    const uint32_t large[2] = {p->width, p->height}, small[2] = {q->width, q->height};
    for (uint32_t y = 0; y < small[1]; y++)
        for (uint32_t x = 0; x < small[0]; x++)
            for (int camera = 0; camera < 1 + f->has_previous; camera++) {
                double u[2], v[2];
                ray_of(f, camera ? &f->previous : &f->camera, large, x0 + x, y0 + y, u);
                ray_of(g, camera ? &g->previous : &g->camera, small, x, y, v);
                for (int i = 0; i < 2; i++) assert_true(fabs(u[i] - v[i]) <= 4e-15);
            }
    assert_memory_equal(f->camera.world_to_view, g->camera.world_to_view, sizeof f->camera.world_to_view);
    assert_memory_equal(f->jitter_px, g->jitter_px, sizeof f->jitter_px);
    glint_capture_close(&a);
    glint_capture_close(&b);
}

static const char camera_and_motion[] =
    "glint.viewToClip glint.previousViewToClip motion.X motion.Y glint.storage visible";

static void rays_stay(void **state) {
    (void)state;
    static const char *const rectangles[] = {"0,0,40,24", "4,2,20,12", "6,8,2,16", "38,22,2,2", "0,20,40,4"};
    static const char *const clip_y[] = {"clipY=up", "clipY=down"};
    for (int down = 0; down < 2; down++) {
        free(glint_ok("set", made, clip_y[down], "viewToClip=1.3,0,0.03,0,0,2.1,-0.07,0,0,0,0,0.1,0,0,-1,0",
                      "jitter=0.6,0.84", "-o", in_folder("jittered.exr")));
        for (size_t i = 0; i < sizeof rectangles / sizeof *rectangles; i++) {
            unsigned x, y, w, h;
            sscanf(rectangles[i], "%u,%u,%u,%u", &x, &y, &w, &h);
            free(glint_ok("crop", in_folder("jittered.exr"), rectangles[i], "-o", in_folder("crop.exr")));
            expect_rays(in_folder("jittered.exr"), in_folder("crop.exr"), x, y);
            expect_same(in_folder("jittered.exr"), in_folder("crop.exr"), x, y, camera_and_motion);
        }
    }
}

/* A decoded offset in pixels is the same, within the step of what is stored. */
static void motion_stays(void **state) {
    (void)state;
    static const char *const names[] = {"uv", "ndc", "pixels", "packed16"};
    static const char *const rectangles[] = {"16,8,48,32", "6,4,50,26"}; /* the same factor on both axes, and not */
    static const char *const channels[] = {"motion.X", "motion.Y"};
    struct glint_error err = {0};
    for (int e = 0; e < 8; e++) {
        const uint32_t x0 = e % 2 ? 6 : 16, y0 = e % 2 ? 4 : 8;
        free(glint_ok("sample", "room", "-o", in_folder("moving.exr"), "--size", "96x64", "--cube-size", "8",
                      "--motion", names[e / 2], "--travel", "0.1,0,0.05"));
        free(glint_ok("crop", in_folder("moving.exr"), rectangles[e % 2], "-o", in_folder("crop.exr")));
        struct glint_capture *a = glint_capture_open(in_folder("moving.exr"), NULL, &err),
                             *b = glint_capture_open(in_folder("crop.exr"), NULL, &err);
        if (!a || !b) fail_msg("%s", err.message);
        const struct glint_part_info *p = glint_capture_find(a, "gbuffer"), *q = glint_capture_find(b, "gbuffer");
        float *u = calloc((size_t)p->width * p->height * 2, sizeof *u),
              *v = calloc((size_t)p->width * p->height * 2, sizeof *v);
        assert_true(u && v && glint_capture_read(a, p, channels, 2, GLINT_F32, u, 0, &err) &&
                    glint_capture_read(b, q, channels, 2, GLINT_F32, v, 0, &err));
        double most = 0;
        for (uint32_t y = 0; y < q->height; y++)
            for (uint32_t x = 0; x < q->width; x++)
                for (uint32_t i = 0; i < 2; i++) {
                    const double before = (double)u[2 * ((size_t)(y0 + y) * p->width + x0 + x) + i] *
                                          (i ? p->height : p->width),
                                 after = (double)v[2 * ((size_t)y * q->width + x) + i] * (i ? q->height : q->width);
                    most = fmax(most, fabs(before));
                    assert_true(fabs(before - after) <= 4 * 0x1p-24 * fabs(before) + 1e-6); /* floats, added up */
                }
        assert_true(most > 0.5);
        free(u);
        free(v);
        glint_capture_close(&a);
        glint_capture_close(&b);
    }
}

static void other_sizes_are_cropped_by_their_ratio(void **state) {
    (void)state;
    struct outcome said = glint("crop", made, "4,2,20,12", "-o", in_folder("crop.exr"), NULL);
    assert_int_equal(said.status, 0);
    assert_contains(said.err, "engine.a.list: kept whole");
    outcome_free(&said);
    struct glint_exr *exr = open_exr(in_folder("crop.exr"));
    assert_int_equal(glint_exr_part(exr, part_index(exr, "engine.a.half"))->width, 10);
    assert_int_equal(glint_exr_part(exr, part_index(exr, "engine.a.half"))->height, 6);
    assert_int_equal(glint_exr_part(exr, part_index(exr, "engine.a.cube"))->height, 6 * FIX_CUBE);
    assert_int_equal(glint_exr_part(exr, part_index(exr, "editor.overlay"))->width, 20);
    glint_exr_close(&exr);
    glint_fails(2, "crop 4,2,18,10, or leave the part out", "crop", made, "5,3,17,9", "-o", in_folder("none.exr"));
    free(glint_ok("crop", made, "4,2,18,10", "-o", in_folder("crop.exr")));
}

static void wrong_rectangles_are_refused(void **state) {
    (void)state;
    static const char *const bad[] = {"0,0,0,4", "0,0,4,0", "40,0,1,1", "0,0,41,24", "39,0,2,24", "0,1048576,1,1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        glint_fails(2, "expected a rectangle within 40 x 24", "crop", made, bad[i], "-o", in_folder("none.exr"));
    glint_fails(2, "whole pixels", "crop", made, "0.5,0,4,4", "-o", in_folder("none.exr"));
    glint_fails(2, "whole pixels", "crop", made, "-1,0,4,4", "-o", in_folder("none.exr"));
    glint_fails(2, "expected 4 numbers", "crop", made, "0,0,nan,4", "-o", in_folder("none.exr"));
    glint_fails(2, "no rectangle", "crop", made, "-o", in_folder("none.exr"));
    assert_false(file_exists(in_folder("none.exr")));
}

/* The images of a run, of one pass. */
static float *run_image(const char *run, const char *file, const char *image, const char *channel, uint32_t size[2]) {
    char path[600];
    struct glint_error err = {0};
    snprintf(path, sizeof path, "%s/%s", run, file);
    struct glint_exr *exr = open_exr(path);
    const size_t part = part_index(exr, image);
    const struct glint_exr_part_info *info = glint_exr_part(exr, part);
    assert_non_null(info);
    float *data = malloc((size_t)info->width * info->height * sizeof *data);
    uint32_t *whole = malloc((size_t)info->width * info->height * sizeof *whole);
    assert_true(data && whole);
    size[0] = info->width, size[1] = info->height;
    if (info->channels[0].stored == GLINT_STORED_UINT) {
        assert_true(glint_exr_read(exr, part, &channel, 1, GLINT_U32, whole, 0, &err));
        for (size_t i = 0; i < (size_t)size[0] * size[1]; i++) data[i] = (float)whole[i];
    } else assert_true(glint_exr_read(exr, part, &channel, 1, GLINT_F32, data, 0, &err));
    free(whole);
    glint_exr_close(&exr);
    return data;
}

static void replay_rays(const char *capture, const char *run) {
    free(glint_ok("replay", capture, "-o", run, "--preset", "kf2", "--use", "screen_trace=dda", "--set",
                  "downsample.jitter=0", "--passes", "downsample,screen_trace", "--outputs",
                  "screen_travelled,screen_finished,depth_half"));
}

static char *trace_file(const char *run) {
    static char names[2][64];
    static int turn;
    char *name = names[turn++ % 2];
    char path[600];
    for (int i = 0; i < 30; i++) {
        snprintf(name, 64, "%02d-screen_trace.exr", i);
        snprintf(path, sizeof path, "%s/%s", run, name);
        if (file_exists(path)) return name;
    }
    fail_msg("%s has no screen_trace", run);
    return NULL;
}

/* Where the traced ray ends at the truth's hit, the truth of the crop says that the hit is visible exactly if the ray of the crop finds it. The
   rest are hits at the border of the rectangle, and those behind surfaces that the crop does not show. */
static void expect_visible_hits(const float *far, const float *ended_whole, const float *ended, const uint32_t large[2],
                                const uint32_t small[2], uint32_t x0, uint32_t y0) {
    struct glint_exr *before = open_exr(room), *after = open_exr(in_folder("crop.exr"));
    const size_t from = part_index(before, "truth.mirror"), to = part_index(after, "truth.mirror");
    static const char *const names[] = {"distance.Z", "visible"};
    struct glint_error err = {0};
    float *truth = malloc((size_t)large[0] * large[1] * 2 * sizeof *truth),
          *cropped = malloc((size_t)small[0] * small[1] * 2 * sizeof *cropped);
    size_t seen = 0, hidden = 0, wrong = 0;
    assert_true(truth && cropped && glint_exr_read(before, from, names, 2, GLINT_F32, truth, 0, &err) &&
                glint_exr_read(after, to, names, 2, GLINT_F32, cropped, 0, &err));
    for (uint32_t y = 0; y < small[1]; y++)
        for (uint32_t x = 0; x < small[0]; x++) {
            const size_t i = (size_t)y * small[0] + x, k = (size_t)(y0 + y) * large[0] + x0 + x;
            assert_true(cropped[2 * i] == truth[2 * k] && cropped[2 * i + 1] <= truth[2 * k + 1]);
            if (truth[2 * k + 1] == 0 || ended_whole[k] == 0 || fabsf(far[k] - truth[2 * k]) > 0.01f * truth[2 * k])
                continue;
            *(cropped[2 * i + 1] == 1 ? &seen : &hidden) += 1;
            wrong += (cropped[2 * i + 1] == 1) != (ended[i] != 0);
        }
    print_message("# %zu hits are visible in the rectangle, %zu no longer; %zu traced otherwise\n", seen, hidden,
                  wrong);
    assert_true(seen > 100 && hidden > 100 && wrong <= (seen + hidden) / 50);
    free(truth);
    free(cropped);
    glint_exr_close(&before);
    glint_exr_close(&after);
}

/* Mirror rays at every pixel, through every texel: nothing depends on a pixel's place in the picture. A ray that ends on a surface inside the
   rectangle has the same length in both; where rounding of the camera to floats decides whether it grazes a surface, it may differ. */
static void a_replay_of_the_crop_is_a_crop_of_the_replay(void **state) {
    (void)state;
    const uint32_t x0 = 18, y0 = 20;
    uint32_t large[2], small[2];
    char whole[512], part[512];
    snprintf(whole, sizeof whole, "%s", in_folder("whole"));
    snprintf(part, sizeof part, "%s", in_folder("part"));
    free(glint_ok("crop", room, "18,20,60,44", "-o", in_folder("crop.exr")));
    expect_rays(room, in_folder("crop.exr"), x0, y0);
    replay_rays(room, whole);
    replay_rays(in_folder("crop.exr"), part);
    float *far = run_image(whole, trace_file(whole), "screen_travelled", "Z", large),
          *near = run_image(part, trace_file(part), "screen_travelled", "Z", small),
          *ended = run_image(part, trace_file(part), "screen_finished", "finished", small),
          *ended_whole = run_image(whole, trace_file(whole), "screen_finished", "finished", large);
    assert_int_equal(small[0], 60);
    assert_int_equal(small[1], 44);
    size_t count = 0, differ = 0;
    for (uint32_t y = 0; y < small[1]; y++)
        for (uint32_t x = 0; x < small[0]; x++) {
            const size_t i = (size_t)y * small[0] + x, k = (size_t)(y0 + y) * large[0] + x0 + x;
            if (ended[i] == 0 || near[i] == 0) continue; /* it left the rectangle */
            count++;
            differ += ended_whole[k] == 0 || !(fabsf(far[k] - near[i]) <= 1e-4f * near[i]);
        }
    expect_visible_hits(far, ended_whole, ended, large, small, x0, y0);
    print_message("# %zu rays end in the rectangle, %zu differ\n", count, differ);
    assert_true(count > 200);
    assert_true(differ <= count / 200);
    free(far);
    free(near);
    free(ended);
    free(ended_whole);
}

/* ---- No input is harmed ---- */

static void inputs_are_refused_as_outputs(void **state) {
    (void)state;
    char hard[512], soft[512], other[600], sibling[512];
    snprintf(hard, sizeof hard, "%s", in_folder("hard.exr"));
    snprintf(soft, sizeof soft, "%s", in_folder("soft.exr"));
    snprintf(other, sizeof other, "%s/../%s", in_folder("."), strrchr(made, '/') + 1);
    assert_int_equal(link(made, hard), 0);
    assert_int_equal(symlink(made, soft), 0);
    const char *const names[] = {made, hard, soft};
    for (size_t i = 0; i < 3; i++) {
        glint_fails(2, "is the input", "set", made, "frame=7", "-o", names[i]);
        glint_fails(2, "is the input", "crop", made, "0,0,4,4", "-o", names[i]);
        glint_fails(2, "is the input", "strip", names[i], "--drop", "sky", "-o", made);
    }
    free(glint_ok("info", made));
    free(glint_ok("sample", "room", "-o", in_folder("shot.exr"), "--frames", "2", "--size=24x16", "--cube-size", "8"));
    snprintf(sibling, sizeof sibling, "%s", in_folder("shot.cubemaps.exr"));
    assert_true(file_exists(sibling));
    glint_fails(2, "holds cube maps of the input", "set", in_folder("shot.0001.exr"), "frame=7", "-o", sibling);
}

/* In its folder a copy names the same file of cube maps; elsewhere it holds them. */
static void siblings_stay_or_come_along(void **state) {
    (void)state;
    char shot[512], away[600];
    snprintf(shot, sizeof shot, "%s", in_folder("shot.0001.exr"));
    snprintf(away, sizeof away, "%s", in_folder("away"));
    assert_int_equal(mkdir(away, 0700), 0);
    snprintf(away, sizeof away, "%s/copy.exr", in_folder("away"));
    free(glint_ok("set", shot, "frame=9", "-o", in_folder("copy.exr")));
    free(glint_ok("set", shot, "frame=9", "-o", away));
    struct glint_exr *here = open_exr(in_folder("copy.exr")), *there = open_exr(away);
    const size_t part = part_index(here, "cubemap.000");
    assert_int_equal(glint_exr_part(here, part)->width, 1);
    assert_int_equal(glint_exr_part(there, part)->width, 8);
    assert_null(glint_exr_attribute(glint_exr_part(there, part), "glint.sibling"));
    glint_exr_close(&here);
    glint_exr_close(&there);
    free(glint_ok("validate", away));
    free(glint_ok("validate", in_folder("copy.exr")));
    free(glint_ok("strip", shot, "--drop", "cubemap:distance.Z", "-o", in_folder("copy.exr")));
    assert_true(has(in_folder("copy.exr"), "cubemap.000", "A"));
    assert_false(has(in_folder("copy.exr"), "cubemap.000", "distance.Z"));
    free(glint_ok("validate", in_folder("copy.exr")));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_key_reads_back),
        cmocka_unit_test(depth_is_declared_and_removed),
        cmocka_unit_test(a_broken_capture_is_repaired),
        cmocka_unit_test(bad_values_are_refused),
        cmocka_unit_test(strip_keeps_bits),
        cmocka_unit_test(wrong_names_are_refused),
        cmocka_unit_test(rays_stay),
        cmocka_unit_test(motion_stays),
        cmocka_unit_test(other_sizes_are_cropped_by_their_ratio),
        cmocka_unit_test(wrong_rectangles_are_refused),
        cmocka_unit_test(a_replay_of_the_crop_is_a_crop_of_the_replay),
        cmocka_unit_test(inputs_are_refused_as_outputs),
        cmocka_unit_test(siblings_stay_or_come_along),
    };
    return cmocka_run_group_tests_name("edit", tests, make_captures, remove_folder);
}

/* Renders a scene with the given options and writes captures. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "air.h"
#include "bake.h"
#include "decals.h"
#include "dump.h"
#include "encode.h"
#include "extra.h"
#include "finished.h"
#include "foreground.h"
#include "gltf.h"
#include "lens.h"
#include "light.h"
#include "light_truth.h"
#include "probes.h"
#include "scenes.h"
#include "settings.h"
#include "share.h"

static const struct glint_sample samples[] = {
#define ROW(name, summary) {#name, summary},
    SCENES(ROW)
#undef ROW
};

const struct glint_sample *glint_samples(size_t *count) {
    *count = sizeof samples / sizeof *samples;
    return samples;
}

enum {
    DEFAULT_WIDTH = 1280,
    DEFAULT_HEIGHT = 720,
    DEFAULT_CUBE = 256,
    MAX_SIDE = 16384,
    MAX_CUBE = 4096,
    MAX_FRAME = 1000000
};

/* An arbitrary factor other than 1, for engines with pre-exposed buffers. */
#define PRE_EXPOSURE 0.375

/* The state of a call. */
struct session {
    struct scene scene;
    struct glint_sample_options options;
    const char *out;
    struct job job;
    struct world *now, *before, *probes;
    struct air *air, *earlier; /* of this frame and the one before, with GLINT_ALSO_SKY */
    struct pixel *pixels, *previous;
    struct texel *texels;
    struct truth *truth;
    uint32_t light_samples;
    char cubemaps_path[4096];
    char settings[72]; /* hash of scene and options; in a shot, the hash of the cube maps is appended */
};

static bool check_encodings(const struct glint_encodings *e, struct glint_error *err) {
    const struct {
        const char *which;
        int value;
    } all[] = {{"depth", (int)e->depth},
               {"normal", (int)e->normal},
               {"vertex_normal", (int)e->vertex_normal},
               {"normal_space", (int)e->normal_space},
               {"roughness", (int)e->roughness},
               {"motion", (int)e->motion},
               {"motion_depth", (int)e->motion_depth},
               {"color", (int)e->color}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (all[i].value < 0 || !glint_encoding_name(all[i].which, all[i].value))
            return glint_fail(err, GLINT_ERROR_USAGE, "encoding of %s: there is no number %d", all[i].which,
                              all[i].value);
    return true;
}

static bool finite3(const double v[3]) {
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

static bool check_options(const struct glint_sample_options *o, struct glint_error *err) {
    if (o->width > MAX_SIDE || o->height > MAX_SIDE || !o->width != !o->height)
        return glint_fail(err, GLINT_ERROR_USAGE, "size %u x %u: expected 1 to %d a side", o->width, o->height,
                          MAX_SIDE);
    if (o->planar_width > MAX_SIDE || o->planar_height > MAX_SIDE || !o->planar_width != !o->planar_height)
        return glint_fail(err, GLINT_ERROR_USAGE, "planar map of %u x %u: expected 1 to %d a side", o->planar_width,
                          o->planar_height, MAX_SIDE);
    if (o->cube_size > MAX_CUBE)
        return glint_fail(err, GLINT_ERROR_USAGE, "cube size %u: expected at most %d", o->cube_size, MAX_CUBE);
    if (o->frames > MAX_FRAME || o->first_frame > MAX_FRAME)
        return glint_fail(err, GLINT_ERROR_USAGE, "%u frames from %u: expected at most %d", o->frames, o->first_frame,
                          MAX_FRAME);
    if (!(o->fov_y_rad >= 0 && o->fov_y_rad < 3.0))
        return glint_fail(err, GLINT_ERROR_USAGE, "field of view %g rad: expected between 0 and 3", o->fov_y_rad);
    if (!finite3(o->offset)) return glint_fail(err, GLINT_ERROR_USAGE, "offset: expected finite numbers");
    if (!finite3(o->travel)) return glint_fail(err, GLINT_ERROR_USAGE, "travel: expected finite numbers");
    if (!(o->occlusion_radius >= 0) || !(o->contact_length >= 0) || isinf(o->occlusion_radius) ||
        isinf(o->contact_length))
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "radius of occlusion %g, length of contact shadows %g: expected lengths", o->occlusion_radius,
                          o->contact_length);
    if (o->cascades > 4) return glint_fail(err, GLINT_ERROR_USAGE, "%u cascades: expected at most 4", o->cascades);
    bool looks = finite3(o->eye) && finite3(o->target) && memcmp(o->eye, o->target, sizeof o->eye);
    if (o->camera_given && !looks)
        return glint_fail(err, GLINT_ERROR_USAGE, "camera: expected a position and another point to look at");
    return check_encodings(&o->encodings, err);
}

static bool build_scene(const char *name, struct session *s, struct glint_error *err) {
    static void (*const builders[])(struct scene *) = {
#define BUILDER(name, summary) build_##name,
        SCENES(BUILDER)
#undef BUILDER
    };
    scene_init(&s->scene);
    for (size_t i = 0; i < sizeof samples / sizeof *samples; i++) {
        if (strcmp(name, samples[i].name)) continue;
        builders[i](&s->scene);
        if (s->scene.out_of_memory) return glint_fail(err, GLINT_ERROR_MEMORY, "no memory for scene %s", name);
        return true;
    }
    return gltf_load(name, &s->scene, err);
}

/* ---- Attributes of the frame, moved by the offset ---- */

static void move_camera(struct glint_camera *camera, const double offset[3]) {
    double *m = camera->world_to_view;
    for (int row = 0; row < 3; row++)
        m[4 * row + 3] -= m[4 * row] * offset[0] + m[4 * row + 1] * offset[1] + m[4 * row + 2] * offset[2];
}

static struct glint_frame frame_of_views(const struct session *s, const struct view *view, const struct view *previous,
                                         uint32_t number) {
    const struct scene *scene = &s->scene;
    const double *offset = s->options.offset;
    struct glint_frame frame = {.camera = view->camera,
                                .previous = previous->camera,
                                .has_previous = true,
                                .has_player = true,
                                .number = number,
                                .cut = s->options.cut && number == s->options.first_frame,
                                .exposure = 1,
                                .depth_near = VIEW_NEAR,
                                .depth_far = VIEW_FAR,
                                .motion_range = 1,
                                .motion_depth_range = MOTION_DEPTH_RANGE,
                                .metres_per_unit = 1,
                                .pre_exposure = 1,
                                .has_fog = scene->has_fog,
                                .fog = scene->fog};
    if (s->options.encodings.color == GLINT_COLOR_PRE_EXPOSED) frame.pre_exposure = PRE_EXPOSURE;
    memcpy(frame.jitter_px, view->jitter_px, sizeof frame.jitter_px);
    move_camera(&frame.camera, offset);
    move_camera(&frame.previous, offset);
    const double *travel = s->options.travel;
    vec3 step = s->options.travel_given ? v3((float)travel[0], (float)travel[1], (float)travel[2]) : scene->player_step;
    vec3 player = s->options.camera_given ? view_eye(view) : along(scene->player, step, (float)(number - 1));
    const float at[3] = {player.x, player.y, player.z};
    for (int i = 0; i < 3; i++) frame.player[i] = (double)at[i] + offset[i];
    frame.fog.base += offset[1];
    memcpy(frame.classes, scene->classes, sizeof scene->classes);
    frame.class_count = scene->class_count;
    light_describe(scene, offset, &frame);
    if (s->air) air_describe(s->air, offset, &frame);
    return frame;
}

static struct glint_cubemap moved_cubemap(const struct session *s, uint32_t i) {
    struct glint_cubemap map = s->scene.cubemaps[i];
    for (int k = 0; k < 3; k++) map.center[k] += s->options.offset[k];
    return map;
}

/* ---- Files ---- */

static bool write_cubemaps(struct session *s, const struct dump *dump, struct glint_error *err) {
    for (uint32_t i = 0; i < s->scene.cubemap_count; i++) {
        struct glint_cubemap map = moved_cubemap(s, i);
        const double *c = s->scene.cubemaps[i].center;
        vec3 center = v3((float)c[0], (float)c[1], (float)c[2]);
        if (!render_cubemap(s->probes, center, s->options.cube_size, s->texels, &s->job, 3, err)) return false;
        if (!dump_cubemap(dump, i, &map, s->options.cube_size, s->texels, err)) return false;
    }
    return true;
}

static bool name_cubemaps(const struct session *s, const struct dump *dump, struct glint_error *err) {
    const char *slash = strrchr(s->cubemaps_path, '/'), *sibling = slash ? slash + 1 : s->cubemaps_path;
    for (uint32_t i = 0; i < s->scene.cubemap_count; i++) {
        struct glint_cubemap map = moved_cubemap(s, i);
        if (!dump_cubemap_elsewhere(dump, i, &map, s->options.cube_size, sibling, err)) return false;
    }
    return true;
}

static bool write_sky(struct session *s, const struct dump *dump, struct glint_error *err) {
    if (!s->scene.sky) return true;
    uint32_t size = s->options.cube_size;
    return render_sky(s->now, size, s->texels, &s->job, 1, err) &&
           (!s->air || air_paint_cube(s->air, view_eye(dump->view), size, s->texels, &s->job, err)) &&
           dump_sky(dump, size, s->texels, err);
}

/* Writes water, the image with it, and the planar reflection map. */
static bool write_water(struct session *s, const struct dump *dump, const struct view *view, uint32_t number,
                        struct glint_error *err) {
    const struct glint_sample_options *o = &s->options;
    struct view straight = view_through(&s->scene, o, o->planar_width, o->planar_height, number, VIEW_PLACES);
    struct view mirrored = mirrored_view(&s->scene.water, &straight);
    struct glint_planar planar = {.plane = {0, 1, 0, -(double)s->scene.water.level - o->offset[1]},
                                  .camera = mirrored.camera};
    struct water_pixel *water = calloc((size_t)o->width * o->height, sizeof *water);
    struct texel *texels = calloc((size_t)o->planar_width * o->planar_height, sizeof *texels);
    move_camera(&planar.camera, o->offset);
    bool ok = (water && texels) || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the water");
    ok = ok && render_water(s->now, view, s->pixels, water, &s->job, 0, err) && dump_water(dump, water, err) &&
         dump_scene(dump, &water->scene, sizeof *water, err) &&
         render_planar(s->now, &mirrored, texels, &s->job, 0, err) &&
         dump_planar(dump, &mirrored, &planar, texels, err);
    free(water);
    free(texels);
    return ok;
}

static bool has_panes(const struct scene *scene) {
    bool any = false;
    for (uint32_t i = 0; i < scene->mesh_count; i++) any |= (scene->meshes[i].flags & MESH_GLASS) != 0;
    return any;
}

static bool write_finished(struct session *s, const struct dump *dump, const struct view *view,
                           struct glint_error *err) {
    vec3 *picture = calloc((size_t)view->width * view->height, sizeof *picture);
    uint32_t samples = s->options.finished_samples;
    bool ok = picture || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the finished picture");
    ok = ok && render_finished(s->now, view, s->pixels, samples, picture, &s->job, samples, err) &&
         dump_scene(dump, picture, sizeof *picture, err);
    free(picture);
    return ok;
}

/* Writes panes of glass, and the image with them. */
static bool write_glass(struct session *s, const struct dump *dump, const struct view *view, double time,
                        struct glint_error *err) {
    if (!has_panes(&s->scene)) return true;
    struct glass_pixel *glass = calloc((size_t)view->width * view->height, sizeof *glass);
    struct world *panes = world_create(&s->scene, WORLD_GLASS, time, err);
    bool ok = panes && (glass || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the glass"));
    ok = ok && render_glass(s->now, panes, view, s->pixels, glass, &s->job, 0, err) && dump_glass(dump, glass, err) &&
         dump_scene(dump, &glass->scene, sizeof *glass, err);
    world_destroy(&panes);
    free(glass);
    return ok;
}

/* The G-buffer without decals, their buffers, and the light that the picture has with them; that of the previous frame is from before. */
static bool write_decals(struct session *s, const struct dump *dump, const struct view *view, struct glint_error *err) {
    struct decal *decals = decals_draw(view, s->pixels, err);
    const bool ok = decals && dump_gbuffer(dump, "gbuffer", view, s->pixels, err) && decals_write(dump, decals, err);
    if (decals) decals_light(decals, view, s->pixels);
    free(decals);
    return ok;
}

static bool write_parts(struct session *s, const struct dump *dump, const struct view *view,
                        const struct view *previous, uint32_t number, bool shot, struct glint_error *err) {
    if (!(s->options.also & GLINT_ALSO_DECALS ? write_decals(s, dump, view, err)
                                              : dump_gbuffer(dump, "gbuffer", view, s->pixels, err)) ||
        !dump_lit(dump, "lit", s->pixels, err) || !dump_gbuffer(dump, "previous.gbuffer", previous, s->previous, err) ||
        !dump_lit(dump, "previous.lit", s->previous, err) ||
        !light_write(dump, s->now, s->air, s->pixels, &s->options, &s->job, err) ||
        !extra_write(dump, s->now, &s->options, &s->job, err) || !lens_write(dump, &s->options, err) ||
        (s->air && !air_write(dump, s->air, err)))
        return false;
    if (!(shot ? name_cubemaps(s, dump, err) : write_cubemaps(s, dump, err)) || !write_sky(s, dump, err)) return false;
    if (s->scene.water.there && !write_water(s, dump, view, number, err)) return false;
    if (!write_glass(s, dump, view, (double)number - 1, err)) return false;
    const struct glint_sample_options *o = &s->options;
    if (o->finished_samples && !write_finished(s, dump, view, err)) return false;
    if (!o->truth_samples) return true;
    struct view unjittered = view_through(&s->scene, o, o->width, o->height, number, VIEW_PLACES);
    if (!light_truth_write(dump, s->now, &unjittered, s->pixels, o, &s->job, err)) return false;
    if (!(o->truths & GLINT_TRUTH_REFLECTION)) return true;
    return render_truth(s->now, view, s->pixels, o->truth_samples, 0, o->finished_samples > 0, s->truth, &s->job,
                        o->truth_samples, err) &&
           (!o->truth_of_pixels || truth_average(s->now, o, number, s->truth, &s->job, err)) &&
           dump_truth(dump, s->truth, o->truth_samples * (o->truth_of_pixels ? VIEW_PLACES : 1), err);
}

static bool make_worlds(struct session *s, double time, struct glint_error *err) {
    world_destroy(&s->now);
    world_destroy(&s->before);
    s->now = world_create(&s->scene, WORLD_ALL, time, err);
    s->before = s->now ? world_create(&s->scene, WORLD_ALL, time - 1, err) : NULL;
    if (!s->before || !(s->options.also & GLINT_ALSO_SKY)) return s->before != NULL;
    air_destroy(&s->air);
    air_destroy(&s->earlier);
    s->air = air_create(&s->scene, time, err);
    s->earlier = s->air ? air_create(&s->scene, time - 1, err) : NULL;
    return s->earlier != NULL;
}

/* `rendered`: `pixels` already holds the previous frame. */
static bool render_views(struct session *s, const struct view views[3], bool rendered, struct glint_error *err) {
    struct pixel *swapped = s->previous;
    s->previous = s->pixels;
    s->pixels = swapped;
    if (!rendered && !(render_frame(s->before, &views[1], &views[2], s->previous, &s->job, 2, err) &&
                       (!s->earlier || air_paint(s->earlier, s->before, &views[1], s->previous, &s->job, err))))
        return false;
    return render_frame(s->now, &views[0], &views[1], s->pixels, &s->job, 2, err) &&
           (!s->air || air_paint(s->air, s->now, &views[0], s->pixels, &s->job, err));
}

static bool write_frame(struct session *s, const char *path, uint32_t number, bool rendered, bool shot,
                        struct glint_error *err) {
    bool ok = false;
    struct view views[3];
    const struct glint_sample_options *o = &s->options;
    for (uint32_t i = 0; i < 3; i++)
        views[i] = view_at(&s->scene, o, o->width, o->height, (int64_t)number - (int64_t)i);
    if (!make_worlds(s, (double)number - 1, err)) return false;
    struct glint_frame frame = frame_of_views(s, &views[0], &views[1], number);
    struct dump dump = {
        .encodings = o->encodings, .pre_exposure = frame.pre_exposure, .view = &views[0], .settings = s->settings};
    if (!render_views(s, views, rendered, err)) return false;
    share_reflections(o, s->pixels);
    dump.writer = glint_writer_create(
        path, &(struct glint_writer_options){.compression = o->compression, .threads = o->threads}, err);
    if (!dump.writer) return false;
    ok = glint_writer_set_frame(dump.writer, &frame, err) &&
         write_parts(s, &dump, &views[0], &views[1], number, shot, err) && glint_writer_finish(dump.writer, err);
    glint_writer_destroy(&dump.writer);
    return ok;
}

static bool write_shared_cubemaps(struct session *s, struct glint_error *err) {
    struct dump dump = {.encodings = s->options.encodings, .pre_exposure = 1, .settings = s->settings};
    if (dump.encodings.color == GLINT_COLOR_PRE_EXPOSED) dump.pre_exposure = PRE_EXPOSURE;
    dump.writer = glint_writer_create(
        s->cubemaps_path,
        &(struct glint_writer_options){.compression = s->options.compression, .threads = s->options.threads}, err);
    if (!dump.writer) return false;
    bool ok = write_cubemaps(s, &dump, err) && glint_writer_finish(dump.writer, err);
    glint_writer_destroy(&dump.writer);
    return ok;
}

/* The path with `infix` before its suffix. */
static bool name_file(char *path, size_t room, const char *out, const char *infix, struct glint_error *err) {
    const char *slash = strrchr(out, '/'), *dot = strrchr(slash ? slash : out, '.');
    size_t stem = dot && dot > out ? (size_t)(dot - out) : strlen(out);
    int n = snprintf(path, room, "%.*s%s%s", (int)stem, out, infix, out + stem);
    return n >= 0 && (size_t)n < room ? true : glint_fail(err, GLINT_ERROR_USAGE, "%.200s: the path is too long", out);
}

/* ---- From options to a session ---- */

static void set_defaults(struct session *s) {
    struct glint_sample_options *o = &s->options;
    if (!o->width) {
        o->width = DEFAULT_WIDTH;
        o->height = DEFAULT_HEIGHT;
    }
    if (!o->cube_size) o->cube_size = DEFAULT_CUBE;
    if (!o->planar_width) o->planar_width = 240, o->planar_height = 120;
    if (!o->frames) o->frames = 1;
    if (!o->first_frame) o->first_frame = 1;
    if (!o->truths) o->truths = GLINT_TRUTH_REFLECTION;
    if (o->occlusion_radius == 0) o->occlusion_radius = 1;
    if (o->contact_length == 0) o->contact_length = 0.5;
    if (!o->probes_given) o->probes = s->scene.probes;
    s->light_samples = o->light_samples ? o->light_samples : s->scene.light_samples;
    struct view first = view_at(&s->scene, o, o->width, o->height, 1);
    s->scene.seen_from = view_eye(&first);
    s->scene.pixel_rad = first.pixel_rad;
}

static double total_work(const struct session *s) {
    return 5 + 3.0 * s->scene.cubemap_count +
           s->options.frames * (4.0 + 1 + s->options.truth_samples + s->options.finished_samples);
}

static bool prepare(struct session *s, struct glint_error *err) {
    size_t pixels = (size_t)s->options.width * s->options.height, cube = s->options.cube_size;
    s->pixels = calloc(pixels, sizeof *s->pixels);
    s->previous = calloc(pixels, sizeof *s->previous);
    s->texels = calloc(6 * cube * cube, sizeof *s->texels);
    if (s->options.truth_samples) s->truth = calloc(pixels, sizeof *s->truth);
    if (!s->pixels || !s->previous || !s->texels || (s->options.truth_samples && !s->truth))
        return glint_fail(err, GLINT_ERROR_MEMORY, "no memory for %u x %u pixels", s->options.width, s->options.height);
    bool placed = s->options.probes == GLINT_PROBES_AUTO || !s->scene.cubemap_count;
    if (placed) s->scene.cubemap_count = 8; /* the maximum, for the progress */
    s->job.total = total_work(s);
    if (!s->scene.unlit && !bake_light(&s->scene, s->light_samples, &s->job, 5, err)) return false;
    enum world_kind kind = s->options.probes == GLINT_PROBES_IMPERFECT ? WORLD_SIMPLIFIED : WORLD_ALL;
    s->probes = world_create(&s->scene, kind, s->options.first_frame - 1.0, err);
    if (s->probes && placed) place_probes(&s->scene, s->probes);
    return s->probes != NULL;
}

/* ---- All files; an interrupted shot is completed ---- */

/* Frames contain the hash of their cube maps, so that frames with different cube maps do not count as complete. */
static bool append_cubemaps_hash(struct session *s) {
    char hex[33];
    bool ok = settings_file_hash(s->cubemaps_path, hex);
    if (ok) snprintf(s->settings + 32, sizeof s->settings - 32, "-%s", hex);
    return ok;
}

static bool name_frame(const struct session *s, uint32_t number, char *path, size_t room, struct glint_error *err) {
    char infix[32];
    snprintf(infix, sizeof infix, ".%04u", number);
    return name_file(path, room, s->out, infix, err);
}

/* The number of complete frames with these settings from the first on. */
static bool count_kept(const struct session *s, uint32_t *kept, struct glint_error *err) {
    char path[4096];
    *kept = 0;
    for (uint32_t i = 0; i < s->options.frames; i++) {
        if (!name_frame(s, s->options.first_frame + i, path, sizeof path, err)) return false;
        *kept += settings_kept(path, "gbuffer", s->settings);
    }
    return true;
}

static bool write_shot(struct session *s, struct glint_error *err) {
    uint32_t kept = 0, first = s->options.first_frame;
    bool rendered = false;
    char path[4096];
    if (!name_file(s->cubemaps_path, sizeof s->cubemaps_path, s->out, ".cubemaps", err)) return false;
    if (append_cubemaps_hash(s) && !count_kept(s, &kept, err)) return false;
    if (kept == s->options.frames) return true;
    if (!prepare(s, err)) return false;
    /* no frame vouches for existing cube maps */
    if (!kept) s->settings[32] = 0;
    if (!kept && !write_shared_cubemaps(s, err)) return false;
    if (!kept && !append_cubemaps_hash(s))
        return glint_fail(err, GLINT_ERROR_IO, "%.400s: cannot be read again", s->cubemaps_path);
    for (uint32_t i = 0; i < s->options.frames; i++) {
        if (!name_frame(s, first + i, path, sizeof path, err)) return false;
        bool there = settings_kept(path, "gbuffer", s->settings);
        if (!there && !write_frame(s, path, first + i, rendered, true, err)) return false;
        rendered = !there;
    }
    return true;
}

static bool write_files(struct session *s, struct glint_error *err) {
    if (!settings_hash(&s->scene, &s->options, s->settings, err)) return false;
    if (s->options.frames > 1) return write_shot(s, err);
    return prepare(s, err) && write_frame(s, s->out, s->options.first_frame, false, false, err);
}

bool glint_sample_write(const char *scene, const char *out, const struct glint_sample_options *options,
                        glint_progress progress, void *user, struct glint_error *err) {
    struct session s = {.out = out, .options = options ? *options : (struct glint_sample_options){0}};
    s.job = (struct job){.progress = progress, .user = user, .threads = s.options.threads};
    bool ok = check_options(&s.options, err) && build_scene(scene, &s, err);
    const bool beyond = s.scene.water.there || has_panes(&s.scene);
    if (ok && s.options.finished_samples && beyond)
        ok = glint_fail(err, GLINT_ERROR_USAGE, "%.200s: has water or panes, and a finished picture with them", scene);
    if (ok && s.options.truths & (GLINT_TRUTH_ANTIALIASED | GLINT_TRUTH_PICTURE) && beyond)
        ok = glint_fail(err, GLINT_ERROR_USAGE,
                        "%.200s: has water or panes, which the truths antialiased and picture lack", scene);
    if (ok) {
        if (s.options.also & GLINT_ALSO_DECALS) decals_mark(&s.scene);
        if (s.options.foreground) foreground_add(&s.scene, &s.options);
        set_defaults(&s);
        ok = write_files(&s, err);
    }
    world_destroy(&s.now);
    world_destroy(&s.before);
    world_destroy(&s.probes);
    air_destroy(&s.air);
    air_destroy(&s.earlier);
    free(s.pixels);
    free(s.previous);
    free(s.texels);
    free(s.truth);
    scene_finish(&s.scene);
    return ok;
}

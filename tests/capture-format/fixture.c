/* A small synthetic capture for the tests of the format. */
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#ifdef _WIN32
#include <direct.h>
#define mkdir(path, mode) _mkdir(path)
#define TEMPORARY "TEMP"
#else
#define TEMPORARY "TMPDIR"
#endif

static const double PI = 3.14159265358979323846;

struct glint_camera fixture_camera(const double eye[3], double near, double far) {
    /* Rotated about y and x, so that no axis is special. */
    const double a = 0.6, b = -0.2;
    const double r[9] = {cos(a),          0,       -sin(a),        sin(a) * sin(b), cos(b), cos(a) * sin(b),
                         sin(a) * cos(b), -sin(b), cos(a) * cos(b)};
    struct glint_camera camera = {0};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) camera.world_to_view[4 * i + j] = r[3 * i + j];
        camera.world_to_view[4 * i + 3] = -(r[3 * i] * eye[0] + r[3 * i + 1] * eye[1] + r[3 * i + 2] * eye[2]);
    }
    camera.world_to_view[15] = 1;
    camera.view_to_clip[0] = 1 / tan(0.5);
    camera.view_to_clip[5] = camera.view_to_clip[0] * FIX_W / FIX_H;
    camera.view_to_clip[10] = far / (near - far);
    camera.view_to_clip[11] = near * far / (near - far);
    camera.view_to_clip[14] = -1;
    return camera;
}

struct glint_frame fixture_frame(void) {
    struct glint_frame frame = {0};
    frame.camera = fixture_camera((const double[3]){1, 2, 3}, 0.1, 500);
    frame.previous = fixture_camera((const double[3]){1.1, 2, 2.9}, 0.1, 500);
    frame.has_previous = true;
    frame.number = 4000000007u;
    frame.jitter_px[0] = 0.25;
    frame.jitter_px[1] = -0.125;
    frame.has_player = true;
    frame.player[1] = 1e9 + 0.125;
    frame.exposure = 1.5;
    frame.pre_exposure = 0.25;
    frame.has_lut_stops = true;
    frame.lut_stops[0] = -9.5;
    frame.lut_stops[1] = 6.25;
    frame.metres_per_unit = 0.01;
    frame.depth_near = 0.1;
    frame.depth_far = 500;
    frame.motion_range = 0.5;
    frame.has_fog = true;
    frame.fog = (struct glint_fog){{0.5f, 0.6f, 0.7f}, 0.01, -2, 80, false};
    frame.has_atmosphere = frame.has_clouds = true;
    frame.atmosphere = (struct glint_atmosphere){6360e3, -3,   60e3,   {20, 19, 18}, {5.8e-6f, 13.5e-6f, 33.1e-6f},
                                                 7900,   4e-6, 4.4e-6, 1300,         -0.25};
    frame.clouds = (struct glint_clouds){-3, 1500, 1750.5, 9000, 800, 0.03, 0.25, {1e6 + 0.5, -7}};
    frame.class_count = 2;
    frame.classes[0] = (struct glint_stencil_class){.value = 3, .mask = 7, .name = "sky"};
    frame.classes[1] = (struct glint_stencil_class){.value = 4, .name = "character = player"};
    frame.has_sun = true;
    frame.sun = (struct glint_sun){{0.6, 0.64, -0.48}, 0.00465, {6.5f, 6, 5.25f}};
    frame.light_count = 2;
    frame.lights[0] = (struct glint_light){.position = {1e6 + 0.1, 2, 3}, .intensity = {4, 3, 2}, .range = 800};
    frame.lights[1] = (struct glint_light){.position = {-1, 2, 3}, .intensity = {1, 1, 0.5f}, .radius = 3};
    frame.lights[1].has_cone = true;
    frame.lights[1].cone = (struct glint_cone){{0, -0.8, 0.6}, 0.25, 0.75};
    return frame;
}

double fixture_noise(uint32_t a, uint32_t b) {
    uint32_t x = a * 0x9e3779b1u ^ (b + 0x7f4a7c15u) * 0x85ebca6bu;
    x ^= x >> 15;
    x *= 0x2c1b3c6du;
    x ^= x >> 12;
    x *= 0x297a2d39u;
    x ^= x >> 15;
    return x / 4294967296.0;
}

void fixture_normal(uint32_t i, double n[3]) {
    const double z = 2 * fixture_noise(i, 1) - 1, phi = 2 * PI * fixture_noise(i, 2), r = sqrt(1 - z * z);
    n[0] = r * cos(phi);
    n[1] = r * sin(phi);
    n[2] = z;
}

void fixture_init(struct fixture *f) {
    memset(f, 0, sizeof *f);
    for (uint32_t i = 0; i < FIX_W * FIX_H; i++) {
        float *g = f->gbuffer + 17 * i;
        double n[3];
        g[0] = i % 7 == 0 ? INFINITY : (float)(0.2 + 400 * pow(fixture_noise(i, 3), 3));
        f->visible[i] = i % 7 == 0 ? 0 : (float)fixture_noise(i, 5);
        fixture_normal(i, n);
        for (int a = 0; a < 3; a++) g[1 + a] = (float)n[a];
        for (uint32_t c = 4; c < 10; c++) g[c] = (float)fixture_noise(i, c);
        for (uint32_t c = 10; c < 13; c++) g[c] = (float)(0.2 * fixture_noise(i, c) - 0.1);
        fixture_normal(i + 5000, n);
        for (int a = 0; a < 3; a++) g[13 + a] = (float)n[a];
        f->stencil[i] = i % 251;
        for (uint32_t c = 0; c < 4; c++) f->color[4 * i + c] = (float)fixture_noise(i, 40 + c);
    }
    for (uint32_t i = 0; i < FIX_CUBE * FIX_CUBE * 6; i++) {
        for (uint32_t c = 0; c < 3; c++) f->cube[5 * i + c] = i % 5 == 0 ? 0 : (float)fixture_noise(i, 20 + c);
        f->cube[5 * i + 4] = i % 5 == 0 ? INFINITY : (float)(1 + 50 * fixture_noise(i, 30));
        f->cube[5 * i + 3] = i % 5 == 0 ? 0 : 1;
    }
    f->cubemap = (struct glint_cubemap){.center = {1e6 + 0.1, 2, -3}, .outdoor = true, .fade = 0.5, .age_frames = 12};
    f->cubemap.inner = GLINT_VOLUME_HULL;
    f->cubemap.plane_count = 6;
    for (int i = 0; i < 6; i++) {
        f->cubemap.planes[i][i / 2] = i % 2 ? 1 : -1;
        f->cubemap.planes[i][3] = -(2.0 + i) / 3;
    }
    f->sky = (struct glint_sky){.has_ground = true, .ground = 0}; /* the horizon */
    f->probe[0] = (struct glint_probe){.has_roughness = true, .roughness = 0, .has_ground = true, .ground = -7.5};
    f->probe[0].has_box = true;
    f->probe[0].box = (struct glint_probe_box){{1e6 + 0.1, 2, -3}, {-1, -2, -3}, {0.5, 2.5, 3.5}};
    f->probe[1] = (struct glint_probe){.has_roughness = true, .roughness = 0.84};
    f->indirect.occluded = true;
    for (int i = 0; i < 2; i++) {
        f->shadow[i].world_to_shadow[0] = f->shadow[i].world_to_shadow[9] = 0.01;
        f->shadow[i].world_to_shadow[6] = -0.0025;
        f->shadow[i].world_to_shadow[15] = 1;
    }
    f->shadow[1].range[0] = 1; /* reversed */
    f->shadow[1].bias = 0.002;
    f->shadow[1].has_stencil_class = true;
    f->shadow[1].stencil_class = 1;
    f->shadow[1].has_light = true;
    f->shadow[1].light = 1;
    for (int i = 0; i < 3; i++) f->volume.world_to_grid[5 * i] = 0.005, f->volume.world_to_grid[4 * i + 3] = 1 + i;
    f->volume.world_to_grid[15] = 1;
    f->volume.slices = FIX_CELLS_Z;
    f->froxels = (struct glint_froxels){FIX_CELLS_Z, 12.5, 6400, true};
    f->truth = (struct glint_truth){.radius = 100, .length = 30};
    f->planar.plane[1] = 1;
    f->planar.plane[3] = -1.0 / 3;
    f->planar.camera = fixture_camera((const double[3]){1, -2, 3}, 0.1, 500);
}

struct fixture fixture;

int fixture_setup(void **state) {
    (void)state;
    fixture_init(&fixture);
    return 0;
}

static const char *const gbuffer_names[] = {"depth.Z",           "normal.X",           "normal.Y",
                                            "normal.Z",          "material.roughness", "material.metalness",
                                            "material.specular", "albedo.R",           "albedo.G",
                                            "albedo.B",          "motion.X",           "motion.Y",
                                            "motion.Z",          "vertexNormal.X",     "vertexNormal.Y",
                                            "vertexNormal.Z"};

static void add_fixture_channel(struct glint_part *part, struct fixture_channels *c, const char *name,
                                const float *data, size_t stride) {
    c->all[part->channel_count++] = (struct glint_channel){.name = name,
                                                           .type = GLINT_F32,
                                                           .data = data,
                                                           .x_stride_bytes = stride * 4,
                                                           .y_stride_bytes = stride * 4 * part->width};
    part->channels = c->all;
}

struct glint_part fixture_part(const struct fixture *f, enum fixture_part which, struct fixture_channels *c) {
    static const char *const names[] = {"gbuffer",
                                        "lit",
                                        "scene",
                                        "previous.gbuffer",
                                        "previous.lit",
                                        "cubemap.000",
                                        "cubemap.017",
                                        "sky",
                                        "probe.002",
                                        "probe.002.level1",
                                        "planar.002",
                                        "transparent",
                                        "water",
                                        "truth.reflection.ggx",
                                        "truth.mirror",
                                        "engine.screen_trace.anything",
                                        "indirect",
                                        "emissive",
                                        "ao",
                                        "sun",
                                        "shadow.000",
                                        "shadow.001",
                                        "volume.000",
                                        "froxels",
                                        "curvature",
                                        "stars",
                                        "cloud.density",
                                        "cloud.height",
                                        "cloud.noise",
                                        "truth.occlusion",
                                        "truth.sun",
                                        "truth.indirect",
                                        "truth.antialiased",
                                        "truth.picture",
                                        "lamps",
                                        "truth.lamps"};
    const bool cube = which == FIXTURE_CUBEMAP_0 || which == FIXTURE_CUBEMAP_1 || which == FIXTURE_SKY ||
                      which == FIXTURE_STARS || which == FIXTURE_PROBE || which == FIXTURE_PROBE_1;
    const uint32_t face = which == FIXTURE_PROBE_1 ? FIX_CUBE / 2 : FIX_CUBE;
    struct glint_part part = {.name = names[which], .width = cube ? face : FIX_W, .height = cube ? 6 * face : FIX_H};
    static const char *const rgba[] = {"R", "G", "B", "A"};
    memset(c, 0, sizeof *c);
    if (which == FIXTURE_GBUFFER || which == FIXTURE_PREVIOUS_GBUFFER) {
        for (size_t i = 0; i < 16; i++) add_fixture_channel(&part, c, gbuffer_names[i], f->gbuffer + i, 17);
        c->all[part.channel_count++] =
            (struct glint_channel){.name = "stencil.id", .type = GLINT_U32, .data = f->stencil};
        return part;
    }
    if (which == FIXTURE_MIRROR) {
        add_fixture_channel(&part, c, "distance.Z", f->gbuffer, 17);
        add_fixture_channel(&part, c, "visible", f->visible, 1);
        return part;
    }
    if (which == FIXTURE_ENGINE) {
        add_fixture_channel(&part, c, "hit.u", f->gbuffer + 5, 17);
        add_fixture_channel(&part, c, "whatever", f->gbuffer + 6, 17);
        return part;
    }
    if (which == FIXTURE_AO || which == FIXTURE_SUN || which == FIXTURE_TRUTH_OCCLUSION || which == FIXTURE_TRUTH_SUN) {
        add_fixture_channel(&part, c, "visibility", f->color, 4);
        if (which == FIXTURE_TRUTH_SUN) add_fixture_channel(&part, c, "contact", f->color + 1, 4);
        if (which != FIXTURE_AO && which != FIXTURE_SUN) part.truth = &f->truth;
        return part;
    }
    if (which == FIXTURE_SHADOW_0 || which == FIXTURE_SHADOW_1) {
        part.width = part.height = FIX_SHADOW;
        add_fixture_channel(&part, c, "depth.Z", f->color, 1);
        part.shadow = &f->shadow[which - FIXTURE_SHADOW_0];
        return part;
    }
    if (which == FIXTURE_VOLUME) {
        static const char *const names_of[] = {"px.R", "px.G", "px.B", "nx.R", "nx.G", "nx.B", "py.R", "py.G", "py.B",
                                               "ny.R", "ny.G", "ny.B", "pz.R", "pz.G", "pz.B", "nz.R", "nz.G", "nz.B"};
        part.width = FIX_CELLS_X;
        part.height = FIX_CELLS_Y * FIX_CELLS_Z;
        for (size_t i = 0; i < 18; i++) add_fixture_channel(&part, c, names_of[i], f->color + i, 18);
        part.volume = &f->volume;
        return part;
    }
    if (which == FIXTURE_FROXELS) {
        part.width = FIX_CELLS_X;
        part.height = FIX_CELLS_Y * FIX_CELLS_Z;
        for (size_t i = 0; i < 3; i++) add_fixture_channel(&part, c, rgba[i], f->color + i, 4);
        part.froxels = &f->froxels;
        return part;
    }
    if (which == FIXTURE_CURVATURE) {
        add_fixture_channel(&part, c, "curvature", f->color, 4);
        return part;
    }
    if (which >= FIXTURE_CLOUD_DENSITY && which <= FIXTURE_CLOUD_NOISE) {
        static const char *const values[] = {"density", "height", "noise"};
        part.width = which == FIXTURE_CLOUD_NOISE ? 4 : 5;
        part.height = 16;
        add_fixture_channel(&part, c, values[which - FIXTURE_CLOUD_DENSITY], f->color + 1, 1);
        return part;
    }
    const float *color = cube ? f->cube : f->color;
    const size_t stride = cube ? 5 : 4;
    for (size_t i = 0; i < 3; i++) add_fixture_channel(&part, c, rgba[i], color + i, stride);
    if (which == FIXTURE_CUBEMAP_0 || which == FIXTURE_CUBEMAP_1) {
        add_fixture_channel(&part, c, "A", color + 3, stride);
        add_fixture_channel(&part, c, "distance.Z", color + 4, stride);
        part.cubemap = &f->cubemap;
    }
    if (which == FIXTURE_SKY) part.sky = &f->sky;
    if (which == FIXTURE_PROBE || which == FIXTURE_PROBE_1) part.probe = &f->probe[which - FIXTURE_PROBE];
    if (which == FIXTURE_TRANSPARENT || which == FIXTURE_WATER) {
        add_fixture_channel(&part, c, which == FIXTURE_WATER ? "opacity" : "A", color + 3, stride);
        for (size_t i = 0; i < 4; i++) add_fixture_channel(&part, c, gbuffer_names[i], f->gbuffer + i, 17);
        if (which == FIXTURE_WATER) add_fixture_channel(&part, c, "thickness.Z", f->gbuffer + 5, 17);
        else add_fixture_channel(&part, c, "material.roughness", f->gbuffer + 4, 17);
    }
    if (which == FIXTURE_PLANAR) {
        add_fixture_channel(&part, c, "depth.Z", f->gbuffer, 17);
        part.planar = &f->planar;
    }
    if (which == FIXTURE_INDIRECT) part.indirect = &f->indirect;
    if (which == FIXTURE_TRUTH_INDIRECT || which == FIXTURE_TRUTH_LAMPS)
        add_fixture_channel(&part, c, "error", f->gbuffer + 4, 17);
    if (which == FIXTURE_TRUTH) {
        add_fixture_channel(&part, c, "weight", color + 3, stride);
        add_fixture_channel(&part, c, "error", f->gbuffer + 4, 17);
    }
    return part;
}

bool fixture_write(const struct fixture *f, const char *path, int count, const struct glint_writer_options *options,
                   struct glint_error *err) {
    struct glint_writer *writer = glint_writer_create(path, options, err);
    const struct glint_frame frame = fixture_frame();
    bool ok = writer && glint_writer_set_frame(writer, &frame, err);
    for (int i = 0; ok && i < count; i++) {
        struct fixture_channels channels;
        const struct glint_part part = fixture_part(f, (enum fixture_part)i, &channels);
        ok = glint_writer_add_part(writer, &part, err);
    }
    ok = ok && glint_writer_finish(writer, err) && glint_writer_wait(writer, err);
    glint_writer_destroy(&writer);
    return ok;
}

static char folder[512];

static void remove_folder(void) {
    rmdir(folder);
}

/* Of this run of the test alone. */
static void make_folder(void) {
    const char *root = getenv(TEMPORARY);
#ifdef _WIN32
    snprintf(folder, sizeof folder, "%.400s/glint-test-%ld", root ? root : ".", (long)getpid());
    const bool made = !mkdir(folder, 0700);
#else
    snprintf(folder, sizeof folder, "%.400s/glint-test-XXXXXX", root ? root : "/tmp");
    const bool made = mkdtemp(folder) != NULL;
#endif
    if (!made) {
        perror(folder);
        exit(1);
    }
    atexit(remove_folder);
}

const char *fixture_path(char buffer[512], const char *name) {
    if (!folder[0]) make_folder();
    const size_t length = strlen(folder);
    memcpy(buffer, folder, length);
    snprintf(buffer + length, 512 - length, "/%s", name);
    return buffer;
}

/* A device with validation and a tiny capture: a floor with roughness from mirror to rough, a wall and sky. */
#include "fixture.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "unit.h"

enum { W = FIXTURE_WIDTH, H = FIXTURE_HEIGHT, N = FIXTURE_FACE };

/* A camera at (0, 1.5, 0) that looks along -Z at a floor at y = 0 and a wall at z = -6, with sky above the wall's 3 m. */
struct gbuffer {
    float depth[H][W], normal[H][W][3], material[H][W][3], albedo[H][W][3], lit[H][W][3];
};

static void trace_pixel(struct gbuffer *g, int x, int y, bool matte) {
    const double dx = ((x + 0.5) / W * 2 - 1) * 0.9, dy = (1 - (y + 0.5) / H * 2) * 0.55;
    const double wall = 6, wall_y = 1.5 + dy * wall, floor = dy < 0 ? -1.5 / dy : INFINITY;
    const bool on_floor = floor < wall, sky = !on_floor && wall_y > 3;
    const double depth = sky ? INFINITY : on_floor ? floor : wall;
    g->depth[y][x] = (float)depth;
    g->normal[y][x][0] = 0, g->normal[y][x][1] = on_floor, g->normal[y][x][2] = on_floor ? 0 : 1;
    g->material[y][x][0] = (float)(0.02 + 0.5 * x / W);           /* roughness */
    g->material[y][x][1] = !matte && x % 11 == 0 ? 1 : 0;         /* metalness */
    g->material[y][x][2] = !matte && on_floor && !sky ? 0.5f : 0; /* specular */
    for (int c = 0; c < 3; c++) {
        const double check = sky || fmod(fabs(dx * depth) + fabs(depth), 2) < 1 ? 0.8 : 0.2;
        g->albedo[y][x][c] = (float)(check * (0.5 + 0.2 * c));
        g->lit[y][x][c] = (float)(sky ? 1.0 + c : check * (0.4 + 0.1 * c) + 0.01 * y);
    }
}

static bool add_gbuffer(struct glint_writer *writer, const struct gbuffer *g, struct glint_error *err) {
    const size_t three = 3 * sizeof(float);
    const struct glint_channel channels[] = {
        {"depth.Z", GLINT_F32, g->depth, 0, 0, NULL},
        {"normal.X", GLINT_F32, &g->normal[0][0][0], three, 0, NULL},
        {"normal.Y", GLINT_F32, &g->normal[0][0][1], three, 0, NULL},
        {"normal.Z", GLINT_F32, &g->normal[0][0][2], three, 0, NULL},
        {"material.roughness", GLINT_F32, &g->material[0][0][0], three, 0, NULL},
        {"material.metalness", GLINT_F32, &g->material[0][0][1], three, 0, NULL},
        {"material.specular", GLINT_F32, &g->material[0][0][2], three, 0, NULL},
        {"albedo.R", GLINT_F32, &g->albedo[0][0][0], three, 0, NULL},
        {"albedo.G", GLINT_F32, &g->albedo[0][0][1], three, 0, NULL},
        {"albedo.B", GLINT_F32, &g->albedo[0][0][2], three, 0, NULL},
    };
    const struct glint_channel lit[] = {{"R", GLINT_F32, &g->lit[0][0][0], three, 0, NULL},
                                        {"G", GLINT_F32, &g->lit[0][0][1], three, 0, NULL},
                                        {"B", GLINT_F32, &g->lit[0][0][2], three, 0, NULL}};
    return glint_writer_add_part(writer,
                                 &(struct glint_part){.name = "gbuffer",
                                                      .width = W,
                                                      .height = H,
                                                      .channels = channels,
                                                      .channel_count = sizeof channels / sizeof channels[0]},
                                 err) &&
           glint_writer_add_part(
               writer,
               &(struct glint_part){.name = "lit", .width = W, .height = H, .channels = lit, .channel_count = 3}, err);
}

/* A cube map of a box of 6 m around its centre, whose colours identify the cube map and the face. */
static bool add_cubemap(struct glint_writer *writer, int number, int color, const char *sibling,
                        struct glint_error *err) {
    static const char *const names[] = {"R", "G", "B", "A", "distance.Z"};
    float texels[6 * N][N][5];
    char name[32];
    for (int y = 0; y < 6 * N; y++)
        for (int x = 0; x < N; x++) {
            const double u = (x + 0.5) / N * 2 - 1, v = (y % N + 0.5) / N * 2 - 1;
            const bool sky = y / N == 2; /* +Y */
            texels[y][x][0] = (float)(0.2 + 0.1 * color), texels[y][x][1] = (float)(0.1 * (y / N));
            texels[y][x][2] = (float)(0.5 + 0.4 * u), texels[y][x][3] = !sky;
            texels[y][x][4] = sky ? INFINITY : (float)(3 * sqrt(1 + u * u + v * v));
        }
    struct glint_channel channels[5];
    for (int c = 0; c < 5; c++)
        channels[c] = (struct glint_channel){names[c], GLINT_F32, &texels[0][0][c], sizeof texels[0][0], 0, NULL};
    const struct glint_cubemap cubemap = {.center = {number - 1.0, 1.5, -2.0 - number}, .outdoor = number == 2};
    snprintf(name, sizeof name, "cubemap.%03d", number);
    struct glint_part part = {.name = name, .cubemap = &cubemap, .sibling = sibling};
    if (!sibling) part.width = N, part.height = 6 * N, part.channels = channels, part.channel_count = 5;
    return glint_writer_add_part(writer, &part, err);
}

static bool add_sky(struct glint_writer *writer, struct glint_error *err) {
    static const char *const names[] = {"R", "G", "B"};
    float texels[6 * N][N][3];
    for (int y = 0; y < 6 * N; y++)
        for (int x = 0; x < N; x++)
            for (int c = 0; c < 3; c++) texels[y][x][c] = (float)(1 + c + 0.1 * (y / N));
    struct glint_channel channels[3];
    for (int c = 0; c < 3; c++)
        channels[c] = (struct glint_channel){names[c], GLINT_F32, &texels[0][0][c], sizeof texels[0][0], 0, NULL};
    return glint_writer_add_part(
        writer,
        &(struct glint_part){.name = "sky", .width = N, .height = 6 * N, .channels = channels, .channel_count = 3},
        err);
}

bool fixture_write_capture(const char *path, const struct fixture_options *options, struct glint_error *err) {
    const double near = 0.1, far = 100;
    struct glint_frame frame = {
        .camera = {.world_to_view = {1, 0, 0, 0, 0, 1, 0, -1.5, 0, 0, 1, 0, 0, 0, 0, 1},
                   .view_to_clip = {1 / 0.9, 0, 0, 0, 0, 1 / 0.55, 0, 0, 0, 0, far / (near - far),
                                    near * far / (near - far), 0, 0, -1, 0}},
        .number = 7,
        .has_fog = true,
        .fog = {.color = {0.3f, 0.4f, 0.5f}, .density = 0.02}};
    if (options && options->number) frame.number = options->number;
    frame.cut = options && options->cut;
    struct gbuffer *g = calloc(1, sizeof *g);
    struct glint_writer *writer = glint_writer_create(path, NULL, err);
    bool ok = g && writer && glint_writer_set_frame(writer, &frame, err);
    for (int y = 0; ok && y < H; y++)
        for (int x = 0; x < W; x++) {
            trace_pixel(g, x, y, options && options->matte);
            g->depth[y][x] *= 1 + 0.125f * (float)(frame.number - 7);
        }
    ok = ok && add_gbuffer(writer, g, err);
    for (int i = 0; ok && i < FIXTURE_CUBEMAPS && !(options && options->no_cubemaps); i++)
        ok = add_cubemap(writer, i, i, options ? options->cubemaps : NULL, err);
    ok = ok && add_sky(writer, err);
    for (size_t i = 0; ok && options && i < options->extra_count; i++)
        ok = glint_writer_add_part(writer, &options->extra[i], err);
    ok = ok && glint_writer_finish(writer, err);
    glint_writer_destroy(&writer);
    free(g);
    return ok;
}

bool fixture_write_cubemaps(const char *path, int first, struct glint_error *err) {
    struct glint_writer *writer = glint_writer_create(path, NULL, err);
    bool ok = writer != NULL;
    for (int i = 0; ok && i < FIXTURE_CUBEMAPS; i++) ok = add_cubemap(writer, i, first + i, NULL, err);
    ok = ok && glint_writer_finish(writer, err);
    glint_writer_destroy(&writer);
    return ok;
}

/* False if a device is required but missing, or is not validated. Without a device the tests are skipped. */
static bool make_device(struct fixture *fixture, struct glint_error *err) {
    fixture->device =
        glint_device_create(&(struct glint_device_options){.validation = !getenv("GLINT_TEST_UNCHECKED")}, err);
    if (fixture->device) return true;
    struct glint_device *unchecked = glint_device_create(NULL, &(struct glint_error){0});
    const bool exists = unchecked != NULL;
    if (exists) glint_device_destroy(&unchecked);
    const char *required = getenv("GLINT_REQUIRE_DEVICE");
    if (exists || (required && strcmp(required, "1") == 0)) return false;
    print_message("no device: %s\n", err->message);
    return true;
}

static bool setup(struct fixture *fixture, bool with_device) {
    struct glint_error err = {0};
    const char *parent = getenv("TMPDIR");
    snprintf(fixture->folder, sizeof fixture->folder, "%s/glint-replay-XXXXXX", parent ? parent : "/tmp");
    if (!mkdtemp(fixture->folder)) return false;
    snprintf(fixture->capture_path, sizeof fixture->capture_path, "%s/capture.exr", fixture->folder);
    bool ok = fixture_write_capture(fixture->capture_path, NULL, &err) &&
              (fixture->capture = glint_capture_open(fixture->capture_path, NULL, &err)) &&
              (fixture->pipeline = glint_pipeline_create(GLINT_TEST_PRESET, &err));
    ok = ok && (!with_device || make_device(fixture, &err));
    if (ok && fixture->device)
        ok = (fixture->replay = glint_replay_create(fixture->device, &err)) &&
             glint_replay_load(fixture->replay, fixture->capture, &err);
    if (!ok) print_message("%s\n", err.message);
    return ok;
}

static int setup_group(void **state, bool with_device) {
    struct fixture *fixture = calloc(1, sizeof *fixture);
    *state = fixture;
    return fixture && setup(fixture, with_device) ? 0 : -1;
}

int fixture_setup_device(void **state) {
    return setup_group(state, true);
}
int fixture_setup_host(void **state) {
    return setup_group(state, false);
}

/* Removes a folder of files and of folders of files. */
static void remove_folder(const char *path) {
    DIR *folder = opendir(path);
    char entry[512];
    for (struct dirent *e; folder && (e = readdir(folder));) {
        if (e->d_name[0] == '.') continue;
        snprintf(entry, sizeof entry, "%s/%s", path, e->d_name);
        if (unlink(entry) != 0) remove_folder(entry);
    }
    if (folder) closedir(folder);
    rmdir(path);
}

int fixture_teardown(void **state) {
    struct fixture *fixture = *state;
    if (!fixture) return 0;
    if (fixture->replay) glint_replay_destroy(&fixture->replay);
    if (fixture->pipeline) glint_pipeline_destroy(&fixture->pipeline);
    if (fixture->capture) glint_capture_close(&fixture->capture);
    if (fixture->device) glint_device_destroy(&fixture->device);
    remove_folder(fixture->folder);
    free(fixture);
    return 0;
}

struct fixture *fixture_need_device(void **state) {
    struct fixture *fixture = *state;
    if (!fixture->device) skip();
    return fixture;
}

void fixture_check_messages(const struct fixture *fixture) {
    const char *last;
    if (glint_device_messages(fixture->device, &last)) fail_msg("validation: %s", last);
}

void snapshot_take(struct snapshot *snapshot, struct glint_replay *replay) {
    *snapshot = (struct snapshot){0};
    struct glint_error err = {0};
    for (size_t i = 0; i < glint_replay_image_count(replay); i++) {
        const struct glint_image *image = glint_replay_image(replay, i);
        static const struct {
            enum glint_type type;
            size_t bytes;
        } types[] = {[GLINT_FORMAT_R8UI] = {GLINT_U8, 1},     [GLINT_FORMAT_R32UI] = {GLINT_U32, 4},
                     [GLINT_FORMAT_R16F] = {GLINT_F16, 2},    [GLINT_FORMAT_RG16F] = {GLINT_F16, 2},
                     [GLINT_FORMAT_RGBA16F] = {GLINT_F16, 2}, [GLINT_FORMAT_R32F] = {GLINT_F32, 4},
                     [GLINT_FORMAT_RG32F] = {GLINT_F32, 4},   [GLINT_FORMAT_RGBA32F] = {GLINT_F32, 4}};
        size_t bytes = (size_t)image->width * image->height * image->components * types[image->format].bytes;
        assert_true(snapshot->count < 64);
        void *data = malloc(bytes);
        assert_non_null(data);
        if (!glint_replay_read_image(replay, image, types[image->format].type, data, &err)) fail_msg("%s", err.message);
        snprintf(snapshot->images[snapshot->count].name, 64, "%s", image->name);
        snapshot->images[snapshot->count].slot = image->pass->slot;
        snapshot->images[snapshot->count].bytes = bytes;
        snapshot->images[snapshot->count++].data = data;
    }
}

void snapshot_free(struct snapshot *snapshot) {
    for (size_t i = 0; i < snapshot->count; i++) free(snapshot->images[i].data);
    snapshot->count = 0;
}

size_t snapshot_compare(const struct snapshot *part, const struct snapshot *whole) {
    for (size_t i = 0; i < part->count; i++) {
        size_t j = 0;
        while (j < whole->count && strcmp(part->images[i].name, whole->images[j].name) != 0) j++;
        if (j == whole->count) fail_msg("image %s is not in the whole run", part->images[i].name);
        assert_int_equal(part->images[i].bytes, whole->images[j].bytes);
        if (memcmp(part->images[i].data, whole->images[j].data, part->images[i].bytes) != 0)
            fail_msg("image %s differs", part->images[i].name);
    }
    return part->count;
}

void fixture_run(struct fixture *fixture, const struct glint_replay_options *options) {
    struct glint_error err = {0};
    if (!glint_replay_run(fixture->replay, fixture->pipeline, options, NULL, NULL, &err)) fail_msg("%s", err.message);
}

void fixture_write_run(struct fixture *fixture, const char *name, char path[128]) {
    struct glint_error err = {0};
    snprintf(path, 128, "%s/%s", fixture->folder, name);
    if (!glint_replay_write(fixture->replay, path, NULL, NULL, &err)) fail_msg("%s", err.message);
}

const struct glint_pass_result *fixture_result(const struct fixture *fixture, const char *slot) {
    size_t count;
    const struct glint_pass_result *results = glint_replay_results(fixture->replay, &count);
    for (size_t i = 0; i < count; i++)
        if (strcmp(results[i].pass->slot, slot) == 0) return &results[i];
    fail_msg("no result of %s", slot);
    return NULL;
}

bool fixture_stop_at_resolve(void *user, const char *what, double done) {
    (void)user, (void)done;
    return strcmp(what, "resolve") != 0;
}

void fixture_says(const struct glint_error *err, const char *part) {
    if (!strstr(err->message, part)) fail_msg("expected '%s' in: %s", part, err->message);
}

/* Pictures of any size: rays against replays in double precision, and a whole pipeline against the closed form of a mirror
   floor before a wall. */
#include <math.h>
#include <stdlib.h>

#include "cases/rays/rays_lists.h"
#include "cases/rays/screen_rays.h"
#include "oracles/plane_scene.h"

static const uint32_t sizes[][2] = {{1, 1}, {7, 3}, {641, 359}, {1919, 1079}, {3840, 2160}};

static void check_rays(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    const uint32_t *size = sizes[c->number], pixels = size[0] * size[1];
    const struct plane_scene scene = {.rays = RAYS_ANY, .seed = 1000};
    const struct plain plain = plane_scene_capture(&scene, size[0], size[1]);
    screen_rays(run, &plain, c, 1 + pixels / 9973, finding); /* a stride that is not a multiple of a row */
}

/* ---- The floor ---- */

static const double degrees = 60, wall_m = 5, light_part = 2e-3;

static void around(uint32_t number, const double d[3], float out[5]) {
    (void)number;
    for (int k = 0; k < 4; k++) out[k] = 1;
    out[4] = (float)(10 / fmax(fabs(d[0]), fmax(fabs(d[1]), fabs(d[2]))));
}

static void above(const double d[3], float out[3]) {
    for (int k = 0; k < 3; k++) out[k] = (float)(0.5 + 0.4 * d[k]);
}

/* The expected result of a half-resolution texel's ray: -1 not traced, 0 no hit in the picture, 1 hits the wall, 2 too close to the picture's border or
   to its start to be decided. */
static int floor_ray(const uint32_t size[2], double x, double y, double depth_m, double *t, double *red) {
    const double half = tan(degrees * 3.14159265358979323846 / 360) / size[1]; /* half a pixel at a depth of 1 */
    const double down = (2 * y - size[1]) * half, side = (2 * x - size[0]) * half;
    if (!(down * wall_m > 1)) return -1;
    *t = (wall_m - depth_m) * sqrt(1 + down * down + side * side);
    *red = 0.5 + 0.4 * sin(0.1 * x);
    const double height = down * (wall_m - 2 * depth_m), row = 0.5 * size[1] - height / (2 * half * wall_m);
    if (fabs(row) < 4 || (y - row) < 6) return 2;
    return row > 0;
}

static void check_floor_ray(const uint32_t size[2], uint32_t i, uint32_t width, uint32_t pick, double depth_m,
                            double found, uint32_t finished, const float *color,
                            struct glint_selftest_finding *finding) {
    const uint32_t x = 2 * (i % width) + (pick & 1), y = 2 * (i / width) + (pick >> 1);
    double t = 0, red = 0, error = 0;
    const int expected = floor_ray(size, x + 0.5, y + 0.5, depth_m, &t, &red);
    if (expected == 2) return;
    if (expected < 0)
        error = pick < 4 && finished <= 1 ? 0 : INFINITY; /* rays from the wall leave towards the viewer */
    else if (expected != (finished != 0)) error = INFINITY;
    else if (expected == 1) error = fmax(fabs(found - t) / wall_m, light_part * fabs((double)color[0] - red));
    else error = found < t ? 0 : INFINITY;
    finding_compare(finding, error, "pixel %u,%u: travelled %.9g m, red %.6g, expected %.9g m, %.6g", x, y, found,
                    (double)color[0], t, red);
}

static void check_pipeline(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    static const char *const outputs[] = {"screen_travelled", "screen_finished", "pick", "depth_half",
                                          "reflection_half",  "composed",        NULL};
    const uint32_t *size = sizes[c->number];
    uint32_t width = 0, height = 0, full[2] = {0};
    struct plain plain = {.width = size[0],
                          .height = size[1],
                          .fov_y_degrees = degrees,
                          .floor = true,
                          .cube_size = 8,
                          .cube_count = 1,
                          .cube = around,
                          .sky = above};
    run->half = true;
    run->outputs = outputs;
    case_run_pipeline(run, c->use);
    case_run_plain(run, &plain);
    float *t = case_run_floats(run, "screen_travelled", &width, &height),
          *depth_m = case_run_floats(run, "depth_half", NULL, NULL);
    uint32_t *finished = case_run_uints(run, "screen_finished", NULL, NULL),
             *pick = case_run_uints(run, "pick", NULL, NULL);
    float *color = case_run_floats(run, "reflection_half", NULL, NULL),
          *composed = case_run_floats(run, "composed", &full[0], &full[1]);
    for (uint32_t i = 0; run->ok && i < width * height; i++)
        check_floor_ray(size, i, width, pick[i], (double)depth_m[i], (double)t[i], finished[i], &color[4 * i], finding);
    if (run->ok && (full[0] != size[0] || full[1] != size[1]))
        finding_compare(finding, INFINITY, "%u x %u pixels", full[0], full[1]);
    for (size_t i = 0; run->ok && i < 4 * (size_t)size[0] * size[1]; i++) /* all texels are written and finite */
        if (!(i % 4 == 3 ? composed[i] == 1 : composed[i] >= 0 && composed[i] < 100))
            finding_compare(finding, INFINITY, "pixel %zu,%zu channel %zu: composed %.9g", i / 4 % size[0],
                            i / 4 / size[0], i % 4, (double)composed[i]);
    finding->values += (size_t)size[0] * size[1];
    free(t), free(depth_m), free(finished), free(pick), free(color), free(composed);
}

/* clang-format off */
#define PIPELINE(trace) "downsample=pick downsample.jitter=false hiz=nearest lit_mips=cone sky_mips=prefilter cubemap_active=nearest cubemap_mips=prefilter cocoon=max " \
    trace " cubemap_select=score cubemap_trace=march resolve=hit resolve.fog=false blur=plus temporal=rough " \
    "upscale=best_match resolve_sharp=hit temporal_sharp=clamped compose=brdf"
#define BY_HIZ PIPELINE("screen_trace=hiz screen_trace.cells=65536 screen_trace.cells_lq=65536")
#define BY_STEPS PIPELINE("screen_trace=linear")
#define FLOOR "every ray hits the wall at the point of the closed form and returns its light; every pixel is written and finite"
#define FLOOR_REASON "thirty roundings of 2^-24 of the wall's depth, a division being 2.5 ULP; light errs by 5e-4 in bilinear interpolation and twice 2.4e-4 as half floats: 2e-3 of that counts"
#define RAYS(text, n, slow) {text ", in a pyramid", "rays of every direction between boards at all angles", SCREEN_UNIT, 5e-6, SCREEN_REASON, check_rays, SCREEN_HIZ, n, slow}
#define WHOLE(text, use, n, slow) {text ", whole", FLOOR, "of the depth", 2e-6, FLOOR_REASON, check_pipeline, use, n, slow}
static const struct replay_case items[] = {
    RAYS("1 x 1", 0, false), RAYS("7 x 3", 1, false), RAYS("641 x 359", 2, true), RAYS("1919 x 1079", 3, true),
    WHOLE("1 x 1", BY_HIZ, 0, false), WHOLE("7 x 3", BY_HIZ, 1, false), WHOLE("641 x 359", BY_HIZ, 2, false), WHOLE("641 x 359 in steps", BY_STEPS, 2, false), WHOLE("1919 x 1079", BY_HIZ, 3, true), WHOLE("3840 x 2160", BY_HIZ, 4, true),
};
/* clang-format on */

const struct replay_case_list sizes_screen = {items, sizeof items / sizeof *items};

/* Histories seen by moving cameras: reprojection by both cameras, and the maximum length of a history when the view turns. */
#include <math.h>

#include "cases/time/history_case.h"

static double length_of(const double *v) {
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* ---- Where a pixel was, from its stored depth ---- */

struct sight {
    double place[3], towards[3]; /* the surface, and the unit vector from the camera to it */
};

static struct sight sight_of(const struct frame *frame, size_t pixel) {
    const double x = (double)(pixel % FRAME_WIDTH), y = (double)(pixel / FRAME_WIDTH);
    struct sight s;
    double eye[3];
    frame_position(frame, x, y, (double)frame->depth[pixel], s.place);
    frame_position(frame, x, y, 0, eye);
    for (int k = 0; k < 3; k++) s.towards[k] = s.place[k] - eye[k];
    const double length = length_of(s.towards);
    for (int k = 0; k < 3; k++) s.towards[k] /= length;
    return s;
}

/* The history is on the pixel grid without the jitter of either frame. */
static void seen_at(const struct frame *frame, const double place[3], struct history_texels *past) {
    const double *then = frame->info.previous.view_to_clip, *now = frame->info.camera.view_to_clip;
    double view[3];
    frame_to_view(&frame->info.previous, place, view);
    past->count = 0;
    if (!(view[2] < 0)) return;
    const double u = 0.5 + 0.5 * (then[0] * view[0] / -view[2] - now[2]);
    const double v = 0.5 - 0.5 * (then[5] * view[1] / -view[2] - now[6]);
    if (u >= 0 && u <= 1 && v >= 0 && v <= 1) history_texels_at(past, u * FRAME_WIDTH, v * FRAME_HEIGHT);
}
static void surface_seen(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)n;
    seen_at(frame, sight_of(frame, pixel).place, past);
}
/* The mirrored hit point, at the hit distance behind the surface; 10^9 m for rays without a hit. */
static void reflection_seen(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    struct sight s = sight_of(frame, pixel);
    (void)n;
    for (int k = 0; k < 3; k++) s.place[k] += s.towards[k] * fmin((double)frame->travelled[pixel], 1e9);
    seen_at(frame, s.place, past);
}

/* A quarter of the lobe, whose half width is twice the angle at which GGX's density is a tenth, divided by the turn of the view. */
static void limit_history(const struct frame *frame, size_t pixel, struct history_texels *past) {
    const struct sight s = sight_of(frame, pixel);
    double view[3], apart[3];
    frame_to_view(&frame->info.previous, s.place, view);
    const double *m = frame->info.previous.world_to_view, length = length_of(view);
    for (int k = 0; k < 3; k++)
        apart[k] = (m[k] * view[0] + m[4 + k] * view[1] + m[8 + k] * view[2]) / length - s.towards[k];
    const double turned = length_of(apart) - 1e-6, a2 = pow((double)frame->roughness[pixel], 4);
    const double angle = asin(sqrt((1 / sqrt(0.1) - 1) / (1 / a2 - 1)));
    if (!(turned > 0)) return;
    past->longest = fmin(past->longest, 0.25 * 2 * angle / turned);
    if (past->longest < 1) past->count = 0;
}
static void surface_turned(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    surface_seen(frame, n, pixel, past);
    limit_history(frame, pixel, past);
}
static void view_turned(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)n;
    limit_history(frame, pixel, past);
}

/* ---- Cameras ---- */

static void set_camera(struct frame *frame, int n, double x, double y, double z, double turn) {
    const double now[3] = {n * x, n * y, n * z}, before[3] = {(n - 1) * x, (n - 1) * y, (n - 1) * z};
    frame_cameras(frame, now, before, n * turn, (n - 1) * turn);
}
/* Depth of a wall across z. */
static void wall_at(struct frame *frame, double z) {
    for (size_t i = 0; i < FRAME_PIXELS; i++) {
        double far[3], eye[3];
        frame_position(frame, (double)(i % FRAME_WIDTH), (double)(i / FRAME_WIDTH), 1, far);
        frame_position(frame, (double)(i % FRAME_WIDTH), (double)(i / FRAME_WIDTH), 0, eye);
        frame->depth[i] = (float)((z - eye[2]) / (far[2] - eye[2]));
    }
}
static void pan(struct frame *frame, int n) {
    set_camera(frame, n, frame_pixel_m, -2 * frame_pixel_m, 0, 0);
}
static void forward(struct frame *frame, int n) {
    set_camera(frame, n, 0, 0, -0.3, 0);
    wall_at(frame, -8);
}
static void turn_camera(struct frame *frame, int n) {
    set_camera(frame, n, 0, 0, 0, 0.013);
    wall_at(frame, -8);
}
/* The camera moves forth and back, past the object that it looks at. */
static void there_and_back(struct frame *frame, int n) {
    static const double places[2][3] = {{0, 0, 0}, {0, 0, -6}};
    frame_cameras(frame, places[n % 2], places[(n + 1) % 2], 0, 0);
}

static void pan_by_roughness(struct frame *frame, int n) {
    static const float rough[4] = {0, 0.3f, 0.5f, 0.8f};
    pan(frame, n);
    for (size_t i = 0; i < FRAME_PIXELS; i++) frame->roughness[i] = rough[i / FRAME_WIDTH / 2 % 4];
}
/* A small movement, and motion vectors that state the same position. */
static void shift_of_mirrors(struct frame *frame, int n) {
    set_camera(frame, n, 0.0005, 0, 0, 0);
    for (size_t i = 0; i < FRAME_PIXELS; i++) frame->roughness[i] = i / FRAME_WIDTH % 2 ? 0.06f : 0.04f;
}
static void reflections(struct frame *frame, int n) {
    set_camera(frame, n, 4 * frame_pixel_m, 0, 0, 0);
    for (size_t i = 0; i < FRAME_PIXELS; i++) {
        const struct sight s = sight_of(frame, i);
        const double away = hypot(hypot(s.place[0] - 4 * n * frame_pixel_m, s.place[1]), s.place[2]);
        const double times[4] = {0, 1, 3, (double)INFINITY};
        frame->travelled[i] = i / FRAME_WIDTH % 4 == 3 ? INFINITY : (float)(away * times[i / FRAME_WIDTH % 4]);
    }
}
static void jittered(struct frame *frame, int n) {
    static const double places[5][2] = {{0, -0.17}, {-0.25, 0.17}, {0.25, -0.39}, {-0.375, -0.06}, {0.31, 0.44}};
    static const double pixels[2] = {-2.0 / FRAME_WIDTH, 2.0 / FRAME_HEIGHT};
    for (int k = 0; k < 2; k++) {
        const double now = places[n % 5][k], before = places[(n + 4) % 5][k];
        frame->info.jitter_px[k] = now;
        frame->info.camera.view_to_clip[k ? 6 : 2] = pixels[k] * now;
        frame->info.previous.view_to_clip[k ? 6 : 2] = pixels[k] * before;
        for (size_t i = 0; i < FRAME_PIXELS; i++)
            frame->motion[k][i] = (float)((before - now) / (k ? FRAME_HEIGHT : FRAME_WIDTH));
    }
}

#define PLACES                                                                                                         \
    "places are rounded by 1e-5 of a pixel in either direction, between colours that are 2 apart, and samples 15"
#define ALONE "temporal.extra=false"
#define CAMERAS "temporal.motion=false"
#define TURNS "temporal.divergence=1e6"

/* clang-format off */
static const struct shot list[] = {
    {"camera across", "the camera moves sideways past a wall: the history follows by the cameras alone", {ALONE, CAMERAS, TURNS}, .frames = 6, .stage = pan, .past = surface_seen, .bound = 1e-4, .reason = PLACES},
    {"camera forwards", "the camera approaches a wall: its history is scaled", {ALONE, CAMERAS, TURNS}, .frames = 6, .stage = forward, .past = surface_seen, .bound = 1e-4, .reason = PLACES},
    {"camera turning", "does not rotate the view: the history keeps its length", {ALONE, CAMERAS}, .frames = 6, .stage = turn_camera, .past = surface_turned, .bound = 1e-4, .reason = PLACES},
    {"behind the camera before", "points behind the previous camera have no history, whatever their depth", {ALONE, CAMERAS, TURNS, "temporal.history_depth=10"}, .frames = 4, .stage = there_and_back, .past = surface_seen, .bound = 1e-4, .reason = PLACES},
    {"views that turn", "smoother surfaces have a shorter history; a mirror has none", {ALONE, CAMERAS}, .frames = 8, .stage = pan_by_roughness, .past = surface_turned, .bound = 1e-4, .reason = PLACES},
    {"reflections' places", "reprojected as far behind the surface as the ray travelled: 0 to infinite", {ALONE, "temporal.reprojection=reflection"}, .frames = 6, .stage = reflections, .past = reflection_seen, .bound = 1e-4, .reason = PLACES},
    {"jitter", "by the cameras: a still camera does not resample the history", {ALONE, CAMERAS}, .frames = 12, .stage = jittered, .bound = 1e-4, .reason = PLACES},
    {"jitter in motion vectors", "the same with motion vectors that include it", {ALONE}, .frames = 12, .stage = jittered, .bound = 1e-4, .reason = PLACES},
    {"views of mirrors that turn", "at full resolution, with a history of a given number of frames", {"temporal_sharp.clamp_history=false"}, .sharp = true, .frames = 4, .stage = shift_of_mirrors, .past = view_turned,
     .bound = 2e-4, .reason = "the rotation, 1.2e-4, is a difference of unit vectors that are rounded by 6e-8, minus 1e-6; it determines the weight of a history of 5 to 10"},
};
/* clang-format on */

const struct shot_list time_views = {
    list, sizeof list / sizeof *list,
    "reproject(uv, position, full_pixel, travelled_m), history_limit(longest, roughness, turned, ggx)"};

/* Histories of surfaces seen by a static camera: means, cuts, objects that appear and disappear, motion vectors. */
#include <math.h>

#include "cases/time/history_case.h"

#define EACH(pixel) for (size_t pixel = 0; pixel < FRAME_PIXELS; pixel++)
static size_t column(size_t pixel) {
    return pixel % FRAME_WIDTH;
}
static size_t row_of_pixel(size_t pixel) {
    return pixel / FRAME_WIDTH;
}

/* ---- Means ---- */

static void up_to_255(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)frame, (void)n, (void)pixel;
    past->longest = 255;
}
static void nothing(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)frame, (void)n, (void)pixel;
    past->count = 0;
}
static void fill_history(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)frame, (void)n, (void)pixel;
    past->longest = 1;
}
static void even_colour(struct frame *frame, int n) {
    (void)n;
    EACH(i) frame->color[0][i] = frame->color[1][i] = frame->color[2][i] = 0.7f;
}
static void colours_in_halves(struct frame *frame, int n) {
    (void)n;
    EACH(i) for (int k = 0; k < 3; k++) frame->color[k][i] = floorf(512 * frame->color[k][i]) / 512;
}
static void cut_at_4(struct frame *frame, int n) {
    frame->info.cut = n == 4;
}
static void gap_at_4(struct frame *frame, int n) {
    frame->info.number += n >= 4;
}
static void nothing_at_4(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)frame, (void)pixel;
    if (n == 4) past->count = 0;
}
static void from_0(struct frame *frame, int n) {
    frame->info.number = (uint32_t)n - 1;
}
static void to_the_last(struct frame *frame, int n) {
    frame->info.number = UINT32_MAX - 3 + (uint32_t)n;
}

/* ---- What does not count ---- */

static void bad_colours(struct frame *frame, int n) {
    static const float bad[4] = {NAN, INFINITY, -INFINITY, 3.3e38f};
    EACH(i) if ((i + (size_t)n) % 3 == 0) frame->color[i % 4][i] = bad[(i / 4 + (size_t)n) % 4];
}
static void only_finite(const struct frame *frame, size_t pixel, bool has_past, double color[4], double *samples) {
    (void)frame, (void)pixel, (void)has_past;
    for (int k = 0; k < 4; k++)
        if (!(fabs(color[k]) < (double)3.0e38f)) *samples = 0;
}
static void nothing_found(struct frame *frame, int n) {
    EACH(i) if (n == 1 && i % 3 < 2) frame->color[3][i] = i % 3 == 0 ? -1.0f : 0.5f;
}
static void nothing_to_remember(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)frame;
    if (n == 2 && pixel % 3 == 0) past->count = 0;
}
/* Sky, unusable normals, depths of 0 and surfaces alternate. */
static int surface_kind(int n, size_t pixel) {
    return (int)((pixel / 2 + (size_t)n) % 8);
}
static void sky_and_bad_surfaces(struct frame *frame, int n) {
    EACH(i) {
        if (surface_kind(n, i) == 1) frame->depth[i] = INFINITY;
        if (surface_kind(n, i) == 3) frame->normal[2][i] = 0;
        if (surface_kind(n, i) == 5) frame->depth[i] = 0;
    }
}
static void surfaces_alone(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)frame;
    if (surface_kind(n, pixel) % 2 == 1 && surface_kind(n, pixel) < 6) past->count = 0;
    if (surface_kind(n - 1, pixel) % 2 == 1 && surface_kind(n - 1, pixel) < 6) past->count = 0;
}

/* ---- Objects ---- */

/* Three boards that move to the right by 4 pixels a frame, the first one into the picture: one is nearer than the wall, one is rotated, one is both.
   0: the wall. */
static int board(int n, int x, int y) {
    const int along = x - 4 * n;
    if (y >= 2 && y < 10 && along >= -14 && along < -2) return 1;
    if (y >= 12 && y < 20 && along >= 4 && along < 20) return 2;
    if (y >= 22 && y < 30 && along >= 30 && along < 44) return 3;
    return 0;
}
static void boards(struct frame *frame, int n) {
    EACH(i) {
        const int which = board(n, (int)column(i), (int)row_of_pixel(i));
        if (which & 1) frame->depth[i] = 2;
        if (which & 2) frame->normal[0][i] = 0.6f, frame->normal[2][i] = 0.8f;
        if (which) frame->motion[0][i] = -4.0f / FRAME_WIDTH;
    }
}
static void what_it_was_on(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)frame;
    const int x = (int)column(pixel), y = (int)row_of_pixel(pixel), which = board(n, x, y), from = which ? x - 4 : x;
    if (from < 0 || board(n - 1, from, y) != which) past->count = 0;
    else past->pixel[0] = (size_t)(y * FRAME_WIDTH + from);
}

/* Depth steps of 1 % and 2 %, and normals with cosines of 0.91 and 0.89: the first of each belongs to the same surface, the second does not. */
static const float steps[4] = {0.019f, -0.019f, 0.0215f, -0.0215f};
static void depth_steps(struct frame *frame, int n) {
    EACH(i) if (n % 2 == 0) frame->depth[i] *= 1 + steps[i % 4];
}
static void turned_normals(struct frame *frame, int n) {
    EACH(i) {
        if (n % 2 == 1) continue;
        frame->normal[2][i] = i % 4 < 2 ? 0.91f : 0.89f;
        frame->normal[i % 2][i] = sqrtf(1 - frame->normal[2][i] * frame->normal[2][i]);
    }
}
static void every_second_pair(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)frame, (void)n;
    if (pixel % 4 >= 2) past->count = 0;
}

/* ---- Motion vectors ---- */

static void move(struct frame *frame, double x, double y) {
    EACH(i) frame->motion[0][i] = (float)(x / FRAME_WIDTH), frame->motion[1][i] = (float)(y / FRAME_HEIGHT);
}
static void from_there(size_t pixel, double x, double y, struct history_texels *past) {
    x += (double)column(pixel) + 0.5, y += (double)row_of_pixel(pixel) + 0.5;
    history_texels_at(past, x, y);
    if (!(x >= 0 && y >= 0 && x <= FRAME_WIDTH && y <= FRAME_HEIGHT)) past->count = 0;
}
static void by_pixels(struct frame *frame, int n) {
    if (n % 2) move(frame, -3, 2);
    else move(frame, 5, -1);
}
static void from_pixels(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)frame;
    if (n % 2) from_there(pixel, -3, 2, past);
    else from_there(pixel, 5, -1, past);
}
static void by_parts(struct frame *frame, int n) {
    if (n % 2) move(frame, -0.25, 0.75);
    else move(frame, 2.5, -0.125);
}
static void from_parts(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)frame;
    if (n % 2) from_there(pixel, -0.25, 0.75, past);
    else from_there(pixel, 2.5, -0.125, past);
}
static void off_the_screen(struct frame *frame, int n) {
    static const float bad[6] = {NAN, INFINITY, -INFINITY, 1e30f, -1e30f, 1.5f};
    EACH(i) if (i % 7 < 6) frame->motion[(i / 7 + (size_t)n) % 2][i] = bad[i % 7];
}
static void every_seventh(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)frame, (void)n;
    if (pixel % 7 < 6) past->count = 0;
}

/* ---- Samples of neighbours ---- */

static const float rows_roughness[4] = {0.04f, 0.1f, 0.5f, 0.45f};
static void rough_by_rows(struct frame *frame, int n) {
    EACH(i) frame->roughness[i] = rows_roughness[row_of_pixel(i) % 4];
    cut_at_4(frame, n);
}
/* Without history a pixel also uses the samples at the centres of the neighbouring pluses, a knight's move away. */
static void with_centres(const struct frame *frame, size_t pixel, bool has_past, double color[4], double *samples) {
    static const int centres[4][2] = {{1, 2}, {2, -1}, {-1, -2}, {-2, 1}};
    const double own = (double)frame->roughness[pixel], part = fmin(fmax((own - 0.05) / 0.1, 0), 1);
    for (int i = 0; i < 4 && !has_past; i++) {
        const int x = (int)column(pixel) + centres[i][0], y = (int)row_of_pixel(pixel) + centres[i][1];
        const size_t there = (size_t)(y * FRAME_WIDTH + x);
        if (x < 0 || y < 0 || x >= FRAME_WIDTH || y >= FRAME_HEIGHT) continue;
        if (!(fabs((double)frame->roughness[there] - own) <= 0.1)) continue;
        for (int k = 0; k < 4; k++)
            color[k] = (*samples * color[k] + part * (double)frame->color[k][there]) / (*samples + part);
        *samples += part;
    }
}

/* Single bright pixels; surfaces in the lower half are smoother. */
static void hot_pixels(struct frame *frame, int n) {
    EACH(i) {
        if ((i * 7 + (size_t)n * 5) % 23 == 0)
            for (int k = 0; k < 3; k++) frame->color[k][i] *= 100;
        if (row_of_pixel(i) >= FRAME_HEIGHT / 2) frame->roughness[i] = 0.07f;
        if ((i + (size_t)n) % 29 == 0) frame->color[1][i] = NAN;
    }
}
static double luminance(const double *color) {
    return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
}
static void held_down(const struct frame *frame, size_t pixel, bool has_past, double color[4], double *samples) {
    static const int beside[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    double sum = 0, count = 0;
    only_finite(frame, pixel, has_past, color, samples);
    for (int i = 0; i < 4; i++) {
        const int x = (int)column(pixel) + beside[i][0], y = (int)row_of_pixel(pixel) + beside[i][1];
        const size_t there = (size_t)(y * FRAME_WIDTH + x);
        if (x < 0 || y < 0 || x >= FRAME_WIDTH || y >= FRAME_HEIGHT) continue;
        if (frame->roughness[there] != frame->roughness[pixel]) continue;
        const double other[3] = {(double)frame->color[0][there], (double)frame->color[1][there],
                                 (double)frame->color[2][there]};
        if (isfinite(other[1])) sum += luminance(other), count++;
    }
    const double bright = luminance(color), rough = row_of_pixel(pixel) >= FRAME_HEIGHT / 2 ? 0.2 : 1;
    const double most = bright + rough * (3 * sum / count - bright);
    for (int k = 0; k < 3 && count > 0 && bright > most; k++) color[k] *= most / bright;
}

#define ONE "two divisions, 2.5 ULP each (Vulkan), and four roundings, of colours below 2"
#define ALONE "temporal.extra=false"

/* clang-format off */
static const struct shot list[] = {
    {"running mean", "a still camera: n frames have equal weights up to 16, then the new one has 1/16", {ALONE}, .frames = 20, .bound = 1.6e-6, .reason = ONE},
    {"mean of 256 frames", "all frames have equal weights", {ALONE, "temporal.history=255"}, .summed = true, .frames = 256, .past = up_to_255,
     .bound = 2e-4, .reason = ONE ", in each frame, of which the mean of n keeps n/2"},
    {"mean in halves", "is the nearest half, whether a device rounds or cuts what it stores", {ALONE}, .half = true, .frames = 20, .stage = colours_in_halves,
     .bound = 4.9e-4, .reason = "half of the last place of a half below 2, 2^-11, and " ONE},
    {"one colour for ever", "variance zero: the mean does not drift in 48 frames", {ALONE}, .summed = true, .frames = 48, .stage = even_colour,
     .bound = 9e-6, .reason = ONE ": 16 frames' of 0.7"},
    {"history of none", "0 keeps nothing", {ALONE, "temporal.history=0"}, .frames = 3, .past = nothing, .bound = 0, .reason = "the frame's own bits"},
    {"history of one", "keeps half of the previous frame", {ALONE, "temporal.history=1"}, .frames = 3, .past = fill_history, .bound = 1.6e-6, .reason = ONE},
    {"after a cut", "no history from before it, and full history after it", {ALONE}, .frames = 6, .stage = cut_at_4, .past = nothing_at_4, .bound = 1.6e-6, .reason = ONE},
    {"after a gap", "frame numbers that are not consecutive are a cut", {ALONE}, .frames = 6, .stage = gap_at_4, .past = nothing_at_4, .bound = 1.6e-6, .reason = ONE},
    {"frame number 0", "frame number 0 can have a history, too", {ALONE}, .frames = 4, .stage = from_0, .bound = 1.6e-6, .reason = ONE},
    {"frame number 4294967295", "the next number is 0, and the history is used", {ALONE}, .frames = 6, .stage = to_the_last, .bound = 1.6e-6, .reason = ONE},

    {"colours that are none", "NaN, infinite and next to it: the history stays, with as many samples", {ALONE}, .frames = 6, .stage = bad_colours, .now = only_finite, .bound = 1.6e-6, .reason = ONE},
    {"rays that found nothing", "are not used as history; those with an alpha of 0.5 are", {ALONE}, .frames = 3, .stage = nothing_found, .past = nothing_to_remember, .bound = 1.6e-6, .reason = ONE},
    {"surfaces that are none", "sky, a depth of 0, a normal of length 0: they have no history and are not used as history", {ALONE}, .frames = 8, .stage = sky_and_bad_surfaces, .past = surfaces_alone, .bound = 1.6e-6, .reason = ONE},
    {"objects entering", "moving boards: disoccluded pixels and pixels that enter restart, the boards keep their history", {ALONE}, .frames = 12, .stage = boards, .past = what_it_was_on, .bound = 1.6e-6, .reason = ONE},
    {"steps of depth", "a difference of up to 2 % of the depth is the same surface, more is another", {ALONE}, .frames = 6, .stage = depth_steps, .past = every_second_pair, .bound = 1.6e-6, .reason = ONE},
    {"steps of normals", "a cosine of 0.91 is the same surface, one of 0.89 is another", {ALONE}, .frames = 6, .stage = turned_normals, .past = every_second_pair, .bound = 1.6e-6, .reason = ONE},

    {"motion by pixels", "the history follows; pixels from outside of the picture have none", {ALONE}, .frames = 8, .stage = by_pixels, .past = from_pixels, .bound = 1.6e-6, .reason = ONE},
    {"motion by parts of pixels", "bilinear mean of the four texels, as far as they are in the picture", {ALONE}, .frames = 8, .stage = by_parts, .past = from_parts,
     .bound = 4e-5, .reason = "places are rounded by 4e-6 of a pixel in either direction, between colours that are 2 apart, and samples 15"},
    {"motion off the screen", "NaN, infinite, huge, one and a half pictures: no history", {ALONE}, .frames = 4, .stage = off_the_screen, .past = every_seventh, .bound = 1.6e-6, .reason = ONE},

    {"samples for what is new", "without a history, samples at the centres of four pluses with similar roughness, weighted more on rough surfaces", {"temporal.extra=true"}, .frames = 5, .stage = rough_by_rows, .past = nothing_at_4, .now = with_centres,
     .bound = 4e-6, .reason = ONE ", and a sum of five"},
    {"single bright samples", "are clamped to three times their surroundings, less on smoother surfaces; invalid colours are ignored", {"temporal=outliers"}, .frames = 4, .stage = hot_pixels, .now = held_down, .bound = 1.6e-4, .reason = ONE " times 100"},
};
/* clang-format on */

const struct shot_list time_surfaces = {list, sizeof list / sizeof *list, NULL};

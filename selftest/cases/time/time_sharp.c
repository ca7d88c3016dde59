/* Histories of smooth surfaces, which are clamped to the current values of their neighbours. */
#include <math.h>

#include "cases/time/history_case.h"

#define EACH(pixel) for (size_t pixel = 0; pixel < FRAME_PIXELS; pixel++)
static const double limit = (double)0.1f;

static void mirrors(struct frame *frame, int n) {
    (void)n;
    EACH(i) frame->roughness[i] = 0;
}
static void cut_mirrors(struct frame *frame, int n) {
    mirrors(frame, n);
    frame->info.cut = n == 4;
}
static void three(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)frame, (void)n, (void)pixel;
    past->longest = 3;
}
static void fill_history(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)frame, (void)n, (void)pixel;
    past->longest = 1;
}
static void none(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)frame, (void)n, (void)pixel;
    past->count = 0;
}
static void nothing_at_4(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)frame, (void)pixel;
    if (n == 4) past->count = 0;
}

/* ---- Windows ---- */

static void smooth_by_rows(struct frame *frame, int n) {
    static const float rough[6] = {0, 0.05f, 0.08f, 0.1f, 0.11f, 0.5f};
    (void)n;
    EACH(i) frame->roughness[i] = rough[i / FRAME_WIDTH / 3 % 6];
}
static void smooth_alone(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)n;
    if (!((double)frame->roughness[pixel] <= limit)) past->count = 0;
}
/* Mean and deviation of the valid texels of the 3 x 3 neighbourhood, with texels at the border repeated. */
static void hold_by(const struct frame *frame, size_t pixel, double color[4], double window) {
    const int x = (int)(pixel % FRAME_WIDTH), y = (int)(pixel / FRAME_WIDTH);
    const double open = 1 - (double)frame->roughness[pixel] / limit;
    double sum[4] = {0}, squares[4] = {0}, count = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < 9; i++) {
            const int nx = (int)fmin(fmax(x + i % 3 - 1, 0), FRAME_WIDTH - 1);
            const int ny = (int)fmin(fmax(y + i / 3 - 1, 0), FRAME_HEIGHT - 1);
            const size_t there = (size_t)(ny * FRAME_WIDTH + nx);
            if (!isfinite((double)frame->color[0][there])) continue;
            count += pass == 0;
            for (int k = 0; k < 4 && pass == 0; k++) sum[k] += (double)frame->color[k][there];
            for (int k = 0; k < 4 && pass == 1; k++)
                squares[k] += pow((double)frame->color[k][there] - sum[k] / count, 2);
        }
    for (int k = 0; k < 4 && open > 1e-6 && count > 0; k++) {
        const double reach = window / open * sqrt(squares[k] / count), mean = sum[k] / count;
        color[k] = fmin(fmax(color[k], mean - reach), mean + reach);
    }
}
static void hold(const struct frame *frame, size_t pixel, double color[4]) {
    hold_by(frame, pixel, color, 1);
}
static void hold_at_mean(const struct frame *frame, size_t pixel, double color[4]) {
    hold_by(frame, pixel, color, 0);
}
static void hold_wide(const struct frame *frame, size_t pixel, double color[4]) {
    hold_by(frame, pixel, color, 1.5);
}

/* A different bright colour in each frame. */
static void bright(struct frame *frame, int n) {
    mirrors(frame, n);
    EACH(i) for (int k = 0; k < 3; k++) frame->color[k][i] = n % 2 ? 3000.7f : 1000.3f;
}
static void bright_noise(struct frame *frame, int n) {
    mirrors(frame, n);
    EACH(i) for (int k = 0; k < 3; k++) frame->color[k][i] = 1000 + frame->color[k][i] / 16;
}

/* ---- What does not count, and where it was ---- */

static void alphas(struct frame *frame, int n) {
    static const float alpha[3] = {-1, 0, 0.5f};
    mirrors(frame, n);
    EACH(i) if (n == 1) frame->color[3][i] = alpha[i % 3];
}

static void bad_colours(struct frame *frame, int n) {
    mirrors(frame, n);
    EACH(i)
    if ((i + (size_t)n) % 3 == 0 || (i / FRAME_WIDTH > 24 && i % 16 > 0)) frame->color[0][i] = i % 2 ? NAN : INFINITY;
}
static void only_finite(const struct frame *frame, size_t pixel, bool has_past, double color[4], double *samples) {
    (void)frame, (void)pixel, (void)has_past;
    if (!isfinite(color[0])) *samples = 0;
}
static void some_sky(struct frame *frame, int n) {
    mirrors(frame, n);
    EACH(i) {
        if (i % 5 == 1) frame->depth[i] = INFINITY;
        if (i % 5 == 3) frame->normal[2][i] = 0;
    }
}
static void no_sky(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    (void)frame, (void)n;
    if (pixel % 5 == 1 || pixel % 5 == 3) past->count = 0;
}
static void moves(struct frame *frame, int n) {
    mirrors(frame, n);
    EACH(i) frame->motion[0][i] = -3.0f / FRAME_WIDTH, frame->motion[1][i] = 1.5f / FRAME_HEIGHT;
}
static void from_there(const struct frame *frame, int n, size_t pixel, struct history_texels *past) {
    const double x = (double)(pixel % FRAME_WIDTH) + 0.5 - 3, y = (double)(pixel / FRAME_WIDTH) + 0.5 + 1.5;
    (void)frame, (void)n;
    history_texels_at(past, x, y);
    if (!(x >= 0 && y <= FRAME_HEIGHT)) past->count = 0;
}

#define ONE "three roundings of colours below 2"
#define WINDOW "the deviation is off by 4 ULP, times 9 where the first of nine lies apart, and the window opens it by 5"
#define OPEN "temporal_sharp.clamp_history=false"

/* clang-format off */
static const struct shot list[] = {
    {"mean of mirrors", "the new frame weighs 1/16", {OPEN}, .sharp = true, .frames = 6, .stage = mirrors, .bound = 5e-7, .reason = ONE},
    {"mean of mirrors, 3:1", "or a quarter", {OPEN, "temporal_sharp.history=3"}, .sharp = true, .frames = 6, .stage = mirrors, .past = three, .bound = 5e-7, .reason = ONE},
    {"mean of mirrors, 1:1", "or a half", {OPEN, "temporal_sharp.history=1"}, .sharp = true, .frames = 4, .stage = mirrors, .past = fill_history, .bound = 5e-7, .reason = ONE},
    {"mirrors' history of none", "0 keeps nothing", {OPEN, "temporal_sharp.history=0"}, .sharp = true, .frames = 3, .stage = mirrors, .past = none, .bound = 0, .reason = "the frame's own bits"},
    {"mirrors' rays that found nothing", "alpha 0 gives no history; alpha 0.5 does", {OPEN}, .sharp = true, .frames = 3, .stage = alphas, .bound = 5e-7, .reason = ONE},
    {"mirrors after a cut", "nothing of the frames before it", {OPEN}, .sharp = true, .frames = 6, .stage = cut_mirrors, .past = nothing_at_4, .bound = 5e-7, .reason = ONE},
    {"history within its neighbours", "clamped to mean and deviation of nine neighbours, wider for rougher surfaces; no clamp beyond the limit", {NULL}, .sharp = true, .frames = 4, .stage = smooth_by_rows, .past = smooth_alone, .hold = hold, .bound = 1.2e-5, .reason = WINDOW},
    {"narrowest window", "clamps the history of a mirror to the mean", {"temporal_sharp.window=0"}, .sharp = true, .frames = 4, .stage = mirrors, .hold = hold_at_mean, .bound = 2e-6, .reason = "nine roundings of colours below 2"},
    {"wider window", "one and a half deviations", {"temporal_sharp.window=1.5"}, .sharp = true, .frames = 4, .stage = mirrors, .hold = hold_wide, .bound = 1.2e-5, .reason = WINDOW},
    {"neighbours without variance", "one bright colour, then another: the history is clamped to the second one", {NULL}, .sharp = true, .frames = 5, .stage = bright, .hold = hold, .bound = 2.5e-4, .reason = "two ULP of 1000, and of 3000"},
    {"neighbours nearly equal", "noise of a sixteenth on 1000: as wide a window as on 1", {NULL}, .sharp = true, .frames = 4, .stage = bright_noise, .hold = hold, .bound = 2.5e-4, .reason = "two ULP of 1000: differences of the neighbours are exact"},
    {"mirrors' colours that are none", "NaN and infinite: the history stays, clamped by the valid neighbours", {NULL}, .sharp = true, .frames = 5, .stage = bad_colours, .now = only_finite, .hold = hold, .bound = 1.2e-5, .reason = WINDOW},
    {"mirrors that are none", "sky and a normal without length have no history", {OPEN}, .sharp = true, .frames = 4, .stage = some_sky, .past = no_sky, .bound = 5e-7, .reason = ONE},
    {"mirrors' motion", "the history follows by fractions of a pixel; none from outside of the picture", {OPEN}, .sharp = true, .frames = 5, .stage = moves, .past = from_there, .bound = 2e-5, .reason = "places are rounded by 4e-6 of a pixel in either direction, between colours that are 2 apart"},
};
/* clang-format on */

const struct shot_list time_sharp = {list, sizeof list / sizeof *list, NULL};

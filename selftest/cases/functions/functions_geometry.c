/* Cases of camera.glsl, cubemap.glsl, levels.glsl, facet.glsl, edges.glsl and paraboloid.glsl. */
#include "cases/functions/function_case.h"

static double largest(const double *v) {
    return fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
}
static double length(const double *v) {
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* ---- Directions from their axes: a point in or on the cube [-1, 1]^3, times a length ---- */

static void direction(float *x) {
    const double size = (double)x[3], most = fmax(fabs((double)x[0]), fmax(fabs((double)x[1]), fabs((double)x[2])));
    for (int k = 0; k < 3; k++) x[k] = (float)(most > 0 ? (double)x[k] * size : k == 2 ? size : 0);
    x[3] = 0;
}
static void unit_direction(float *x) {
    double v[3] = {(double)x[0], (double)x[1], (double)x[2]};
    if (largest(v) == 0) v[2] = 1;
    for (int k = 0; k < 3; k++) x[k] = (float)(v[k] / length(v));
}

/* ---- cubemap.glsl ---- */

/* Vulkan specification, Cube Map Face Selection. */
static void face_of(const double *d, double *y) {
    const double a[3] = {fabs(d[0]), fabs(d[1]), fabs(d[2])};
    double s, t, most;
    if (a[2] >= a[0] && a[2] >= a[1]) {
        y[2] = d[2] >= 0 ? 4 : 5, most = a[2];
        s = d[2] >= 0 ? d[0] : -d[0], t = -d[1];
    } else if (a[1] >= a[0]) {
        y[2] = d[1] >= 0 ? 2 : 3, most = a[1];
        s = d[0], t = d[1] >= 0 ? d[2] : -d[2];
    } else {
        y[2] = d[0] >= 0 ? 0 : 1, most = a[0];
        s = d[0] >= 0 ? -d[2] : d[2], t = -d[1];
    }
    y[0] = 0.5 * (s / most + 1);
    y[1] = 0.5 * (t / most + 1);
}
static void expect_round_trip(const double *d, double *y) {
    for (int k = 0; k < 3; k++) y[k] = d[k] / largest(d);
}
static void texel_of_size(float *x) {
    static const float sizes[5] = {1, 2, 17, 512, 2048};
    x[3] = sizes[(int)x[3]];
    for (int k = 0; k < 2; k++) x[k] = floorf(fminf(x[k] * x[3], x[3] - 1));
}
static void expect_texel(const double *x, double *y) {
    y[0] = x[0];
    y[1] = x[1];
    y[2] = 18 + x[2]; /* layer of cube map 3 */
}
/* The centre of a texel, and the cube map of its layer. */
static void expect_texel_direction(const double *x, double *y) {
    const double u = 2 * (x[0] + 0.5) / x[3] - 1, v = 2 * (x[1] + 0.5) / x[3] - 1;
    const int face = (int)x[2] % 6;
    /* The inverse of the specification's table. */
    const double d[6][3] = {{1, -v, -u}, {-1, -v, u}, {u, 1, v}, {u, -1, -v}, {u, -v, 1}, {-u, -v, -1}};
    for (int k = 0; k < 3; k++) y[k] = d[face][k];
    y[3] = floor(x[2] / 6);
}
static void expect_texel_angle(const double *d, double *y) {
    y[0] = 2 / 256.0 * largest(d) / length(d);
}

/* ---- camera.glsl ---- */

/* uv, depth, half the field of view's tangent, jitter in uv. */
static void expect_project(const double *x, double *y) {
    y[0] = x[0];
    y[1] = x[1];
}
static void expect_view(const double *x, double *y) {
    y[0] = x[2] * (x[0] * x[3] + x[4]);
    y[1] = x[2] * (x[1] * x[3] + x[4]);
    y[2] = -x[2];
}
static void position_and_normal(float *x) {
    const float size = x[6];
    unit_direction(x + 3);
    unit_direction(x);
    for (int k = 0; k < 3; k++) x[k] *= size;
    x[6] = 0;
}
static void expect_mirror(const double *x, double *y) {
    const double *v = x, *n = x + 3, m = largest(v), to[3] = {v[0] / m, v[1] / m, v[2] / m};
    const double along = (to[0] * n[0] + to[1] * n[1] + to[2] * n[2]) / length(to) / length(n);
    for (int k = 0; k < 3; k++) y[k] = to[k] / length(to) - 2 * along * n[k] / length(n);
}
static void expect_reflects(const double *x, double *y) {
    const double square = x[1] * x[1];
    y[0] = x[0] > 0 && x[0] < (double)3.0e38f && square > 0.25 && square < 4;
}
static void nan_of_either(float *x) {
    if (x[2] == 1) x[0] = NAN;
    if (x[2] == 2) x[1] = NAN;
}
static void expect_picked(const double *x, double *y) {
    y[0] = 2 * x[0] + (x[2] < 4 ? fmod(x[2], 2) + 0.5 : 1);
    y[1] = 2 * x[1] + (x[2] < 4 ? floor(x[2] / 2) + 0.5 : 1);
}

/* Full resolutions, some of them odd, with half resolution rounded up; some pipelines run at full resolution. */
static void sizes_of(float *x) {
    for (int k = 0; k < 2; k++) x[k] = floorf(x[k] * (x[3 + k] - 1) / 2 + 0.5f);
    for (int k = 0; k < 2; k++) x[5 + k] = x[7] == 0 ? x[3 + k] : floorf((x[3 + k] + 1) / 2);
}
static void expect_picked_uv(const double *x, double *y) {
    const int full = x[7] == 0;
    y[0] = (full ? x[0] + 0.5 : 2 * x[0] + (x[2] < 4 ? fmod(x[2], 2) + 0.5 : 1)) / x[3];
    y[1] = (full ? x[1] + 0.5 : 2 * x[1] + (x[2] < 4 ? floor(x[2] / 2) + 0.5 : 1)) / x[4];
    y[2] = full ? 1 : 2;
}

/* ---- facet.glsl ---- */

static void expect_rise(const double *x, double *y) {
    y[0] = (fabs(x[0]) + fabs(x[1])) / 2;
}

/* Slope of a plane's inverse depth over one texel: 1/z = n·(uv·xy + zw, front) / (n·p). */
static void expect_slopes(const double *x, double *y) {
    const double uv[2] = {x[3], x[4]}, texel = 1.0 / 256;
    double now = -x[2], next[2];
    for (int k = 0; k < 2; k++) now += x[k] * (2 * uv[k] - 1);
    for (int k = 0; k < 2; k++) next[k] = now + x[k] * 2 * texel;
    for (int k = 0; k < 2; k++) y[k] = now < 0 ? next[k] / now - 1 : (double)3.0e38f;
}
/* Normals whose cosine to the view direction is well above the rounding error. */
static void facing(float *x) {
    x[2] = 1;
    const float l = sqrtf(x[0] * x[0] + x[1] * x[1] + 1);
    for (int k = 0; k < 3; k++) x[k] /= l;
}
static void expect_facet_slope(const double *x, double *y) {
    const double before = 1 - x[0] / x[1], after = x[0] / x[2] - 1;
    const double flatter = fabs(after) < fabs(before) ? after : before;
    y[0] = fmin(fmax(flatter, -1), 1);
}
static void expect_nothing(const double *x, double *y) {
    (void)x;
    y[0] = 0;
}
static void neighbours_of_depth(float *x) {
    x[1] *= x[0];
    x[2] *= x[0];
}

/* ---- levels.glsl ---- */

static void odd_or_even(float *x) {
    x[1] = fmaxf(floorf(x[2] / 2), 1);
    x[0] = floorf(fminf(x[0] * x[1], x[1] - 1));
}
/* The fraction of the coarse texel that each finer texel covers. */
static void expect_footprint(const double *x, double *y) {
    const double wide = x[2] / x[1], low = x[0] * wide, high = low + wide;
    const double first = floor(low + 1e-9);
    for (int k = 0; k < 2; k++) y[k] = fmax(0, fmin(high, first + k + 1) - fmax(low, first + k)) / wide;
    y[2] = first;
    y[3] = ceil(high - 1e-9) - first; /* the last texel covers the rest */
}
static void expect_is_tap(const double *x, double *y) {
    y[0] = hypot(x[0], x[1]) <= x[2] + 1e-9;
}
static void expect_taps_beside(const double *x, double *y) {
    y[0] = 0;
    while ((y[0] + 1) * (y[0] + 1) + x[0] * x[0] <= x[1] * x[1]) y[0]++;
}

/* ---- edges.glsl ---- */

static void expect_side(const double *x, double *y) {
    for (int k = 0; k < 4; k++) y[k] = floor(fmin(fmax(x[k], 0), 1) * 3 + 0.5) / 3;
}
/* Avoids the midpoints between thirds, where rounding decides. */
static void thirds(float *x) {
    for (int k = 0; k < 4; k++) {
        const float place = x[k] * 3 - floorf(x[k] * 3);
        if (fabsf(place - 0.5f) < 1e-3f) x[k] += 0.01f;
    }
}

/* The edges between the texels of a block: in its upper and lower row, in its left and right column. */
static void expect_block(const double *x, double *y) {
    const double across[2] = {x[0] / 3, x[1] / 3}, down[2] = {x[2] / 3, x[3] / 3};
    const int column = (int)x[4] % 2, row = (int)x[4] / 2;
    for (int k = 0; k < 4; k++) {
        const int c = k % 2, r = k / 2;
        if (c == column && r == row) y[k] = 1;
        else if (r == row) y[k] = across[r];
        else if (c == column) y[k] = down[c];
        else y[k] = fmax(across[row] * down[c], down[column] * across[r]);
    }
}
/* Half of a texel of this level, along x and y, is the texel of the finer one. */
static void expect_picked_texel(const double *x, double *y) {
    const double wide = exp2(x[2]);
    y[0] = fmod(floor(x[0] / wide), 2) + 2 * fmod(floor(x[1] / wide), 2);
}
/* A tap seen from the centre of a face: cosⁿ⁺³ of the angle to it, and the level whose texels are half as wide as taps are apart;
   a texel off the face's centre is seen smaller. */
static void expect_tap(const double *x, double *y) {
    const double rim = exp2(x[2]) * 3.5 / (x[3] / 2), apart = rim / 3.5, at[2] = {x[0] * apart, x[1] * apart};
    const double cosine = 1 / sqrt(1 + at[0] * at[0] + at[1] * at[1]), power = log(0.1) / log(cos(atan(rim)));
    const double most = fmax(1, fmax(fabs(at[0]), fabs(at[1])));
    y[0] = pow(cosine, power + 3);
    y[1] = fmin(fmax(log2(apart / 2 * x[3] / pow(most, 1.5)) - 1, 0), x[2]);
}

/* ---- paraboloid.glsl ---- */

static void expect_paraboloid(const double *d, double *y) {
    const double reach = 256 / 255.0, l = length(d);
    y[0] = 0.5 + 0.5 * d[0] / (l + fabs(d[2])) / reach;
    y[1] = 0.5 + 0.5 * d[1] / (l + fabs(d[2])) / reach;
    y[2] = d[2] < 0;
}
static void expect_same(const double *d, double *y) {
    for (int k = 0; k < 3; k++) y[k] = d[k] / length(d);
}
static void expect_place(const double *x, double *y) {
    const double reach = x[3] / fmax(x[3] - 1, 1);
    for (int k = 0; k < 2; k++) y[k] = (2 * x[k] / x[2] - 1) * reach;
    y[2] = reach;
}
static void texels_of_level(float *x) {
    x[3] = exp2f(x[3]);
    x[2] = fminf(exp2f(x[2]), x[3]);
    for (int k = 0; k < 2; k++) x[k] *= x[2];
}
static void expect_solid_angle(const double *x, double *y) {
    y[0] = 4 / pow(1 + x[0] * x[0] + x[1] * x[1], 2);
}
static void expect_paraboloid_level(const double *x, double *y) {
    y[0] = log2(fmin(fmax(x[0] * x[2] / (2 * 3.5 * (1 + fabs(x[1]))), 1), x[2]));
}
static void expect_orthonormal(const double *d, double *y) {
    (void)d;
    y[0] = y[1] = 1;
    y[2] = 0;
    y[3] = 1;
}

/* clang-format off */
#define CUBE {LINEAR, -1, 1, ZERO}, {LINEAR, -1, 1, ZERO}, {LINEAR, -1, 1, ZERO}
#define LENGTH {LOG, 1e-32, 4e37, 0} /* the inverse must be a normal number, too */
#define DIVISION "a division, 2.5 ULP (Vulkan) of up to 1, and a rounding"

/* Within a face the weighted mean of the four texels' positions is the direction's: faces of 8 texels, half a texel per unit. */
static void expect_taps(const double *x, double *y) {
    for (int k = 0; k < 3; k++) y[k] = 8 * x[k];
    y[3] = 1;
}
static void on_a_face(float *x) {
    const int axis = (int)x[2] % 3;
    const float place[3] = {x[0], x[1], x[2] < 3 ? 1.0f : -1.0f};
    for (int k = 0; k < 3; k++) x[(k + axis) % 3] = place[k];
}

static const struct function list[] = {
    {"face of a direction", "face and position on it, on axes, edges and corners, for tiny and huge vectors", "face_from_direction(a.xyz), 0.0", "x y z", {CUBE, LENGTH}, direction,
     face_of, 3, ABSOLUTE, 2.1e-7, DIVISION},
    {"direction of a face", "face and position convert back to the direction", "direction_from_face(face_from_direction(a.xyz)), 0.0", "x y z", {CUBE, LENGTH}, direction,
     expect_round_trip, 3, ABSOLUTE, 4.8e-7, DIVISION ", twice as wide"},
    {"texels around a direction", "the weighted mean of the four texels is the position on the face", "/* cube_taps(direction, size), centre_on_cube(place, major, size) */ on_face(a.xyz)", "x y face", {{LINEAR, -0.85, 0.85, ZERO}, {LINEAR, -0.85, 0.85, ZERO}, {WHOLE, 0, 5, 0}}, on_a_face,
     expect_taps, 4, ABSOLUTE, 8e-6, "a division, 2.5 ULP (Vulkan), of a place that spans 16, and the texels' weights of its parts"},
    {"texel of a direction", "the direction of a texel's centre gives that texel, faces of 1 to 2048", "face_texel(direction_from_face(vec3((a.xy + 0.5) / a.w, a.z)), 3u, int(a.w)), 0", "x y face size",
     {{LINEAR, 0, 1, 0}, {LINEAR, 0, 1, 0}, {WHOLE, 0, 5, 0}, {WHOLE, 0, 4, 0}}, texel_of_size, expect_texel, 3, ABSOLUTE, 0, "a centre is half a texel from the next"},
    {"centre of a texel", "its direction and its cube map, faces of 1 to 2048", "texel_direction(ivec2(a.xy), int(a.w), int(a.z))", "x y layer size",
     {{LINEAR, 0, 1, 0}, {LINEAR, 0, 1, 0}, {WHOLE, 0, 23, 0}, {WHOLE, 0, 4, 0}}, texel_of_size, expect_texel_direction, 4, ABSOLUTE, 3e-7, DIVISION},
    {"width of a texel", "angle that a texel spans, tiny and huge vectors", "texel_angle(a.xyz, 256.0)", "x y z", {CUBE, LENGTH}, direction,
     expect_texel_angle, 1, ULP, 8, "a division and an inverse root, 2.5 and 2 ULP (Vulkan), of a sum of squares"},

    {"position of a pixel", "view-space position, near and far, 1 and 150 degrees", "view_position(a.xy, a.z, vec4(a.w, a.w, b.xx), -1.0), 0.0", "u v depth wide shift",
     {{LINEAR, 0, 1, 0}, {LINEAR, 0, 1, 0}, {LOG, 1e-3, 1e6, 0}, {LOG, 0.0175, 7.46, 0}, {LINEAR, 0, 0.1, 0}}, NULL, expect_view, 3, ULP, 3, "a sum of two positive numbers, a product"},
    {"pixel of a position", "a pixel projects onto itself, 10^-3 to 10^6 m, 1 and 150 degrees, off-centre", "project(view_position(a.xy, a.z, vec4(a.w, -a.w, -0.5 * a.w + b.x * a.w, 0.5 * a.w), -1.0), "
     "vec4(1.0 / a.w, -1.0 / a.w, 0.5 - b.x, 0.5), -1.0), 0.0, 0.0", "u v depth wide shift",
     {{LINEAR, 0, 1, 0}, {LINEAR, 0, 1, 0}, {LOG, 1e-3, 1e6, 0}, {LOG, 0.0175, 7.46, 0}, {LINEAR, -0.5, 0.5, 0}}, NULL, expect_project, 2, ABSOLUTE, 6e-7, "two divisions, 2.5 ULP each, and four roundings of up to 1; a pixel of 4096 is 2.4e-4"},
    {"mirror direction", "the reflected ray, facing and grazing, of tiny and huge positions", "mirror_direction(a.xyz, vec3(a.w, b.xy)), 0.0", "x y z nx ny nz",
     {CUBE, CUBE, LENGTH}, position_and_normal, expect_mirror, 3, ABSOLUTE, 1e-6, "three normalisations, an inverse root of 2 ULP each, and a sum of three products twice"},
    {"which pixels reflect", "depth and normal usable: 0, negative, infinite, NaN are not", "reflects(a.x, vec3(0.0, a.y, 0.0))", "depth normal bad",
     {{LOG, 1e-30, 3.39e38, ZERO | ENDLESS | NEGATIVE}, {LOG, 0.6, 10, ZERO | ENDLESS}, {WHOLE, 0, 2, 0}}, nan_of_either, expect_reflects, 1, ABSOLUTE, 0, "a decision"},
    {"picked positions", "position of a texel's sample", "picked_position(ivec2(a.xy), uint(a.z), uvec4(32768u, 32768u, 16384u, 16384u)), 0.0, 0.0", "x y pick",
     {{WHOLE, 0, 16383, 0}, {WHOLE, 0, 16383, 0}, {WHOLE, 0, 4, 0}}, NULL, expect_picked, 2, ABSOLUTE, 0, "halves of integers below 2^16"},

    {"picked uv", "position of a texel's sample in the picture, odd sizes included, at half and full resolution", "picked_uv(ivec2(a.xy), uint(a.z), uvec4(a.w, b.xyz)), reduction(uvec4(a.w, b.xyz)), 0.0", "x y pick width height half_width half_height halved",
     {{LINEAR, 0, 1, 0}, {LINEAR, 0, 1, 0}, {WHOLE, 0, 4, 0}, {WHOLE, 2, 4096, 0}, {WHOLE, 2, 4096, 0}, {WHOLE, 0, 0, 0}, {WHOLE, 0, 0, 0}, {WHOLE, 0, 1, 0}}, sizes_of, expect_picked_uv, 3, ABSOLUTE, 3.6e-7, "a division, 2.5 ULP (Vulkan) of up to 1"},

    {"facet of a normal", "slopes of inverse depth on a plane", "slopes_of_normal(a.xyz, vec2(a.w, b.x), vec2(1.0 / 256.0), vec4(2.0, 2.0, -1.0, -1.0), -1.0), 0.0, 0.0", "nx ny nz u v",
     {{LINEAR, -0.45, 0.45, ZERO}, {LINEAR, -0.45, 0.45, ZERO}, {LINEAR, 0, 1, 0}, {LINEAR, 0, 1, 0}, {LINEAR, 0, 1, 0}}, facing, expect_slopes, 2, ABSOLUTE, 2e-7, "the normal's dot product keeps a tenth of its terms"},
    {"equal depths", "have a slope of 0, however their quotient is rounded", "fall(a.x, a.x)", "depth", {{LOG, 1e-6, 2.9e38, 0}}, NULL, expect_nothing, 1, ABSOLUTE, 0, "a decision"},
    {"facet of depths", "slope between neighbours, including sky and nearly equal depths", "facet_slope(a.x, a.y, a.z, LARGEST)", "depth before after",
     {{LOG, 1e-3, 1e6, 0}, {LOG, 0.5, 2, ENDLESS}, {LOG, 0.5, 2, ENDLESS}}, neighbours_of_depth, expect_facet_slope, 1, ABSOLUTE, 3e-7, "parts of an inverse depth that itself is rounded by 6e-8; a division of 2.5 ULP (Vulkan)"},

    {"rise of a facet", "height over its centre, within the texel", "facet_rise(a.xy)", "x y", {{LOG, 1e-6, 1, ZERO | NEGATIVE}, {LOG, 1e-6, 1, ZERO | NEGATIVE}}, NULL, expect_rise, 1, ULP, 1, "one sum"},

    {"footprint of a texel", "exact shares of two or three finer texels, odd sizes", "footprint(int(a.x), int(a.y), int(a.z)).share.xy, footprint(int(a.x), int(a.y), int(a.z)).first, footprint(int(a.x), int(a.y), int(a.z)).count", "texel size finer",
     {{LINEAR, 0, 1, 0}, {LINEAR, 0, 1, 0}, {WHOLE, 1, 4096, 0}}, odd_or_even, expect_footprint, 4, ABSOLUTE, 1.6e-7, "one division, 2.5 ULP of up to 1"},
    {"taps of a lattice", "points within reach", "is_tap(ivec2(a.xy), int(a.z))", "x y reach", {{WHOLE, -5, 5, 0}, {WHOLE, -5, 5, 0}, {WHOLE, 1, 5, 0}}, NULL, expect_is_tap, 1, ABSOLUTE, 0, "integers"},
    {"taps of a row", "points within reach, on either side", "taps_beside(int(a.x), int(a.y))", "y reach", {{WHOLE, -5, 5, 0}, {WHOLE, 5, 64, 0}}, NULL, expect_taps_beside, 1, ABSOLUTE, 0, "integers"},
    {"packed edges", "packing four sides in a byte and unpacking them", "open_side(packed_side(a.x, 0u) | packed_side(a.y, 1u) | packed_side(a.z, 2u) | packed_side(a.w, 3u), 0u), "
     "open_side(packed_side(a.y, 1u), 1u), open_side(packed_side(a.z, 2u), 2u), open_side(packed_side(a.w, 3u), 3u)", "left right up down",
     {{LINEAR, -0.5, 1.5, 0}, {LINEAR, -0.5, 1.5, 0}, {LINEAR, -0.5, 1.5, 0}, {LINEAR, -0.5, 1.5, 0}}, thirds, expect_side, 4, ABSOLUTE, 1.8e-7, "a third, 2.5 ULP of a division (Vulkan)"},

    {"edges of a block", "which texels of a block are on one surface; diagonal ones by the better of both connections", "open_in_block(uvec4(packed_side(a.x / 3.0, SIDE_RIGHT) | packed_side(a.z / 3.0, SIDE_DOWN), packed_side(a.w / 3.0, SIDE_DOWN), "
     "packed_side(a.y / 3.0, SIDE_RIGHT), 0u), uint(b.x))", "upper lower left right from", {{WHOLE, 0, 3, 0}, {WHOLE, 0, 3, 0}, {WHOLE, 0, 3, 0}, {WHOLE, 0, 3, 0}, {WHOLE, 0, 3, 0}}, NULL,
     expect_block, 4, ABSOLUTE, 4.5e-7, "a product of two thirds, 2.5 ULP each (Vulkan), and a rounding"},
    {"picked texel of a block", "the texel of a finer level that a pixel within a coarser texel belongs to", "picked_in_block(uint(a.x) + 8u * uint(a.y), int(a.z))", "x y level",
     {{WHOLE, 0, 7, 0}, {WHOLE, 0, 7, 0}, {WHOLE, 1, 2, 0}}, NULL, expect_picked_texel, 1, ABSOLUTE, 0, "integers"},
    {"taps of a pre-filter", "weight and level, narrow cones to wide ones", "cube_tap(ivec2(a.xy), vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), a.z, a.w, 3, 3.5, 0.1).weight, "
     "cube_tap(ivec2(a.xy), vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), a.z, a.w, 3, 3.5, 0.1).lod, 0.0, 0.0", "x y level size", {{WHOLE, -3, 3, 0}, {WHOLE, -3, 3, 0}, {WHOLE, 1, 8, 0}, {LOG, 16, 2048, 0}}, NULL,
     expect_tap, 2, ABSOLUTE, 6e-6, "log2 is 3 ULP off (Vulkan), 1.5e-6 of 8; the weight's exponent carries two logarithms, 16 ULP each"},
    {"place on a paraboloid", "poles, the rim and directions between them", "paraboloid_uv(a.xyz, 256.0), 0.0", "x y z", {CUBE}, unit_direction, expect_paraboloid, 3, ABSOLUTE, 3e-7, DIVISION "; the direction is unit to 6e-8"},
    {"direction of a paraboloid", "mapping a direction and back gives the direction", "paraboloid_direction((2.0 * paraboloid_uv(a.xyz, 256.0).xy - 1.0) * paraboloid_reach(256.0), a.z >= 0.0), 0.0", "x y z", {CUBE}, unit_direction,
     expect_same, 3, ABSOLUTE, 1.2e-6, "three divisions, 2.5 ULP each, and a place that spans 2"},
    {"texel on a paraboloid", "the outermost texels of every level are at the rim of the finest one", "paraboloid_place(a.xy, a.z, a.w), paraboloid_reach(a.w), 0.0", "x y size widest",
     {{LINEAR, 0, 1, 0}, {LINEAR, 0, 1, 0}, {WHOLE, 0, 11, 0}, {WHOLE, 0, 11, 0}}, texels_of_level, expect_place, 3, ABSOLUTE, 1.5e-6, "two divisions, 2.5 ULP each (Vulkan), of up to 2"},
    {"solid angle on a paraboloid", "solid angle of an area of the map", "paraboloid_solid_angle(a.xy)", "x y", {{LINEAR, -1, 1, ZERO}, {LINEAR, -1, 1, ZERO}}, NULL, expect_solid_angle, 1, ULP, 7, "a division, 2.5 ULP, of a square"},
    {"level of a paraboloid", "level of a cone at any height", "paraboloid_level(a.x, a.y, a.z, 3.5)", "tangent height size", {{LOG, 1e-6, 1255, ZERO}, {LINEAR, -1, 1, ZERO}, {LOG, 2, 2048, 0}}, NULL,
     expect_paraboloid_level, 1, ABSOLUTE, 5e-6, "log2 is 3 ULP off (Vulkan), 2.9e-6 of 11"},
    {"paraboloid's axes", "orthonormal about any up axis", "dot(paraboloid_axes(a.xyz)[0], paraboloid_axes(a.xyz)[0]), dot(paraboloid_axes(a.xyz)[1], paraboloid_axes(a.xyz)[1]), "
     "dot(paraboloid_axes(a.xyz)[0], a.xyz), dot(cross(paraboloid_axes(a.xyz)[0], paraboloid_axes(a.xyz)[1]), a.xyz)", "x y z", {CUBE}, unit_direction, expect_orthonormal, 4, ABSOLUTE, 1.2e-6, "an inverse root and sums of three products"},
};
/* clang-format on */

const struct function_list functions_geometry = {list, sizeof list / sizeof *list};

// Walks a ray through the texels of the depth buffer and tests it against each. Next include of a pass with the rows of
// cell_rows.h.
#include "screen_ray.glsl"

struct CellRay {
    vec2 start, across, per_across; // texels; 1/across, -1e30 for a component of 0, whose edges are never reached
    vec2 forward;                   // 1 for a component that grows, else 0
    float inverse, inverse_rate;    // 1/z = inverse + s · inverse_rate
    float end, texel;               // texel: the length of s over one texel along the major axis
    uint limit;                     // the end reason of a ray that reaches the end
};

// Texel coordinates are integers in floats, which is exact; conversions would cost as much as divisions. The values of s at which the ray
// leaves a texel through its far edges, by axis.
vec2 cell_exits(CellRay ray, vec2 cell) { return (cell + ray.forward - ray.start) * ray.per_across; }

// A texel's sample is taken to lie at its centre, because other texels of a reduced image may hold another pixel of their block.
CellRay cell_ray(ScreenRay ray, ivec2 texel) {
    CellRay cells;
    cells.start = vec2(texel) + 0.5;
    cells.across = ray.across / reduction(frame.size);
    cells.per_across = 1.0 / mix(cells.across, vec2(-1e-30), lessThan(abs(cells.across), vec2(1e-30)));
    cells.forward = vec2(greaterThan(cells.per_across, vec2(0.0)));
    cells.inverse = ray.inverse;
    cells.inverse_rate = ray.inverse_rate;
    // The ray starts at the centre of its texel here, so it may leave the image half a texel earlier or later.
    vec2 border = cell_exits(cells, cells.forward * (vec2(frame.size.zw) - 1.0));
    float leaves = min(border.x, border.y);
    cells.end = min(ray.end, leaves);
    cells.limit = leaves < ray.end ? END_left_screen : ray.limit;
    cells.texel = 1.0 / max(abs(cells.across.x), abs(cells.across.y));
    return cells;
}

float inverse_at(CellRay ray, float s) { return fma(s, ray.inverse_rate, ray.inverse); }

// The value of s at which the ray enters a texel through its near edges.
float cell_entry(CellRay ray, vec2 cell) {
    vec2 entries = (cell + 1.0 - ray.forward - ray.start) * ray.per_across;
    return max(max(entries.x, entries.y), 0.0);
}

// The result of testing a texel that the ray crosses from s_in to s_out.
const uint CELL_FRONT = 0u, CELL_HIT = 1u, CELL_BEHIND = 2u, CELL_SEAM = 3u; // SEAM: HIT where joined(), else BEHIND
struct Crossing {
    uint what;
    float s; // of a hit
};

// The ray's inverse depth less the facet's is linear within the texel: positive in front, negative behind. A ray crosses a
// visible surface from front to back. A ray that enters behind the facet and goes deeper crossed the surface's plane before: within the
// untested interval `unseen` before s_in, where two surfaces meet, or by less than the thickness; or it passed a
// silhouette.
Crossing cross(CellRay ray, vec2 cell, float s_in, float s_out, float unseen, float inverse, vec2 slopes) {
    vec2 rate = inverse * slopes * ray.across, from = (ray.start - cell - 0.5) * inverse * slopes;
    float at_start = ray.inverse - inverse - from.x - from.y, rise = ray.inverse_rate - rate.x - rate.y;
    float gap_in = at_start + s_in * rise, gap_out = at_start + s_out * rise;
    if (gap_out >= -bias * inverse) return Crossing(CELL_FRONT, s_out);
    // Thickness relative to the surface's depth: 1/z - 1/(z + d) in inverse depths.
    float depth = thickness + thickness_m * inverse;
    float tolerance = inverse * depth / (1.0 + depth), reach = -unseen * rise;
    if (thickness_m < EVERYTHING_M && (gap_in < -tolerance - reach || rise >= 0.0)) return Crossing(CELL_BEHIND, s_in);
    bool sure = thickness_m >= EVERYTHING_M || gap_in >= -tolerance;
    float s = rise < 0.0 ? clamp(-at_start / rise, s_in - (sure ? seam * ray.texel : unseen), s_out) : s_in;
    return Crossing(sure ? CELL_HIT : CELL_SEAM, max(s, 0.0));
}

// The texel before this one along the ray.
vec2 cell_before(CellRay ray, vec2 cell) {
    vec2 entries = (cell + 1.0 - ray.forward - ray.start) * ray.per_across;
    return cell - (2.0 * ray.forward - 1.0) * (entries.x > entries.y ? vec2(1.0, 0.0) : vec2(0.0, 1.0));
}

float facet_inverse(CellRay ray, vec2 cell, float s, float inverse, vec2 slopes) {
    return (1.0 + dot(slopes, ray.start + s * ray.across - cell - 0.5)) * inverse;
}

// Whether the surfaces of two texels are continuous at the border that the ray crosses at s: both must be near the ray there.
bool joined(CellRay ray, float s, vec2 cell, float inverse, vec2 slopes, vec2 before, float before_inverse,
                    vec2 before_slopes) {
    float here = inverse_at(ray, s);
    float apart = abs(facet_inverse(ray, cell, s, inverse, slopes) - here) +
                  abs(facet_inverse(ray, before, s, before_inverse, before_slopes) - here);
    return apart <= jump * inverse;
}

// Records the test of a texel that the ray crosses from s_from to s.
void probe_crossing(ScreenRay ray, CellRay path, vec2 cell, float s_from, float s, float inverse, vec2 slopes, uint what) {
    uint decision = what == CELL_FRONT ? DECISION_front : what == CELL_HIT ? DECISION_hit : DECISION_behind;
    if (probing()) probe_texel_seen(ray, s_from, s, ivec2(cell), facet_inverse(path, cell, s, inverse, slopes), decision);
}

// The interval over which a ray is occluded, ignoring gaps no wider than those of a stippled surface.
const float STIPPLE = 4.25; // texels; neither a whole nor a half number, which rays along an axis would match exactly
struct Hidden {
    float s_first, s_last;
};

// Adds a texel behind whose surface the ray went from s_in to s_out; the interval `unseen` before s_in was not tested.
void hide(inout Hidden hidden, CellRay ray, float s_in, float s_out, float unseen) {
    if (s_in - hidden.s_last > max(STIPPLE * ray.texel, unseen)) hidden.s_first = s_in;
    hidden.s_last = s_out;
}

// An object is assumed to be `solid` times as deep as the length over which it occludes the ray: a ray that is less far behind the surface
// has hit a side of the object that is not visible. With t = s P.w/(1 - s D.w) that length is
// (s_last - s_first) (1/P.w)/(u_first u_last) for inverse depths u, so that z - depth < solid · way needs no division.
bool blocked(Hidden hidden, CellRay ray, float inverse) {
    float behind = (inverse - inverse_at(ray, hidden.s_last)) * inverse_at(ray, hidden.s_first);
    return behind < solid * (hidden.s_last - hidden.s_first) * ray.inverse * inverse;
}

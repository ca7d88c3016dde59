// Steps along the ray, each of which tests the texel that it lands on. Next include of a pass with the rows of cell_rows.h and the parameters
// steps, refinements, dither, growth and first_step.
#include "cells.glsl"
#include "shared/facet_at.glsl"
#include "shared/random.glsl"

// A ray at a texel: where it enters and leaves, and the length of the untested interval before.
struct Visit {
    vec2 cell;
    float s_in, s_out, unseen;
};

struct Surface {
    float inverse;
    vec2 slopes;
};

Surface surface_at(vec2 cell) {
    float depth_m = texelFetch(depth_half, ivec2(cell), 0).x;
    return Surface(texelFetch(inverse_half, ivec2(cell), 0).x, facet_slopes_at(ivec2(cell), depth_m));
}

// The result of testing the texel. A surface whose plane the ray crossed in the untested interval is hit if the texel there shows the same
// surface.
Crossing meets(CellRay path, Visit visit, out float inverse, inout uint fetches) {
    float depth_m = texelFetch(depth_half, ivec2(visit.cell), 0).x;
    inverse = texelFetch(inverse_half, ivec2(visit.cell), 0).x;
    fetches += 2u;
    if (min(inverse_at(path, visit.s_in), inverse_at(path, visit.s_out)) * depth_m >= 1.0 + STEEPEST)
        return Crossing(CELL_FRONT, visit.s_out);
    fetches += 5u;
    vec2 slopes = facet_slopes_at(ivec2(visit.cell), depth_m);
    bool skipped = visit.unseen > seam * path.texel;
    Crossing crossing = cross(path, visit.cell, visit.s_in, visit.s_out, max(visit.unseen, seam * path.texel), inverse, slopes);
    if (crossing.what != CELL_SEAM) return crossing;
    skipped = skipped && crossing.s < visit.s_in - seam * path.texel;
    float s = skipped ? crossing.s : visit.s_in;
    vec2 before = skipped ? floor(path.start + s * path.across) : cell_before(path, visit.cell);
    fetches += 12u;
    Surface other = surface_at(before);
    bool meet = joined(path, s, visit.cell, inverse, slopes, before, other.inverse, other.slopes);
    crossing.what = meet ? CELL_HIT : CELL_BEHIND;
    return crossing;
}

void probe_visit(ScreenRay ray, CellRay path, Visit visit, Crossing crossing) {
    if (!probing()) return;
    Surface surface = surface_at(visit.cell);
    probe_crossing(ray, path, visit.cell, visit.s_in, crossing.what == CELL_HIT ? crossing.s : visit.s_out, surface.inverse,
                   surface.slopes, crossing.what);
}

Visit visit_of(CellRay path, vec2 cell, float s_before) {
    vec2 exits = cell_exits(path, cell);
    float s_in = cell_entry(path, cell);
    return Visit(cell, s_in, min(min(exits.x, exits.y), path.end), max(s_in - s_before, 0.0));
}

vec2 cell_at(CellRay path, float s) {
    return clamp(floor(path.start + s * path.across), vec2(0.0), vec2(frame.size.zw) - 1.0);
}

Result march(ScreenRay ray, ivec2 texel) {
    CellRay path = cell_ray(ray, texel);
    Result result = Result(0.0, false, path.limit, 0u, 0u);
    float exponent = first_step > 0.0 && steps > 1 ? -log(first_step) / log(float(steps)) : growth;
    float shift = dither ? random4(uvec2(texel), random_frame(), RANDOM_SCREEN_START).x : 0.0;
    Visit visit = visit_of(path, vec2(texel), 0.0); // a ray cannot hit its own texel
    float s_front = visit.s_out, s_before = s_front;
    bool in_front = true;
    Hidden hidden = Hidden(0.0, 0.0);
    for (int i = 1; i <= steps; ++i) {
        precise float s = path.end * pow((float(i) - shift) * (1.0 / float(steps)), exponent);
        vec2 cell = cell_at(path, s);
        if (cell == visit.cell) continue;
        visit = visit_of(path, cell, s_before);
        s_before = visit.s_out;
        result.steps++;
        float inverse;
        Crossing crossing = meets(path, visit, inverse, result.fetches);
        probe_visit(ray, path, visit, crossing);
        Visit first = visit;
        for (int k = 0; k < refinements && crossing.what == CELL_BEHIND && in_front; ++k) {
            cell = cell_at(path, 0.5 * (s_front + first.s_in));
            Visit between = visit_of(path, cell, s_front);
            if (between.s_in <= s_front || between.s_out >= first.s_out) break;
            result.steps++;
            float unused;
            Crossing middle = meets(path, between, unused, result.fetches);
            probe_visit(ray, path, between, middle);
            if (middle.what == CELL_FRONT) s_front = between.s_out;
            else first = between;
            if (middle.what == CELL_HIT) crossing = middle;
        }
        if (crossing.what == CELL_HIT)
            return Result(travelled_at(ray, crossing.s), true, END_hit, result.steps, result.fetches);
        in_front = crossing.what == CELL_FRONT;
        if (in_front) {
            s_front = visit.s_out;
            continue;
        }
        hide(hidden, path, first.s_in, visit.s_out, 1.5 * visit.unseen);
        if (!pass_behind || blocked(hidden, path, inverse)) {
            result.end = END_behind;
            break;
        }
    }
    result.travelled_m = travelled_at(ray, min(s_front, ray.end));
    return result;
}

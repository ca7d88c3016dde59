// Skips cells of the pyramid that the ray passes in front of. Next include of a pass with the rows of cell_rows.h that reads hiz and
// depth_slopes.
#include "cells.glsl"

// The coarsest level that rays go up to: the first whose smaller side is under 8 texels.
int coarsest_level() { return max(findMSB(min(frame.size.z, frame.size.w)) - 2, 0); }

// Whether the ray is behind every texel of a cell by too much for a hit, so that the whole cell can be skipped. farthest, highest:
// inverse depths of the cell and of the ray within it.
bool passes_behind(inout Hidden hidden, CellRay ray, float s_in, float s_out, float farthest, float highest) {
    if (!pass_behind || highest * fma(thickness_m, farthest, 1.0 + thickness) >= 0.999999 * farthest) return false;
    Hidden ahead = hidden;
    hide(ahead, ray, s_in, s_out, 0.0);
    float behind = (farthest - highest) * inverse_at(ray, ahead.s_first);
    if (behind < 1.000001 * solid * (ahead.s_last - ahead.s_first) * ray.inverse * farthest) return false;
    hidden = ahead;
    return true;
}

const uint PASSED = 0u, IN_FRONT = 1u, MET = 2u, BLOCKED = 3u;

// The result of testing the texel's facet against the ray, which crosses it from s to s_out.
uint meets(CellRay path, ivec2 texel, float s_out, inout Hidden hidden, inout float s, inout uint fetches) {
    fetches += 2u;
    float inverse = texelFetch(inverse_half, texel, 0).x;
    vec2 slopes = texelFetch(depth_slopes, texel, 0).xy, cell = vec2(texel);
    s = cell_entry(path, cell);
    Crossing crossing = cross(path, cell, s, s_out, seam * path.texel, inverse, slopes);
    if (crossing.what == CELL_SEAM) {
        vec2 before = cell_before(path, cell);
        fetches += 2u;
        bool meet = joined(path, s, cell, inverse, slopes, before, texelFetch(inverse_half, ivec2(before), 0).x,
                           texelFetch(depth_slopes, ivec2(before), 0).xy);
        crossing.what = meet ? CELL_HIT : CELL_BEHIND;
    }
    if (crossing.what == CELL_FRONT) return IN_FRONT;
    if (crossing.what == CELL_HIT) {
        s = crossing.s;
        return MET;
    }
    hide(hidden, path, s, s_out, 0.0);
    return !pass_behind || blocked(hidden, path, inverse) ? BLOCKED : PASSED;
}

void probe_facet(ScreenRay ray, CellRay path, ivec2 texel, float s, float s_out, uint what) {
    if (!probing()) return;
    uint crossing = what == MET ? CELL_HIT : what == IN_FRONT ? CELL_FRONT : CELL_BEHIND;
    probe_crossing(ray, path, vec2(texel), cell_entry(path, vec2(texel)), what == MET ? s : s_out,
                   texelFetch(inverse_half, texel, 0).x, texelFetch(depth_slopes, texel, 0).xy, crossing);
}

void probe_cell(ScreenRay ray, float s, float s_out, ivec2 cell, int level, vec2 range, uint decision) {
    probe(PROBE_screen_cell, vec4(travelled_at(ray, s), travelled_at(ray, s_out), ray.start + s_out * ray.across),
          vec4(1.0 / inverse_depth_at(ray, s), 1.0 / inverse_depth_at(ray, s_out), cell), vec4(level, range, decision));
}

// The position of a ray among the cells. A cell of level k covers 2ᵏ texels along each axis, and the last cell of a row the rest. Texels are
// numbered in the direction of the ray: with mirrored numbers -1 - x the cells stay the same, and texels ahead have larger numbers. A cell is
// identified by its last texel.
struct Walk {
    vec2 start, across, per_across; // mirrored
    ivec2 turn, last;               // turn: all bits for a mirrored axis, else none; last: mirrored
    int level, width;               // of the cell; in texels
};

Walk walk_from(CellRay path, ivec2 texel) {
    Walk walk;
    walk.turn = -ivec2(lessThan(path.across, vec2(-1e-30)));
    walk.last = texel ^ walk.turn;
    walk.start = vec2(walk.last) + 0.5;
    walk.across = abs(path.across);
    walk.per_across = abs(path.per_across);
    walk.level = 0;
    walk.width = 1;
    return walk;
}

ivec2 cell_of(Walk walk) {
    return min((walk.last ^ walk.turn) >> walk.level, (ivec2(frame.size.zw) >> walk.level) - 1);
}

vec2 exits_of(Walk walk) { return (vec2(walk.last) - (walk.start - 1.0)) * walk.per_across; }

// Goes to the next cell, and up a level if another parent begins there.
void step_on(inout Walk walk, bool along_x, int coarsest) {
    bool up = walk.level < coarsest && ((along_x ? walk.last.x : walk.last.y) & walk.width) != 0;
    walk.last += along_x ? ivec2(walk.width, 0) : ivec2(0, walk.width);
    if (!up) return;
    walk.last |= walk.width;
    walk.width <<= 1;
    ++walk.level;
}

// Goes down to the child that contains the ray at s.
void step_down(inout Walk walk, float s) {
    walk.width >>= 1;
    --walk.level;
    vec2 place = fma(vec2(s), walk.across, walk.start), middle = vec2(walk.last - walk.width + 1);
    walk.last -= mix(ivec2(0), ivec2(walk.width), lessThan(place, middle));
}

// most: cells visited.
Result march(ScreenRay ray, ivec2 texel, int most) {
    CellRay path = cell_ray(ray, texel);
    Walk walk = walk_from(path, texel);
    // A ray away from the viewer cannot hit anything before it reaches the nearest depth; a ray towards the viewer can.
    float per_rate = path.inverse_rate < 0.0 ? 1.0 / path.inverse_rate : -LARGEST;
    int coarsest = coarsest_level();
    vec2 exits = exits_of(walk);
    float s = min(min(exits.x, exits.y), path.end), s_front = s; // its own texel cannot stop a ray
    step_on(walk, exits.x <= exits.y, 0);
    Hidden hidden = Hidden(0.0, 0.0);
    Result result = Result(0.0, false, s < path.end ? END_steps_exhausted : path.limit, 0u, 0u);
    for (int i = s < path.end ? 0 : most; i < most; ++i) {
        ivec2 cell = cell_of(walk);
        vec2 range = texelFetch(hiz, cell, walk.level).xy; // inverse depth of the nearest and of the farthest
        exits = exits_of(walk);
        float s_out = min(min(exits.x, exits.y), path.end), u_in = inverse_at(path, s), u_out = inverse_at(path, s_out);
        bool along_x = exits.x <= exits.y;
        result.steps++;
        result.fetches++;
        uint what = min(u_in, u_out) > range.x ? IN_FRONT : PASSED;
        float highest = max(u_in - 0.5 * path.texel * path.inverse_rate, u_out); // a seam may connect to the texel before the cell
        if (what == PASSED && !passes_behind(hidden, path, s, s_out, range.y, highest)) {
            if (walk.level > 0) {
                probe_cell(ray, s, s_out, cell, walk.level, range, DECISION_descend);
                s = clamp((range.x - path.inverse) * per_rate - 1e-6, s, s_out);
                step_down(walk, s);
                continue;
            }
            what = meets(path, cell, s_out, hidden, s, result.fetches);
            probe_facet(ray, path, cell, s, s_out, what);
            if (what == MET) return Result(travelled_at(ray, s), true, END_hit, result.steps, result.fetches);
            if (what == BLOCKED) {
                result.end = END_behind;
                break;
            }
        } else {
            probe_cell(ray, s, s_out, cell, walk.level, range, what == IN_FRONT ? DECISION_front : DECISION_behind_all);
        }
        if (what == IN_FRONT) s_front = s_out;
        if (s_out >= path.end) {
            result.end = path.limit;
            break;
        }
        s = s_out;
        step_on(walk, along_x, coarsest);
    }
    result.travelled_m = travelled_at(ray, min(s_front, ray.end));
    return result;
}

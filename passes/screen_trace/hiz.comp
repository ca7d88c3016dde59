#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "hiz.pass.h"
#include "shared/push_begin.glsl"
#include "hiz.pass.h"
};
#include "screen_trace/cells.glsl"

// The coarsest level that is made: the first whose smaller side is under 8 texels.
int coarsest_level() { return max(findMSB(min(frame.size.z, frame.size.w)) - 2, 0); }

// Whether each texel of a cell lies wholly before the ray, none of them so close that it would be hit or block the ray:
// then all are passed at once.
precise bool passes_behind(inout Hidden hidden, CellRay ray, float s_in, float s_out, float farthest_m) {
    if (!pass_behind || !(farthest_m < LARGEST)) return false;
    float before = s_in - 0.5 * ray.texel; // a seam's reach
    float highest = max(inverse_at(ray, before), inverse_at(ray, s_out));
    if (highest * (farthest_m * (1.0 + thickness) + thickness_m) >= 0.999999) return false;
    Hidden ahead = hidden;
    hide(ahead, ray, s_in, s_out);
    float behind = (1.0 - farthest_m * highest) * inverse_at(ray, ahead.s_first);
    if (behind < 1.000001 * solid * (ahead.s_last - ahead.s_first) * ray.inverse) return false;
    hidden = ahead;
    return true;
}

// Whether the texel's facet ends the ray, which crosses it from s to s_out: true for a hit, or for what blocks it.
bool meets(CellRay path, vec2 cell, float s_out, inout Hidden hidden, inout float s, out bool front, inout Result result) {
    result.fetches += 2u;
    float inverse = texelFetch(inverse_half, ivec2(cell), 0).x;
    vec2 slopes = texelFetch(depth_slopes, ivec2(cell), 0).xy;
    s = cell_entry(path, cell);
    Crossing crossing = cross(path, cell, s, s_out, inverse, slopes);
    if (crossing.what == CELL_SEAM) {
        vec2 before = cell_before(path, cell);
        result.fetches += 2u;
        bool meet = joined(path, s, cell, inverse, slopes, before, texelFetch(inverse_half, ivec2(before), 0).x,
                           texelFetch(depth_slopes, ivec2(before), 0).xy);
        crossing.what = meet ? CELL_HIT : CELL_BEHIND;
    }
    front = crossing.what == CELL_FRONT;
    if (front) return false;
    result.end = END_hit;
    if (crossing.what == CELL_HIT) {
        s = crossing.s;
        return true;
    }
    result.end = END_behind;
    hide(hidden, path, s, s_out);
    return !pass_behind || blocked(hidden, path, inverse);
}

Result march(ScreenRay ray, ivec2 texel) {
    CellRay path = cell_ray(ray, texel);
    Result result = Result(0.0, false, END_steps_exhausted, 0u, 0u);
    vec2 stride = 2.0 * path.forward - 1.0, size = vec2(frame.size.zw), cell = vec2(texel);
    int coarsest = coarsest_level(), level = 0;
    float width = 1.0, per_rate = 1.0 / path.inverse_rate; // width of a cell in texels
    // Its own texel cannot stop a ray.
    precise vec2 exits = cell_exits(path, cell, width);
    precise float s = min(min(exits.x, exits.y), path.end);
    precise float s_front = s;
    Hidden hidden = Hidden(0.0, 0.0);
    if (exits.x <= exits.y) cell.x += stride.x;
    else cell.y += stride.y;
    bool inside = s < path.end && all(greaterThanEqual(cell, vec2(0.0))) && all(lessThan(cell, size));
    if (!inside) result.end = ray.limit;
    int most = cells_lq == cells || texelFetch(normal_half, texel, 0).w <= hq_roughness ? cells : cells_lq;
    for (int i = 0; inside && i < most; ++i) {
        exits = cell_exits(path, cell, width);
        precise float s_out = min(min(exits.x, exits.y), path.end);
        bool front;
        result.steps++;
        if (level > 0) {
            result.fetches++;
            ivec2 last = (ivec2(frame.size.zw) >> level) - 1;
            vec2 range_m = texelFetch(hiz, min(ivec2(cell), last), level).xy;
            front = max(min(inverse_at(path, s), inverse_at(path, s_out)), 1e-30) * range_m.x > 1.000001;
            if (!front && !passes_behind(hidden, path, s, s_out, range_m.y)) {
                // A ray that goes away from the viewer cannot meet anything before it reaches the nearest depth.
                if (path.inverse_rate < 0.0) s = clamp((1.0 / range_m.x - path.inverse) * per_rate - 1e-6, s, s_out);
                --level;
                width *= 0.5;
                cell = clamp(floor((path.start + s * path.across) / width), 2.0 * cell, 2.0 * cell + 1.0);
                continue;
            }
        } else if (meets(path, cell, s_out, hidden, s, front, result)) {
            if (result.end == END_behind) break;
            return Result(travelled_at(ray, s), true, END_hit, result.steps, result.fetches);
        }
        if (front) s_front = s_out;
        if (s_out >= path.end) {
            result.end = ray.limit;
            break;
        }
        s = s_out;
        bool along_x = exits.x <= exits.y;
        cell += along_x ? vec2(stride.x, 0.0) : vec2(0.0, stride.y);
        if (any(lessThan(cell, vec2(0.0))) || any(greaterThanEqual(cell * width, size))) {
            result.end = END_left_screen;
            break;
        }
        // The other parent's cell: an even one when the ray grows along the axis, an odd one when it does not.
        float half_cell = 0.5 * (along_x ? cell.x : cell.y);
        bool other_parent = (fract(half_cell) == 0.0) == (along_x ? stride.x > 0.0 : stride.y > 0.0);
        if (level < coarsest && other_parent) {
            cell = floor(0.5 * cell);
            ++level;
            width *= 2.0;
        }
        result.end = END_steps_exhausted;
    }
    result.travelled_m = travelled_at(ray, min(s_front, ray.end));
    return result;
}
#include "screen_trace/trace.glsl"

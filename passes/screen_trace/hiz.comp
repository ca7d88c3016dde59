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
    float before = s_in - 0.5 / max(abs(ray.across.x), abs(ray.across.y)); // a seam's reach
    float highest = max(max(inverse_at(ray, before), inverse_at(ray, s_in)), inverse_at(ray, s_out));
    if (highest * (farthest_m * (1.0 + thickness) + thickness_m) >= 0.999999) return false;
    Hidden ahead = hidden;
    hide(ahead, ray, s_in, s_out);
    float behind = (1.0 - farthest_m * highest) * inverse_at(ray, ahead.s_first);
    if (behind < 1.000001 * solid * (ahead.s_last - ahead.s_first) * ray.inverse) return false;
    hidden = ahead;
    return true;
}

Result march(ScreenRay ray, ivec2 texel) {
    CellRay cells = cell_ray(ray, texel);
    Result result = Result(0.0, false, END_steps_exhausted, 0u, 0u);
    ivec2 stride = 2 * cells.forward - 1, last = ivec2(frame.size.zw) - 1;
    int coarsest = coarsest_level(), level = 0;
    // Its own texel cannot stop a ray.
    ivec2 cell = texel;
    precise vec2 exits = cell_exits(cells, cell, 0);
    precise float s = min(min(exits.x, exits.y), cells.end);
    precise float s_front = s;
    Hidden hidden = Hidden(0.0, 0.0);
    if (exits.x <= exits.y) cell.x += stride.x;
    else cell.y += stride.y;
    bool inside = s < cells.end && all(greaterThanEqual(cell, ivec2(0))) && all(lessThanEqual(cell, last));
    if (!inside) result.end = ray.limit;
    for (int i = 0; inside && i < steps; ++i) {
        exits = cell_exits(cells, cell, level);
        precise float s_out = min(min(exits.x, exits.y), cells.end);
        bool front = true;
        result.steps++;
        if (level > 0) {
            result.fetches++;
            vec2 range_m = texelFetch(hiz, min(cell, (last + 1 >> level) - 1), level).xy;
            front = max(min(inverse_at(cells, s), inverse_at(cells, s_out)), 1e-30) * range_m.x > 1.000001;
            if (!front && !passes_behind(hidden, cells, s, s_out, range_m.y)) {
                // A ray that goes away from the viewer cannot meet anything before it reaches the nearest depth.
                if (cells.inverse_rate < 0.0)
                    s = clamp((1.0 / range_m.x - cells.inverse) / cells.inverse_rate - 1e-6, s, s_out);
                --level;
                cell = clamp(ivec2(floor(cells.start + s * cells.across)) >> level, 2 * cell, 2 * cell + 1);
                continue;
            }
        } else {
            result.fetches += 2u;
            float depth_m = texelFetch(depth_half, cell, 0).x;
            vec2 slopes = texelFetch(depth_slopes, cell, 0).xy;
            s = cell_entry(cells, cell);
            Crossing crossing = cross(cells, cell, s, s_out, depth_m, slopes);
            if (crossing.what == CELL_SEAM) {
                ivec2 before = cell_before(cells, cell);
                result.fetches += 2u;
                bool meet = joined(cells, s, cell, depth_m, slopes, before, texelFetch(depth_half, before, 0).x,
                                   texelFetch(depth_slopes, before, 0).xy);
                crossing.what = meet ? CELL_HIT : CELL_BEHIND;
            }
            if (crossing.what == CELL_HIT)
                return Result(travelled_at(ray, crossing.s), true, END_hit, result.steps, result.fetches);
            front = crossing.what == CELL_FRONT;
            if (!front) hide(hidden, cells, s, s_out);
            if (!front && (!pass_behind || blocked(hidden, cells, depth_m))) {
                result.end = END_behind;
                break;
            }
        }
        if (front) s_front = s_out;
        if (s_out >= cells.end) {
            result.end = ray.limit;
            break;
        }
        s = s_out;
        ivec2 parent = cell >> 1;
        if (exits.x <= exits.y) cell.x += stride.x;
        else cell.y += stride.y;
        ivec2 reached = cell << level;
        if (any(lessThan(cell, ivec2(0))) || any(greaterThan(reached, last))) {
            result.end = END_left_screen;
            break;
        }
        if (level < coarsest && parent != cell >> 1) {
            cell >>= 1;
            ++level;
        }
    }
    result.travelled_m = travelled_at(ray, min(s_front, ray.end));
    return result;
}
#include "screen_trace/trace.glsl"

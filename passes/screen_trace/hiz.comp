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
            float nearest_m = texelFetch(hiz, min(cell, (last + 1 >> level) - 1), level).x;
            float lowest = min(inverse_at(cells, s), inverse_at(cells, s_out));
            if (!(max(lowest, 1e-30) * nearest_m > 1.000001)) {
                // A ray that goes away from the viewer cannot meet anything before it reaches the nearest depth.
                if (cells.inverse_rate < 0.0)
                    s = clamp((1.0 / nearest_m - cells.inverse) / cells.inverse_rate - 1e-6, s, s_out);
                --level;
                cell = clamp(ivec2(floor(cells.start + s * cells.across)) >> level, 2 * cell, 2 * cell + 1);
                continue;
            }
        } else {
            result.fetches += 2u;
            float depth_m = texelFetch(depth_half, cell, 0).x;
            vec2 slopes = texelFetch(depth_slopes, cell, 0).xy;
            Crossing crossing = cross(cells, cell, cell_entry(cells, cell), s_out, depth_m, slopes);
            if (crossing.what == CELL_HIT)
                return Result(travelled_at(ray, crossing.s), true, END_hit, result.steps, result.fetches);
            front = crossing.what == CELL_FRONT;
            if (!front && (!pass_behind || blocked(cells, s_front, s_out, depth_m))) {
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

// Visits every texel that a ray crosses, one after the other. Next include of a pass with the rows of cell_rows.h and the parameter cells.
#include "cells.glsl"
#include "shared/facet_at.glsl"

Result march(ScreenRay ray, ivec2 texel) {
    CellRay path = cell_ray(ray, texel);
    Result result = Result(0.0, false, END_steps_exhausted, 0u, 0u);
    vec2 cell = vec2(texel), stride = 2.0 * path.forward - 1.0;
    precise float s_front = 0.0, s_in = 0.0;
    Hidden hidden = Hidden(0.0, 0.0);
    for (int i = 0; i < cells; ++i) {
        precise vec2 exits = cell_exits(path, cell);
        precise float s_out = min(min(exits.x, exits.y), path.end);
        if (i > 0) { // a ray cannot hit its own texel
            float depth_m = texelFetch(depth_half, ivec2(cell), 0).x, inverse = texelFetch(inverse_half, ivec2(cell), 0).x;
            result.steps++;
            result.fetches += 2u;
            Crossing crossing = Crossing(CELL_FRONT, s_out);
            vec2 slopes = vec2(0.0);
            // The ray is in front of any facet of this depth, since a facet rises to at most twice its inverse depth.
            if (min(inverse_at(path, s_in), inverse_at(path, s_out)) * depth_m < 1.0 + STEEPEST) {
                result.fetches += 5u;
                slopes = facet_slopes_at(ivec2(cell), depth_m);
                crossing = cross(path, cell, s_in, s_out, seam * path.texel, inverse, slopes);
            }
            if (crossing.what == CELL_SEAM) {
                vec2 before = cell_before(path, cell);
                float before_m = texelFetch(depth_half, ivec2(before), 0).x;
                float before_inverse = texelFetch(inverse_half, ivec2(before), 0).x;
                result.fetches += 12u;
                bool meet = joined(path, s_in, cell, inverse, slopes, before, before_inverse,
                                   facet_slopes_at(ivec2(before), before_m));
                crossing.what = meet ? CELL_HIT : CELL_BEHIND;
            }
            probe_crossing(ray, path, cell, s_in, crossing.what == CELL_HIT ? crossing.s : s_out, inverse, slopes, crossing.what);
            if (crossing.what == CELL_HIT)
                return Result(travelled_at(ray, crossing.s), true, END_hit, result.steps, result.fetches);
            if (crossing.what == CELL_BEHIND) {
                hide(hidden, path, s_in, s_out, 0.0);
                if (!pass_behind || blocked(hidden, path, inverse)) {
                    result.end = END_behind;
                    break;
                }
            } else {
                s_front = s_out;
            }
        } else {
            s_front = s_out;
        }
        if (s_out >= path.end) {
            result.end = path.limit;
            break;
        }
        if (exits.x <= exits.y) cell.x += stride.x;
        else cell.y += stride.y;
        s_in = s_out;
    }
    result.travelled_m = travelled_at(ray, min(s_front, ray.end));
    return result;
}

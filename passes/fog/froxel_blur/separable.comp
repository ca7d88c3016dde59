#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "separable.pass.h"
#include "shared/push_begin.glsl"
#include "separable.pass.h"
};
#include "shared/constants.glsl"
#include "shared/froxels.glsl"
#include "fog/cells.glsl"

// Pixels without a valid depth hide nothing.
float farthest_in(ivec2 column) {
    ivec2 cells = ivec2(frame.froxels.xy), size = ivec2(frame.size.xy), first = column * size / cells;
    ivec2 end = ((column + 1) * size + cells - 1) / cells;
    float most = 0.0;
    for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x) {
            float depth_m = texelFetch(depth_full, ivec2(x, y), 0).x;
            most = depth_m > 0.0 ? max(most, depth_m) : INFINITE;
        }
    return most;
}

bool is_cell(ivec3 cell) { return all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, ivec3(frame.froxels.xyz))); }
float begin_of(int slice) { return froxel_depth(slice, frame.froxels.z, frame.froxel_range); }
// begin_m: the depth at which the cell begins.
bool is_hidden(ivec3 cell, float begin_m) { return stencil && begin_m > texelFetch(farthest, cell.xy, 0).x; }

vec3 light_in(ivec3 cell) {
    if (dispatch_phase == 2u) return texelFetch(across, texel_of(cell), 0).rgb;
    if (dispatch_phase == 3u) return texelFetch(down, texel_of(cell), 0).rgb;
    return captured_light(cell);
}

// Slices are of different thickness: the thinner one of two says how much light they exchange.
vec3 blurred(ivec3 cell, float begin_m, vec3 own, int reach) {
    ivec3 axis = ivec3(dispatch_phase == 1u, dispatch_phase == 2u, dispatch_phase == 3u);
    float all = float((reach + 1) * (reach + 1));
    float thick_m = begin_of(cell.z + 1) - begin_m;
    vec3 change = vec3(0.0);
    for (int i = -reach; i <= reach; ++i) {
        ivec3 other = cell + i * axis;
        float other_m = dispatch_phase == 3u ? begin_of(other.z) : begin_m;
        if (i == 0 || !is_cell(other) || is_hidden(other, other_m)) continue;
        float thinner = dispatch_phase == 3u ? min(1.0, (begin_of(other.z + 1) - other_m) / thick_m) : 1.0;
        change += float(reach + 1 - abs(i)) / all * thinner * (light_in(other) - own);
    }
    return max(own + change, 0.0);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (dispatch_phase == 0u) {
        if (all(lessThan(at, imageSize(froxel_far)))) imageStore(froxel_far, at, vec4(frame.froxels.w != 0u ? farthest_in(at) : INFINITE));
        return;
    }
    if (any(greaterThanEqual(at, imageSize(froxel_blurred)))) return;
    int high = max(int(frame.froxels.y), 1), reach = dispatch_phase == 3u ? radius_depth : radius;
    ivec3 cell = ivec3(at.x, at.y % high, at.y / high);
    vec3 light = light_in(cell);
    float begin_m = begin_of(cell.z);
    if (reach > 0 && frame.froxels.w != 0u && !is_hidden(cell, begin_m)) light = blurred(cell, begin_m, light, reach);
    if (dispatch_phase == 1u) imageStore(froxel_across, at, vec4(light, 1.0));
    else if (dispatch_phase == 2u) imageStore(froxel_down, at, vec4(light, 1.0));
    else imageStore(froxel_blurred, at, vec4(light, 1.0));
}

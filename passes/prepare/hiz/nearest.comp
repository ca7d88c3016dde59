#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "nearest.pass.h"
#include "shared/push_begin.glsl"
#include "nearest.pass.h"
};
#include "shared/facet_at.glsl"

const float NO_SURFACE = -1.0; // no ray can be behind it

void store_facet(ivec2 at) {
    if (any(greaterThanEqual(at, imageSize(depth_slopes)))) return;
    float depth_m = texelFetch(depth_half, at, 0).x;
    vec2 slopes = facet_slopes_at(at, depth_m);
    imageStore(depth_slopes, at, vec4(slopes, 0.0, 0.0));
    // The slopes are rounded to half, which moves the rise by less than a thousandth of it.
    float rise = 1.001 * facet_rise(slopes), fall = 2.0 * rise;
    float inverse = depth_m < LARGEST ? min(1.0 / depth_m, LARGEST) : 0.0; // that of a denormal depth is infinite
    vec2 range = inverse > 0.0 ? inverse * vec2(1.000001 + rise, max(1.0 - fall, 0.0)) : vec2(NO_SURFACE, 0.0);
    imageStore(hiz, at, vec4(range, 0.0, 0.0));
}

// Two cells of the finer level along each axis, and a third one at the end if the finer level's size is odd.
void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (dispatch_phase == 0u) {
        store_facet(at);
        return;
    }
    ivec2 size = imageSize(hiz);
    if (any(greaterThanEqual(at, size))) return;
    int level = int(dispatch_level) - 1;
    ivec2 last = textureSize(finer, level) - 1, first = 2 * at;
    ivec2 end = min(first + 1 + ivec2(equal(at, size - 1)), last);
    vec2 range = vec2(NO_SURFACE, LARGEST);
    for (int y = first.y; y <= end.y; ++y)
        for (int x = first.x; x <= end.x; ++x) {
            vec2 cell = texelFetch(finer, ivec2(x, y), level).xy;
            range = vec2(max(range.x, cell.x), min(range.y, cell.y));
        }
    imageStore(hiz, at, vec4(range, 0.0, 0.0));
}

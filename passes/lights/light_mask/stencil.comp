#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "stencil.pass.h"
#include "shared/push_begin.glsl"
#include "stencil.pass.h"
};
#include "lamps/lamp.glsl"

bool has_mask(int lamp) {
    uvec4 bounds = frame.lamp_bounds[lamp];
    uvec2 size = bounds.zw - bounds.xy;
    return float(size.x * size.y) >= share * float(frame.size.x * frame.size.y);
}

// Sky and invalid depths are not lit.
uint touched(ivec2 pixel, float depth_m) {
    vec3 place = surface_place(pixel, depth_m);
    bool is_surface = depth_m > 0.0 && depth_m < LARGEST;
    uint bits = 0u;
    for (int lamp = 0; lamp < min(int(frame.lamps.x), 32); ++lamp)
        if (!has_mask(lamp) || (is_surface && lamp_reaches(lamp, place, true, true))) bits |= 1u << lamp;
    return bits;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(light_mask)))) return;
    imageStore(light_mask, pixel, uvec4(touched(pixel, texelFetch(depth_full, pixel, 0).x)));
}

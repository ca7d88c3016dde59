#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "boxes.pass.h"
#include "shared/push_begin.glsl"
#include "boxes.pass.h"
};
#include "shared/camera.glsl"

void store(ivec2 cell, vec3 lowest, vec3 highest) {
    bool some = all(lessThanEqual(lowest, highest));
    imageStore(bounds_low, cell, some ? vec4(lowest, 1.0) : vec4(0.0));
    imageStore(bounds_high, cell, some ? vec4(highest, 1.0) : vec4(0.0));
}

void store_texel(ivec2 texel) {
    float depth_m = texelFetch(depth_half, texel, 0).x;
    vec2 uv = picked_uv(texel, texelFetch(pick, texel, 0).x, frame.size);
    vec3 place = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    bool some = depth_m > 0.0 && depth_m < LARGEST;
    store(texel, some ? place : vec3(LARGEST), some ? place : vec3(-LARGEST));
}

void main() {
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy), size = imageSize(bounds_low);
    if (any(greaterThanEqual(cell, size))) return;
    if (dispatch_level == 0u) {
        store_texel(cell);
        return;
    }
    int level = int(dispatch_level) - 1;
    ivec2 last = textureSize(low, level) - 1, first = 2 * cell;
    ivec2 end = min(first + 1 + ivec2(equal(cell, size - 1)), last);
    vec3 lowest = vec3(LARGEST), highest = vec3(-LARGEST);
    for (int y = first.y; y <= end.y; ++y)
        for (int x = first.x; x <= end.x; ++x) {
            vec4 one = texelFetch(low, ivec2(x, y), level);
            if (one.w == 0.0) continue;
            lowest = min(lowest, one.xyz);
            highest = max(highest, texelFetch(high, ivec2(x, y), level).xyz);
        }
    store(cell, lowest, highest);
}

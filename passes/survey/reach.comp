#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "reach.pass.h"
#include "shared/push_begin.glsl"
#include "reach.pass.h"
};
#include "shared/active.glsl"
#include "shared/camera.glsl"
#include "shared/shown.glsl"
#include "shared/work_list.glsl"

// How much larger a face is taken than it is: what of its neighbours lies within a 64th of a face's width, and within a tenth,
// counts as its own (replay/reach.c). A 32nd of the half width e: 1 / (1 - e) - 1, and something for rounded normals.
const float CROSSED = 1.0 / 28.0, NEARBY = 0.26;
shared uint faces[8];

// The way of a ray from its surface to infinity, as a centre sees it: (1 - x) · from + x · towards, x from 0 to 1. It crosses
// a face where its part along the face's axis is the largest one: between bounds on x, one for each border.
bool crosses(vec3 from, vec3 towards, int face, float margin) {
    int axis = face >> 1;
    float front = (face & 1) == 0 ? 1.0 + margin : -1.0 - margin;
    vec2 span = vec2(0.0, 1.0);
    for (int border = 0; border < 4; ++border) {
        int other = (axis + 1 + (border >> 1)) % 3;
        float side = (border & 1) == 0 ? 1.0 : -1.0;
        float first = front * from[axis] + side * from[other], last = front * towards[axis] + side * towards[other];
        if (first < 0.0 && last < 0.0) return false;
        if (first < 0.0) span.x = max(span.x, first / (first - last));
        if (last < 0.0) span.y = min(span.y, first / (first - last));
    }
    return span.x <= span.y + 1e-5;
}

void follow(vec3 origin, vec3 direction) {
    for (int place = 0; place < int(min(frame.counts.x, ACTIVE_MOST)); ++place) {
        vec3 from = origin - active_centers[place].xyz;
        bool all = !(length(from) > 1e-3 * (1.0 + length(origin))); // its direction is not known
        from = normalize(from);
        for (int face = 0; face < 6; ++face) {
            int bit = 6 * place + face, word = bit >> 5;
            uint mask = 1u << (bit & 31);
            if ((faces[word] & mask) != 0u || !(all || crosses(from, direction, face, NEARBY))) continue;
            atomicOr(faces[4 + word], mask);
            if (all || crosses(from, direction, face, CROSSED)) atomicOr(faces[word], mask);
        }
    }
}

void main() {
    load_active_centers();
    int lane = int(gl_LocalInvocationIndex);
    if (lane < 8) faces[lane] = 0u;
    barrier();
    for (int row = lane >> 6; row < 64; row += 2) {
        ivec2 pixel = 64 * ivec2(gl_WorkGroupID.xy) + ivec2(lane & 63, row);
        if (!inside(pixel, ivec2(frame.size.xy)) || !is_shown(pixel)) continue;
        float depth_m = texelFetch(depth_full, pixel, 0).x;
        vec4 surface = texelFetch(normal_full, pixel, 0);
        if (!reflects(depth_m, surface.xyz)) continue;
        vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
        vec3 origin = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
        if (surface.w > 0.0) for (int word = 0; word < 8; ++word) faces[word] = 0xFFFFFFFFu; // from a lobe: anywhere
        else follow(origin, mirror_direction(origin, surface.xyz));
    }
    barrier();
    if (lane < 8) imageStore(ray_ways, LIST_ITEMS + 8 * int(workgroup_index()) + lane, uvec4(faces[lane]));
    if (gl_GlobalInvocationID.xy == uvec2(0u)) imageStore(ray_ways, LIST_COUNT, uvec4(8u * gl_NumWorkGroups.x * gl_NumWorkGroups.y));
}

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
#define LIST_WORD(place) texelFetch(partial, place).x
#include "shared/work_list.glsl"

// Margins around a face: directions within a texel of it, or within a tenth of its width, count as reaching it (replay/frame/faces.c). For a
// fraction e of the half width the margin is 1 / (1 - e) - 1, plus some for rounded normals.
const float ROUNDED = 0.0035, NEARBY = 0.26;
float margin_of(float e) { return 1.0 / (1.0 - min(e, 0.9)) - 1.0 + ROUNDED; }
shared uint faces[8];

// The path of a ray from its surface to infinity as seen from a centre: (1 - x) · from + x · towards, x from 0 to 1. It crosses a face where
// its component along the face's axis is the largest, which bounds x at each border.
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
    float beside = margin_of(2.0 / float(frame.counts.z));
    for (int place = 0; place < int(min(frame.counts.x, ACTIVE_MOST)); ++place) {
        vec3 from = origin - active_centers[place].xyz;
        bool all = !(length(from) > 1e-3 * (1.0 + length(origin))); // its direction is undefined
        from = normalize(from);
        for (int face = 0; face < 6; ++face) {
            int bit = 6 * place + face, word = bit >> 5;
            uint mask = 1u << (bit & 31);
            if ((faces[word] & mask) != 0u || !(all || crosses(from, direction, face, max(beside, NEARBY)))) continue;
            atomicOr(faces[4 + word], mask);
            if (all || crosses(from, direction, face, beside)) atomicOr(faces[word], mask);
        }
    }
}

void follow_pixel(ivec2 pixel) {
    if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    vec4 surface = texelFetch(normal_full, pixel, 0);
    if (!reflects(depth_m, surface.xyz)) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
    vec3 origin = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    if (surface.w > 0.0) for (int word = 0; word < 8; ++word) faces[word] = 0xFFFFFFFFu; // rays of a lobe may reach any face
    else follow(origin, mirror_direction(origin, surface.xyz));
}

// The rays of those pixels of a block that have a visible reflection.
void follow_block(ivec2 block) {
    if (any(greaterThanEqual(block, ivec2(frame.size.xy)))) return;
    uint shown = BLOCK == 1 ? uint(is_shown(block)) : shown_in_block(block);
    for (uint left = shown; left != 0u; left &= left - 1u) {
        int i = findLSB(left);
        follow_pixel(block + ivec2(i & 1, i >> 1));
    }
}

// Each workgroup combines one word of all tiles.
void join_tiles(uvec2 tiles) {
    uint own = 0u, word = workgroup_index(), lanes = gl_WorkGroupSize.x * gl_WorkGroupSize.y;
    if (word >= 8u) return;
    for (uint tile = gl_LocalInvocationIndex; tile < tiles.x * tiles.y; tile += lanes)
        own |= LIST_WORD(LIST_ITEMS + int(8u * tile + word));
    if (own != 0u) atomicOr(faces[word], own);
    barrier();
    if (gl_LocalInvocationIndex == 0u) imageStore(reached_faces, ivec2(word, 0), uvec4(faces[word]));
}

void main() {
    load_active_centers();
    uint lane = gl_LocalInvocationIndex;
    if (lane < 8u) faces[lane] = 0u;
    barrier();
    if (dispatch_phase == 0u) {
        follow_block(BLOCK * ivec2(gl_GlobalInvocationID.xy));
        barrier();
        if (lane < 8u) imageStore(tile_faces, LIST_ITEMS + int(8u * workgroup_index() + lane), uvec4(faces[lane]));
    } else {
        uvec2 tile = uint(BLOCK) * gl_WorkGroupSize.xy;
        join_tiles((frame.size.xy + tile - 1u) / tile);
    }
}

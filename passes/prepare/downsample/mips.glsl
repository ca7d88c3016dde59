// Picks the pixels of three levels and finds the edges between them. Next include of a pass with the rows of mips_rows.h.
#include "choose.glsl"
#include "surface.glsl"
#include "level_edges.glsl"

const uint SHARE_FINEST = 0u, SHARE_COARSER = 1u, SHARE_EDGES = 2u; // dispatch phases

float inverse_of(float depth_m) { return depth_m > 0.0 ? 1.0 / depth_m : 0.0; }

void pick_pixel(ivec2 texel) {
    ivec2 block = 2 * texel, size = ivec2(frame.size.xy);
    vec4 depths_m = textureGather(sampler2D(depth_full, nearest_clamp), vec2(block + 1) / vec2(size)).wzxy;
    vec4 inverse;
    for (int i = 0; i < 4; ++i) inverse[i] = inverse_of(depths_m[i]);
    uint useful = useful_in_block(block, inverse), chosen = choose(block, inverse, useful, size);
    ivec2 source = block + ivec2(chosen & 1u, chosen >> 1u);
    vec4 surface = texelFetch(normal_full, source, 0);
    bool shown = (useful >> chosen & 1u) != 0u;
    store_surface(texel, depths_m[chosen], surface, chosen, shown);
    bool has_vertex = vertex_planes && textureSize(vertex_normal_full, 0) == size;
    vec3 vertex = has_vertex ? texelFetch(vertex_normal_full, source, 0).xyz : surface.xyz;
    bool used = shown && reflects(depths_m[chosen], surface.xyz);
    imageStore(depth_levels, texel, vec4(depths_m[chosen] > 0.0 ? depths_m[chosen] : INFINITE));
    imageStore(normal_levels, texel,
               used ? vec4(normalize(surface.xyz), surface.w > 0.0 ? min(surface.w, 1.0) : 0.0) : vec4(0.0));
    imageStore(vertex_normal_levels, texel,
               vec4(used && reflects(1.0, vertex) ? normalize(vertex) : vec3(0.0), (chosen & 1u) + 8u * (chosen >> 1u)));
}

void pick_texel(ivec2 texel) {
    int finer = int(dispatch_level) - 1;
    ivec2 block = 2 * texel, size = textureSize(depths, finer);
    vec4 inverse;
    for (int i = 0; i < 4; ++i)
        inverse[i] = inverse_of(texelFetch(depths, min(block + ivec2(i & 1, i >> 1), size - 1), finer).x);
    uint chosen = choose(block, inverse, 15u, size);
    ivec2 source = block + ivec2(chosen & 1u, chosen >> 1u);
    vec4 vertex = texelFetch(vertex_normals, source, finer);
    uint step = 2u << finer; // a texel of the finer level in pixels
    vertex.w += float(step * (chosen & 1u) + 8u * step * (chosen >> 1u));
    imageStore(depth_levels, texel, texelFetch(depths, source, finer));
    imageStore(normal_levels, texel, texelFetch(normals, source, finer));
    imageStore(vertex_normal_levels, texel, vertex);
}

Texel texel_at(ivec2 at, int level) {
    Texel t;
    vec4 vertex = texelFetch(vertex_normals, at, level);
    uint place = uint(vertex.w);
    vec2 uv = (vec2((at << level + 1) + ivec2(place & 7u, place >> 3u)) + 0.5) / vec2(frame.size.xy);
    t.depth_m = texelFetch(depths, at, level).x;
    t.position = view_position(uv, t.depth_m, frame.view_from_uv, frame.depth_range.z);
    t.surface = texelFetch(normals, at, level);
    t.plane = mat3(frame.view_from_world) * (vertex_planes && vertex.xyz != vec3(0.0) ? vertex.xyz : t.surface.xyz);
    return t;
}

ivec2 level_size(int level) { return textureSize(depths, level); }
float alike(vec4 a, vec4 b) {
    return within(1.0 - dot(a.xyz, b.xyz), edge_normal, 4.0) * within(abs(a.w - b.w), edge_roughness, 1.0);
}

// The phases of slot.h and mips_rows.h.
void make_levels() {
    ivec2 texel = tile_texel(2.0);
    if (dispatch_phase == SHARE_FINEST) {
        if (all(lessThan(texel, imageSize(depth_half)))) pick_pixel(texel);
    } else if (any(greaterThanEqual(texel, imageSize(depth_levels)))) {
        return;
    } else if (dispatch_phase == SHARE_COARSER) {
        pick_texel(texel);
    } else {
        imageStore(edge_levels, texel, uvec4(edges_of(texel, int(dispatch_level))));
    }
}

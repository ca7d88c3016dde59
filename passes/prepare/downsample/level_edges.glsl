// How continuous the surfaces of neighbouring texels of a level are. Next include of a pass with the parameter edge_plane that defines afterwards
// Texel texel_at(ivec2 at, int level)
// ivec2 level_size(int level)
// float alike(vec4 a, vec4 b)     how much two surfaces agree beside their planes, 0 to 1
#include "shared/camera.glsl"
#include "shared/edges.glsl"

struct Texel {
    vec3 position, plane; // in view space; plane: the geometric normal
    float depth_m;
    vec4 surface; // xyz: normal in world space, 0 where there is none; w: roughness
};
Texel texel_at(ivec2 at, int level);
ivec2 level_size(int level);
float alike(vec4 a, vec4 b);

// 1 up to half of the limit, 0 from the limit on; 0 for NaN.
float within(float apart, float limit, float off) {
    if (limit >= off) return 1.0;
    return apart <= limit ? clamp(2.0 - 2.0 * apart / max(limit, 1e-20), 0.0, 1.0) : 0.0;
}

float open_to(Texel a, ivec2 at, int level) {
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, level_size(level)))) return 0.0;
    Texel b = texel_at(at, level);
    if (!reflects(b.depth_m, b.surface.xyz)) return 0.0;
    vec3 way = b.position - a.position;
    float apart = max(abs(dot(way, a.plane)), abs(dot(way, b.plane))) / min(a.depth_m, b.depth_m);
    return within(apart, edge_plane, 10.0) * alike(a.surface, b.surface);
}

uint edges_of(ivec2 texel, int level) {
    Texel own = texel_at(texel, level);
    if (!reflects(own.depth_m, own.surface.xyz)) return 0u;
    return packed_side(open_to(own, texel - ivec2(1, 0), level), SIDE_LEFT) |
           packed_side(open_to(own, texel + ivec2(1, 0), level), SIDE_RIGHT) |
           packed_side(open_to(own, texel - ivec2(0, 1), level), SIDE_UP) |
           packed_side(open_to(own, texel + ivec2(0, 1), level), SIDE_DOWN);
}

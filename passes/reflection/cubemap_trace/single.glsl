// Tracers that use a single cube map and take no steps. Next include of a pass that defines
// Result end_of(vec3 origin, vec3 direction, float start_m, uint best).
#include "shared/active.glsl"
#include "shared/camera.glsl"
#include "shared/end_reasons.glsl"
#define LIST_WORD(place) (has_cubemap_list ? texelFetch(cubemap_list, place).x : texelFetch(tile_list, place).x)
#include "shared/work_list.glsl"
#include "place.glsl"
#include "sky.glsl"
#include "probe.glsl"

struct Result {
    float travelled_m;
    uint place, end, fetches;
};

// Samples the cube map in the ray's direction, sky included.
Result by_direction(uint best) { return Result(INFINITE, best, END_fallback, 0u); }

Result end_of(vec3 origin, vec3 direction, float start_m, uint best);

void store(ivec2 pixel, Result result) {
    probe_cubemap_end(result.travelled_m, result.place, result.end, 0u, result.fetches);
    imageStore(travelled, pixel, vec4(result.travelled_m));
    imageStore(cubemap_index, pixel, uvec4(result.place));
    if (!diagnostics) return;
    imageStore(cubemap_end, pixel, uvec4(result.end));
    imageStore(cubemap_steps, pixel, uvec4(0u));
    imageStore(cubemap_fetches, pixel, uvec4(result.fetches));
}

bool has_ray(ivec2 pixel, out float depth_m, out vec3 normal) {
    if (texelFetch(screen_finished, pixel, 0).x != 0u) return false;
    depth_m = texelFetch(depth_half, pixel, 0).x;
    normal = texelFetch(normal_jittered, pixel, 0).xyz;
    return reflects(depth_m, normal);
}

Result traced(ivec2 pixel, float depth_m, vec3 normal) {
    float start_m = texelFetch(screen_travelled, pixel, 0).x;
    uint best = texelFetch(cubemap_best, pixel, 0).x;
    vec2 uv = picked_uv(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    vec3 origin = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    vec3 direction = mirror_direction(origin, normal);
    if (best >= frame.counts.x) return Result(travelled_without_cubemaps(start_m, direction), NO_PLACE, END_no_cubemap, 0u);
    probe_cubemap_ray(origin, direction, start_m, best);
    return end_of(origin, direction, start_m, best);
}

void main() {
    load_active_centers();
    ivec2 pixel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(pixel, imageSize(travelled)))) return;
    float depth_m;
    vec3 normal;
    bool has = tile_works && has_ray(pixel, depth_m, normal);
    probe_texel(pixel);
    if (has) store(pixel, traced(pixel, depth_m, normal));
    else store(pixel, Result(texelFetch(screen_travelled, pixel, 0).x, NO_PLACE, END_not_traced, 0u));
}

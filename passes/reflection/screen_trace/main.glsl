// Processes every pixel that has a ray. Next include of a variant that defines
// Result trace(ivec2 pixel, float depth_m, vec3 normal).
#define LIST_WORD(place) (has_screen_list ? texelFetch(screen_list, place).x : texelFetch(tile_list, place).x)
#include "shared/work_list.glsl"

void store(ivec2 pixel, Result result) {
    probe_screen_end(result);
    imageStore(screen_travelled, pixel, vec4(result.travelled_m));
    imageStore(screen_finished, pixel, uvec4(result.finished ? 1u : 0u));
    if (!diagnostics) return;
    imageStore(screen_end, pixel, uvec4(result.end));
    imageStore(screen_steps, pixel, uvec4(result.steps));
    imageStore(screen_fetches, pixel, uvec4(result.fetches));
}

bool has_ray(ivec2 pixel, out float depth_m, out vec3 normal) {
    depth_m = texelFetch(depth_half, pixel, 0).x;
    vec4 surface = texelFetch(normal_jittered, pixel, 0);
    normal = surface.xyz;
    if (has_screen_rejected && texelFetch(screen_rejected, pixel, 0).x != 0u) return false;
    return surface.w <= max_roughness && reflects(depth_m, normal);
}

void main() {
    ivec2 pixel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(pixel, imageSize(screen_travelled)))) return;
    float depth_m;
    vec3 normal;
    bool traced = tile_works && has_ray(pixel, depth_m, normal);
    probe_texel(pixel);
    if (traced) store(pixel, trace(pixel, depth_m, normal));
    else store(pixel, Result(0.0, false, END_not_traced, 0u, 0u));
}

// Traces the directions of every texel of the level. Next include of a variant that defines Result trace_from(vec2 start, vec3 position,
// vec3 direction, ivec2 texel, uint number), a ray on screen; number: a different one for each ray and frame.
#include "shared/blue_noise.glsl"
#include "shared/hemisphere.glsl"
#include "screen_rays/receiver_normal.glsl"
#include "shared/luminance.glsl"
#include "shared/sampling.glsl"
#include "light.glsl"

struct Gathered {
    vec3 light;
    float missed;
    uint steps, fetches;
};

int traced_level() { return has_surface_levels ? level : 0; }

// The texel at the pipeline's resolution that a texel of the level was picked from.
ivec2 finest_of(ivec2 texel) {
    if (traced_level() == 0) return texel;
    uint place = uint(texelFetch(surface_levels, texel, level).w);
    int scale = int(reduction(frame.size));
    ivec2 pixel = (texel << level) * scale + ivec2(place & 7u, place >> 3u);
    return min(pixel / scale, ivec2(frame.size.zw) - 1);
}

vec2 numbers_of(ivec2 texel, uint ray) {
    uint number = shuffle ? frame.counts.y : 0u;
    if (pattern == pattern_blue) return blue_noise2(uvec2(texel), number, ray);
    if (pattern == pattern_sobol) return ray_points2(uvec2(texel), number, ray);
    return random4(uvec2(texel), number + ray * 0x9E3779B9u, RANDOM_INDIRECT).xy;
}

vec3 no_brighter(vec3 light) {
    float bright = luminance(light);
    return brightest < 1e6 && bright > brightest ? light * (brightest / bright) : light;
}

Gathered gather(ivec2 texel, ivec2 finest, float depth_m, vec3 shading) {
    Gathered sum = Gathered(vec3(0.0), 0.0, 0u, 0u);
    vec2 start = picked_position(finest, texelFetch(pick, finest, 0).x, frame.size);
    vec3 position = view_position(start / vec2(frame.size.xy), depth_m, frame.view_from_uv, frame.depth_range.z), tangent, bitangent;
    vec3 normal = mat3(frame.view_from_world) * normalize(receiver_normal(start, shading));
    tangent_frame(normal, tangent, bitangent);
    for (int i = 0; i < directions; ++i) {
        uint ray = frame.flags.w * uint(directions) + uint(i);
        vec3 local = cosine_direction(numbers_of(texel, ray));
        precise vec3 direction = normalize(local.x * tangent + local.y * bitangent + local.z * normal);
        Result traced = trace_from(start, position, direction, finest, frame.counts.y + ray * 0x9E3779B9u);
        Arriving arriving = arriving_light(mat3(frame.world_from_view) * position, mat3(frame.world_from_view) * direction, traced);
        sum.light += no_brighter(arriving.light);
        sum.missed += arriving.missed;
        sum.steps += traced.steps;
        sum.fetches += traced.fetches + arriving.fetches;
    }
    return sum;
}

void main() {
    load_active_centers();
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(indirect_traced)))) return;
    Gathered sum = Gathered(vec3(0.0), 0.0, 0u, 0u);
    bool works = int(dispatch_level) == traced_level();
    if (works) {
        ivec2 finest = finest_of(texel);
        float depth_m = texelFetch(depth_half, finest, 0).x;
        vec3 shading = texelFetch(normal_half, finest, 0).xyz;
        if (reflects(depth_m, shading)) sum = gather(texel, finest, depth_m, shading);
    }
    float part = 1.0 / float(directions);
    imageStore(indirect_traced, texel, works ? vec4(storable(sum.light * part, frame.up.w), sum.missed * part) : vec4(-1.0));
    if (!diagnostics) return;
    imageStore(indirect_steps, texel, uvec4(sum.steps));
    imageStore(indirect_fetches, texel, uvec4(sum.fetches));
}

// A pixel's water surface, and what it reflects. Next include of a pass with the rows of surface_rows.h that defines, behind this,
// vec3 seen_through(Water water, ivec2 pixel)    the colour behind the water.
#include "shared/brdf.glsl"
#include "shared/camera.glsl"
#include "shared/cube_filter.glsl"
#define LIST_WORD(place) texelFetch(water_tiles, place).x
#include "shared/work_list.glsl"
#include "shared/probe/record.glsl"
#include "through.glsl"

struct Water {
    vec3 position, towards, normal, own; // own: the light it scatters
    float thickness_m, opacity;
};

vec3 seen_through(Water water, ivec2 pixel);

ivec2 pixel_at(vec2 uv) { return clamp(ivec2(uv * vec2(frame.size.xy)), ivec2(0), ivec2(frame.size.xy) - 1); }

// The position of a point in the picture.
vec2 seen_at(vec3 point) { return project(mat3(frame.view_from_world) * point, frame.uv_from_view, frame.depth_range.z); }

vec3 mirrored(Water water, ivec2 pixel) {
    vec4 planar = has_planar_reflection ? texelFetch(planar_reflection, pixel, 0) : vec4(0.0);
    if (planar.a >= 1.0) {
        probe_layer(IMAGE_mixture, vec3(0.0), IMAGE_planar_reflection, planar.rgb, vec3(1.0));
        return planar.rgb;
    }
    vec3 ray = reflect(water.towards, water.normal);
    ray += max(-dot(ray, frame.up.xyz), 0.0) * frame.up.xyz;
    vec3 color = cube_finest(sky, ray).rgb;
    uint under = IMAGE_sky;
    probe(PROBE_color, vec4(IMAGE_sky, 255.0, vec2(0.0)), vec4(0.0, color), vec4(1.0));
    if (environment && frame.counts.x > 0u) {
        vec4 around = cube_finest(cubemap_color, vec4(ray, 0.0));
        probe(PROBE_color, vec4(IMAGE_cubemap_color, vec3(0.0)), vec4(0.0, around.rgb), vec4(around.a));
        color = around.rgb + color * (1.0 - around.a);
        under = IMAGE_mixture;
    }
    return probed_mix(under, color, IMAGE_planar_reflection, planar.rgb, planar.a);
}

void main() {
    ivec2 pixel = tile_texel(1.0);
    if (any(greaterThanEqual(pixel, imageSize(composed_water)))) return;
    float depth_m = texelFetch(water_depth, pixel, 0).x;
    vec4 normal = texelFetch(water_normal, pixel, 0), own = texelFetch(water_color, pixel, 0);
    vec3 color = texelFetch(composed, pixel, 0).rgb;
    if (tile_works && own.a > 0.0 && reflects(depth_m, normal.xyz)) {
        vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
        Water water;
        water.position = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
        water.towards = normalize(water.position);
        water.normal = normalize(normal.xyz);
        water.own = own.rgb;
        water.thickness_m = normal.w;
        water.opacity = own.a;
        float cosine = fresnel ? clamp(-dot(water.towards, water.normal), 0.0, 1.0) : 1.0;
        float share = clamp(intensity * face_reflectance(cosine, index), 0.0, 1.0);
        probe_pixel(pixel);
        vec3 through = seen_through(water, pixel);
        color = probed_mix(IMAGE_mixture, through, IMAGE_mixture, mirrored(water, pixel), share);
    }
    imageStore(composed_water, pixel, vec4(color, 1.0));
}

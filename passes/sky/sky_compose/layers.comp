#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "layers.pass.h"
#include "shared/push_begin.glsl"
#include "layers.pass.h"
};
#include "shared/cubemap.glsl"
#include "sky/air.glsl"

// Between the four texels around a place, in a rectangle of this size that begins at `first`. Its borders repeat.
vec4 between(texture2D image, vec2 place, ivec2 first, ivec2 size) {
    place = clamp(place - 0.5, vec2(0.0), vec2(size - 1));
    vec2 weight = fract(place);
    ivec2 a = ivec2(place), b = min(a + 1, size - 1);
    return mix(mix(texelFetch(image, first + a, 0), texelFetch(image, first + ivec2(b.x, a.y), 0), weight.x),
               mix(texelFetch(image, first + ivec2(a.x, b.y), 0), texelFetch(image, first + b, 0), weight.x), weight.y);
}
vec4 upsampled(texture2D image, vec2 uv) {
    ivec2 size = textureSize(image, 0);
    return between(image, uv * vec2(size), ivec2(0), size);
}

// A cube map's faces lie one below the other.
vec3 star_light(vec3 direction) {
    int side = textureSize(stars, 0).x;
    if (!starry || textureSize(stars, 0).y != 6 * side) return vec3(0.0);
    vec3 face = face_from_direction(direction);
    return between(stars, face.xy * float(side), ivec2(0, int(face.z) * side), ivec2(side)).rgb;
}

// The sun's light on a cloud. Clouds without an atmosphere have that on surfaces.
vec3 sun_on_cloud(float high, float slope, float far_m, vec3 direction) {
    if (!(frame.atmosphere.x > 0.0)) return frame.sun_irradiance.rgb;
    float upward = dot(frame.sun_direction.xyz, frame.up.xyz), ahead = dot(frame.sun_direction.xyz, direction);
    return frame.sun_above.rgb * sun_through_air(altitude_at(high, slope, far_m), slope_towards(high, slope, far_m, upward, ahead), light_steps);
}

vec3 sky_light(ivec2 pixel, vec3 captured) {
    vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
    vec3 direction = ray_at(uv), molecules = vec3(0.0), particles = vec3(0.0), behind = captured;
    float cosine = dot(direction, frame.sun_direction.xyz);
    bool has_atmosphere = has_sky_rayleigh && frame.atmosphere.x > 0.0; // the passes that make these images may run without
    if (has_atmosphere) {
        vec4 through = upsampled(sky_passed, uv);
        behind = through.w * through.rgb * star_light(direction);
        if (rayleigh) molecules = rayleigh_phase(cosine) * upsampled(sky_rayleigh, uv).rgb;
        if (mie) particles = mie_phase(cosine, frame.mie.w) * upsampled(sky_mie, uv).rgb;
    }
    vec3 air = molecules + particles;
    if (!has_cloud_map || !clouds) return air + behind;
    vec4 cloud = texelFetch(cloud_map, pixel, 0);
    if (!(cloud.x > 0.0)) return air + behind;
    float far_m = 1000.0 * cloud.w, slope = dot(direction, frame.up.xyz), high = max(frame.atmosphere.x > 0.0 ? frame.atmosphere.z : frame.cloud_layer.z, 0.0);
    Scattered before = Scattered(vec3(0.0), vec3(0.0), vec3(1.0));
    if (haze && has_atmosphere) before = scattered(high, slope, vec2(0.0, far_m), direction, steps, light_steps);
    vec3 own = (cloud.y + (multiple ? cloud.z : 0.0)) * sun_on_cloud(high, slope, far_m, direction);
    vec3 front = vec3(0.0);
    if (rayleigh) front += min(rayleigh_phase(cosine) * before.molecules, molecules);
    if (mie) front += min(mie_phase(cosine, frame.mie.w) * before.particles, particles);
    return front + (1.0 - cloud.x) * (air - front + behind) + before.passed * own;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(composed_sky)))) return;
    vec3 color = has_composed_water ? texelFetch(composed_water, pixel, 0).rgb : texelFetch(composed, pixel, 0).rgb;
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    if (has_composed_water && textureSize(water_depth, 0) == ivec2(frame.size.xy)) depth_m = min(depth_m, texelFetch(water_depth, pixel, 0).x);
    if (depth_m > LARGEST) color = storable(sky_light(pixel, color), frame.up.w);
    imageStore(composed_sky, pixel, vec4(color, 1.0));
}

// Writes the light of a pixel. Next include of a variant, after filtering/corners.glsl, that defines
// float weight_of(ivec2 pixel, float depth_m, vec3 normal, ivec2 texel, float texel_m), of a texel for a pixel.
#include "source.glsl"

vec4 upscaled(ivec2 pixel, float depth_m, vec3 normal) {
    Corners corners = corners_of(pixel);
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < 4; ++i) {
        if (!(corners.share[i] > 0.0)) continue;
        ivec2 texel = corner_texel(corners, i);
        float weight = corners.share[i] * weight_of(pixel, depth_m, normal, texel, corners.depth_m[i]);
        sum += weight * (has_indirect_temporal ? texelFetch(indirect_temporal, texel, 0) : half_light(texel));
        total += weight;
    }
    return total > 0.0 ? sum / total : vec4(0.0);
}

// The light that the capture has for the surface, as a white one would send it back. Metals have no diffuse light.
vec3 captured_light(ivec2 pixel) {
    if (least_albedo > 1.0 || textureSize(indirect_lit, 0) != ivec2(frame.size.xy)) return vec3(0.0);
    vec4 base = texelFetch(albedo_full, pixel, 0);
    vec3 diffuse = base.rgb * (1.0 - base.a), light = texelFetch(indirect_lit, pixel, 0).rgb / max(diffuse, least_albedo);
    return base.a < 1.0 && finite(vec4(light, 0.0)) ? max(light, 0.0) : vec3(0.0);
}

vec3 light_at(ivec2 pixel, float depth_m, vec3 normal) {
    vec4 found = upscaled(pixel, depth_m, normal);
    return found.a > 0.0 ? found.rgb + found.a * captured_light(pixel) : found.rgb;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(indirect)))) return;
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    vec3 normal = texelFetch(normal_full, pixel, 0).xyz, light = vec3(0.0);
    if (reflects(depth_m, normal)) light = storable(intensity * light_at(pixel, depth_m, normalize(normal)), frame.up.w);
    imageStore(indirect, pixel, vec4(light, 1.0));
}

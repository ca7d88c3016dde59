// Writes the light of a pixel. Next include of a variant, after occlusion/ao_apply/corners.glsl, that defines
// float weight_of(ivec2 pixel, float depth_m, vec3 normal, ivec2 texel, float texel_m), of a texel for a pixel.
#include "source.glsl"

vec3 upscaled(ivec2 pixel, float depth_m, vec3 normal) {
    Corners corners = corners_of(pixel);
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int i = 0; i < 4; ++i) {
        if (!(corners.share[i] > 0.0)) continue;
        ivec2 texel = corner_texel(corners, i);
        float weight = corners.share[i] * weight_of(pixel, depth_m, normal, texel, corners.depth_m[i]);
        sum += weight * (has_indirect_temporal ? texelFetch(indirect_temporal, texel, 0) : half_light(texel)).rgb;
        total += weight;
    }
    return total > 0.0 ? sum / total : vec3(0.0);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(indirect)))) return;
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    vec3 normal = texelFetch(normal_full, pixel, 0).xyz, light = vec3(0.0);
    if (reflects(depth_m, normal)) light = storable(intensity * upscaled(pixel, depth_m, normalize(normal)), frame.up.w);
    imageStore(indirect, pixel, vec4(light, 1.0));
}

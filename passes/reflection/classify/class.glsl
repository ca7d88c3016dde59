#include "shared/camera.glsl"
#include "shared/compact.glsl"

uint class_of(ivec2 pixel) {
    vec4 normal = texelFetch(normal_jittered, pixel, 0);
    float depth_m = texelFetch(depth_half, pixel, 0).x;
    return !reflects(depth_m, normal.xyz) ? CLASSES : normal.w <= hq_roughness ? 0u : 1u;
}

#include "shared/camera.glsl"
#include "shared/compact.glsl"

uint class_of(ivec2 pixel) {
    vec4 normal = texelFetch(normal_jittered, pixel, 0);
    float depth_m = texelFetch(depth_half, pixel, 0).x;
    bool finished = texelFetch(screen_finished, pixel, 0).x != 0u;
    return finished || !reflects(depth_m, normal.xyz) ? CLASSES : normal.w <= hq_roughness ? 0u : 1u;
}

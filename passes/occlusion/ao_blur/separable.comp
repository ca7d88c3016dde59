#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "separable.pass.h"
#include "shared/push_begin.glsl"
#include "separable.pass.h"
};
#include "shared/camera.glsl"
#include "shared/reuse.glsl"

struct Surface {
    vec3 position, normal; // in view space; the normal in world space
    float depth_m;
};

Surface surface_at(ivec2 texel) {
    Surface s;
    s.depth_m = texelFetch(depth_half, texel, 0).x;
    s.normal = texelFetch(normal_half, texel, 0).xyz;
    vec2 uv = picked_uv(texel, texelFetch(pick, texel, 0).x, frame.size);
    s.position = view_position(uv, s.depth_m, frame.view_from_uv, frame.depth_range.z);
    return s;
}

// Equal normals differ by 0, however they were rounded.
bool is_same(Surface own, Surface other) {
    vec3 apart = own.normal - other.normal;
    if (!reflects(other.depth_m, other.normal) || 0.5 * dot(apart, apart) > normal_part) return false;
    return depth_part >= 10.0 ||
           in_plane(other.position - own.position, mat3(frame.view_from_world) * own.normal, own.depth_m, depth_part);
}

float kernel_weight(int i) {
    if (kernel == kernel_box) return abs(i) == radius ? 0.5 : 1.0;
    float x = 2.0 * float(i) / float(radius);
    return exp(-0.5 * x * x);
}

float visibility_at(ivec2 texel) {
    return dispatch_phase == 0u ? texelFetch(occlusion_half, texel, 0).x : texelFetch(across, texel, 0).x;
}

float blurred(ivec2 texel) {
    float own_visibility = visibility_at(texel);
    Surface own = surface_at(texel);
    if (radius == 0 || !reflects(own.depth_m, own.normal)) return own_visibility;
    int along = dispatch_phase == 0u ? 1 : 0; // not a choice of vectors by a constant, which some drivers get wrong
    ivec2 axis = ivec2(along, 1 - along);
    float occluded = kernel_weight(0) * (1.0 - own_visibility), total = kernel_weight(0);
    for (int i = -radius; i <= radius; ++i) {
        ivec2 at = texel + i * axis;
        if (i == 0 || any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(frame.size.zw)))) continue;
        if (!is_same(own, surface_at(at))) continue;
        occluded += kernel_weight(i) * (1.0 - visibility_at(at));
        total += kernel_weight(i);
    }
    return 1.0 - occluded / total; // exactly 1 if all are
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(frame.size.zw)))) return;
    if (dispatch_phase == 0u) imageStore(occlusion_across, texel, vec4(blurred(texel)));
    else imageStore(occlusion_blurred, texel, vec4(blurred(texel)));
}

#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "alpha.pass.h"
#include "shared/push_begin.glsl"
#include "alpha.pass.h"
};
bool is_picture(ivec2 size) { return size == ivec2(frame.size.xy); }
float factor(float alpha) { return alpha > 0.0 ? strength * min(alpha, 1.0) : 0.0; } // NaN is 0

bool may_change(ivec2 pixel) {
    if (!stencil || frame.overlaid.z == 0u || !is_picture(textureSize(stencil_full, 0))) return true;
    return (texelFetch(stencil_full, pixel, 0).x & frame.overlaid.y) == frame.overlaid.x;
}

// Normals that cancel each other out, or are none, leave the surface's own.
vec3 blended(vec3 own, vec3 decal, float alpha) {
    vec3 mixed = mix(own, decal, alpha);
    float length2 = dot(mixed, mixed);
    return length2 > 1e-6 && length2 < 4.0 ? mixed * inversesqrt(length2) : own;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(albedo_full)))) return;
    vec4 base = texelFetch(albedo_captured, pixel, 0), surface = texelFetch(normal_captured, pixel, 0);
    float specular = texelFetch(specular_captured, pixel, 0).x;
    if (may_change(pixel)) {
        vec4 color = albedo && is_picture(textureSize(decal_albedo, 0)) ? texelFetch(decal_albedo, pixel, 0) : vec4(0.0);
        vec4 normal = normals && is_picture(textureSize(decal_normal, 0)) ? texelFetch(decal_normal, pixel, 0) : vec4(0.0);
        vec4 other = material && is_picture(textureSize(decal_material, 0)) ? texelFetch(decal_material, pixel, 0) : vec4(0.0);
        float alpha = factor(color.a), bend = factor(normal.w), part = factor(other.w);
        if (alpha > 0.0) base.rgb = mix(base.rgb, color.rgb, alpha);
        if (bend > 0.0) surface.xyz = blended(surface.xyz, normal.xyz, bend);
        if (part > 0.0) {
            surface.w = mix(surface.w, other.x, part);
            specular = mix(specular, other.y, part);
        }
    }
    imageStore(albedo_full, pixel, base);
    imageStore(normal_full, pixel, surface);
    imageStore(specular_full, pixel, vec4(specular));
}

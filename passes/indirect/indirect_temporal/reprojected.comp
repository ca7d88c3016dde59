#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "reprojected.pass.h"
#include "shared/push_begin.glsl"
#include "reprojected.pass.h"
};
// Diffuse light is the surface's own, from wherever it is seen.
const int reprojection = 0, reprojection_surface = 0, reprojection_reflection = 1, ndf = 0, ndf_ggx = 0;
const float divergence = 1e6;
#include "shared/surface_at.glsl"
#include "shared/reuse.glsl"
#include "previous_frame/history.glsl"
#include "indirect/indirect_apply/source.glsl"

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(indirect_temporal)))) return;
    vec4 color = half_light(texel);
    Surface center = surface_at(texel);
    float age = finite(color) ? 1.0 : 0.0;
    if (age == 0.0) color = vec4(0.0);
    center.shown = false; // also of surfaces without a reflection
    if (reflects(center.depth_m, center.normal.xyz)) color = joined(past_of(texel, center, 0.0), color, age);
    imageStore(indirect_temporal, texel, halves ? nearest_half(color) : color);
    imageStore(indirect_age, texel, vec4(age));
}

// The weight of a neighbour from the images of its texel. Next include of a pass that reads depth_half, normal_half and pick, with the
// rows of reuse_rows.h and a constant `brdf`.
#include "shared/surface_at.glsl"
#include "shared/reuse.glsl"

float neighbour_weight(Surface center, ivec2 texel) {
    if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(frame.size.zw)))) return 0.0;
    Surface other = surface_at(texel);
    vec3 normal = mat3(frame.view_from_world) * center.normal.xyz;
    if (!other.shown || !reflects(other.depth_m, other.normal.xyz)) return 0.0;
    if (!in_plane(other.position - center.position, normal, center.depth_m, depth_part)) return 0.0;
    float agreement = ndf == ndf_ggx ? ggx_agreement(center.normal, other.normal, roughness_part)
                                     : lobe_agreement(center.normal, other.normal, roughness_part);
    return fade(center.normal.w, fade_from, fade_to) * (brdf ? agreement : float(agreement > 0.0));
}

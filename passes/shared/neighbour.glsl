// The weight of a neighbour from the images of its texel. Next include of a pass that reads depth_half, normal_half and pick, with the
// rows of reuse_rows.h and a constant `brdf`.
#include "shared/camera.glsl"
#include "shared/reuse.glsl"

struct Surface {
    float depth_m;
    vec3 position; // in view space
    vec4 normal;   // world space; w: roughness
    bool shown;    // visible; invisible reflections are not shared
};

Surface surface_at(ivec2 texel) {
    Surface s;
    s.depth_m = texelFetch(depth_half, texel, 0).x;
    s.normal = texelFetch(normal_half, texel, 0);
    uint picked = texelFetch(pick, texel, 0).x;
    s.shown = is_pick_shown(picked);
    vec2 uv = picked_uv(texel, picked, frame.size);
    s.position = view_position(uv, s.depth_m, frame.view_from_uv, frame.depth_range.z);
    return s;
}

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

// Estimates every texel with a surface. Next include of a variant that defines Estimate estimate(ivec2 texel, Receiver receiver),
// and with the rows of points_rows.h NEARBY: whether only surfaces within the radius occlude.
void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
#ifdef TILES
    if (dispatch_phase == 0u) {
        mark_tile(texel, NEARBY);
        return;
    }
    bool works = is_marked(texel);
#else
    const bool works = true;
#endif
    if (any(greaterThanEqual(texel, imageSize(occlusion_half)))) return;
    float depth_m = texelFetch(depth_half, texel, 0).x;
    vec3 normal = texelFetch(normal_half, texel, 0).xyz;
    Estimate result = Estimate(1.0, INFINITE, 0u, 0u);
    if (works && reflects(depth_m, normal)) {
        Receiver receiver = receiver_at(texel, depth_m, normal);
        if (receiver.radius_m > 0.0) result = estimate(texel, receiver);
    }
    imageStore(occlusion_half, texel, vec4(result.visibility));
    if (!diagnostics) return;
    imageStore(occluder_distance, texel, vec4(result.nearest_m));
    imageStore(occlusion_steps, texel, uvec4(result.steps));
    imageStore(occlusion_fetches, texel, uvec4(result.fetches));
}

// Writes the occlusion of a pixel. Next include of a variant that defines float upscaled(ivec2 pixel, float depth_m, vec3 normal).

// The last half-resolution image that the pipeline writes.
float half_visibility(ivec2 texel) {
    return has_occlusion_blurred ? texelFetch(occlusion_blurred, texel, 0).x : texelFetch(occlusion_half, texel, 0).x;
}

float upscaled(ivec2 pixel, float depth_m, vec3 normal);

float applied(float visibility) {
    visibility = clamp(visibility, 0.0, 1.0);
    if (power != 1.0 && visibility > 0.0) visibility = pow(visibility, power);
    return clamp(1.0 - intensity * (1.0 - visibility), 0.0, 1.0);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(occlusion)))) return;
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    vec3 normal = texelFetch(normal_full, pixel, 0).xyz;
    float visibility = 1.0;
    if (reflects(depth_m, normal)) visibility = applied(upscaled(pixel, depth_m, normalize(normal)));
    imageStore(occlusion, pixel, vec4(visibility));
}

// Sums an image over the rays of a frame, in float; after the last ray the image becomes the mean.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
layout(set = 0, binding = 0) uniform texture2D image;
layout(set = 0, binding = 1, rgba32f) uniform image2D sum;
layout(set = 0, binding = 2) uniform writeonly image2D mean;
layout(push_constant, std430) uniform Parameters {
    uint level, phase; // as every pass has them
    uint ray, rays;
};
layout(local_size_x = 8, local_size_y = 8) in;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(sum)))) return;
    vec4 value = texelFetch(image, at, 0);
    if (ray > 0u) value += imageLoad(sum, at);
    if (ray + 1u < rays) imageStore(sum, at, value);
    else imageStore(mean, at, value / float(rays));
}

// The normal by which a surface receives light, in world space: about it the directions of its hemisphere are distributed. Next include of a pass that reads
// vertex_normal_full and has the parameter `normals`. start: the surface's full-resolution pixel.
#include "shared/camera.glsl"

vec3 receiver_normal(vec2 start, vec3 shading) {
    ivec2 size = textureSize(vertex_normal_full, 0);
    if (normals == normals_shading || size != ivec2(frame.size.xy)) return shading;
    vec3 vertex = texelFetch(vertex_normal_full, min(ivec2(start), size - 1), 0).xyz;
    return reflects(1.0, vertex) ? vertex : shading;
}

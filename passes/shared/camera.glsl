// Pixels, depths and positions. "View" is the camera's space in metres; "world" has the axes of the world and its origin at the camera.
// Depth is along the view axis and positive in front; `front` is the sign of view z there (frame.depth_range.z). See frame_fields.h. Results
// are precise, because rays must not depend on the specialization of a shader.
#ifndef GLINT_CAMERA
#define GLINT_CAMERA
#include "shared/constants.glsl"
#include "shared/stable.glsl"

precise vec3 view_position(vec2 uv, float depth_m, vec4 view_from_uv, float front) {
    return depth_m * vec3(uv * view_from_uv.xy + view_from_uv.zw, front);
}

// The uv of a point in front of the camera, or the vanishing point of a direction.
precise vec2 project(vec3 view, vec4 uv_from_view, float front) {
    return view.xy / (view.z * front) * uv_from_view.xy + uv_from_view.zw;
}

// The number of full-resolution pixels along the side of a texel: 2, or 1 if the pipeline's resolution is not reduced. size: frame.size.
float reduction(uvec4 size) { return size.xy == size.zw ? 1.0 : 2.0; }

// The sample position of a texel in full-resolution pixels. `pick` is the value of the image of that name.
const uint NOT_SHOWN = 8u; // added to the pick of a surface whose reflection is not visible
bool is_pick_shown(uint pick) { return (pick & NOT_SHOWN) == 0u; }
precise vec2 picked_position(ivec2 texel, uint pick, uvec4 size) {
    if (size.xy == size.zw) return vec2(texel) + 0.5;
    pick &= 7u;
    return 2.0 * vec2(texel) + (pick < 4u ? vec2(pick & 1u, pick >> 1u) + 0.5 : vec2(1.0));
}
precise vec2 picked_uv(ivec2 texel, uint pick, uvec4 size) { return picked_position(texel, pick, size) / vec2(size.xy); }

// Whether a G-buffer pixel has a ray: it is not sky, and depth and normal are valid. All comparisons are false for NaN.
bool reflects(float depth_m, vec3 normal) {
    float length2 = dot(normal, normal);
    return depth_m > 0.0 && depth_m < LARGEST && length2 > 0.25 && length2 < 4.0;
}

// The mirror direction; the normal need not be exactly of unit length.
precise vec3 mirror_direction(vec3 position, vec3 normal) {
    return normalize(reflect(unit(position), normalize(normal)));
}
#endif

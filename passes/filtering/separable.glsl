// Mixes the visibilities of one surface, along rows in the first dispatch and along columns in the second. Next include of a pass with the
// parameters radius, kernel, depth_part and normal_part that defines BLURRED_SIZE, the size of the image, and the two functions below.
#include "shared/camera.glsl"
#include "shared/reuse.glsl"

struct Surface {
    vec3 position, normal; // in view space; the normal in world space
    float depth_m;
};

Surface surface_at(ivec2 texel);
float visibility_at(ivec2 texel);

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

float blurred(ivec2 texel) {
    float own_visibility = visibility_at(texel);
    Surface own = surface_at(texel);
    if (radius == 0 || !reflects(own.depth_m, own.normal)) return own_visibility;
    int along = dispatch_phase == 0u ? 1 : 0; // not a choice of vectors by a constant, which some drivers get wrong
    ivec2 axis = ivec2(along, 1 - along);
    float occluded = kernel_weight(0) * (1.0 - own_visibility), total = kernel_weight(0);
    for (int i = -radius; i <= radius; ++i) {
        ivec2 at = texel + i * axis;
        if (i == 0 || any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, BLURRED_SIZE))) continue;
        if (!is_same(own, surface_at(at))) continue;
        occluded += kernel_weight(i) * (1.0 - visibility_at(at));
        total += kernel_weight(i);
    }
    return 1.0 - occluded / total; // exactly 1 if all are
}

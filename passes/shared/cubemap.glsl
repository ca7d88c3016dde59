// Cube-map geometry in Vulkan's orientation (specification, Cube Map Face Selection).
#ifndef GLINT_CUBEMAP
#define GLINT_CUBEMAP

// xy: position on the face in [0, 1]² from its top left corner; z: face 0 … 5 for +X -X +Y -Y +Z -Z.
vec3 face_from_direction(vec3 d) {
    vec3 a = abs(d);
    bool z = a.z >= a.x && a.z >= a.y, y = !z && a.y >= a.x;
    float major = z ? d.z : y ? d.y : d.x;
    bool back = major < 0.0;
    vec2 across = z   ? vec2(back ? -d.x : d.x, -d.y)
                  : y ? vec2(d.x, back ? -d.z : d.z)
                      : vec2(back ? d.z : -d.z, -d.y);
    return vec3(0.5 + across * (0.5 / abs(major)), (z ? 4.0 : y ? 2.0 : 0.0) + (back ? 1.0 : 0.0));
}

// The texel in a direction, in cube map `place` of an array of faces.
ivec3 face_texel(vec3 direction, uint place, int size) {
    vec3 face = face_from_direction(direction);
    return ivec3(clamp(ivec2(face.xy * float(size)), ivec2(0), ivec2(size - 1)), 6 * int(place) + int(face.z));
}

// The inverse; the largest component is ±1.
vec3 direction_from_face(vec3 face) {
    vec2 p = 2.0 * face.xy - 1.0;
    int f = int(face.z);
    if (f == 0) return vec3(1.0, -p.y, -p.x);
    if (f == 1) return vec3(-1.0, -p.y, p.x);
    if (f == 2) return vec3(p.x, 1.0, p.y);
    if (f == 3) return vec3(p.x, -1.0, -p.y);
    if (f == 4) return vec3(p.x, -p.y, 1.0);
    return vec3(-p.x, -p.y, -1.0);
}

// The angle in radians of one texel across the direction d: a texel is 2/size wide at distance 1, seen from |d| / largest component.
float texel_angle(vec3 d, float face_size) {
    vec3 a = abs(d), v = d / max(a.x, max(a.y, a.z)); // the sum of squares of d may overflow
    return 2.0 / face_size * inversesqrt(dot(v, v));
}
#endif

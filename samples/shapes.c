/* The shapes of scenes. Flat faces are subdivided, because baked light is stored at vertices. */
#include "scene.h"

static uint32_t divisions(float edge_length, float cell) {
    float n = ceilf(edge_length / cell);
    return n < 1 ? 1 : n > 400 ? 400 : (uint32_t)n;
}

void scene_quad(struct scene *scene, vec3 corner, vec3 u, vec3 v) {
    uint32_t nu = divisions(length(u), scene->cell), nv = divisions(length(v), scene->cell);
    vec3 normal = unit(cross(u, v));
    uint32_t first = 0;
    for (uint32_t j = 0; j <= nv; j++)
        for (uint32_t i = 0; i <= nu; i++) {
            vec3 p = along(along(corner, u, (float)i / (float)nu), v, (float)j / (float)nv);
            uint32_t index = scene_vertex(scene, p, normal);
            if (i == 0 && j == 0) first = index;
        }
    for (uint32_t j = 0; j < nv; j++)
        for (uint32_t i = 0; i < nu; i++) {
            uint32_t a = first + j * (nu + 1) + i, c = a + nu + 2;
            scene_triangle(scene, a, a + 1, c);
            scene_triangle(scene, a, c, c - 1);
        }
}

void scene_box_faces(struct scene *scene, vec3 low, vec3 high, uint32_t faces) {
    vec3 x = v3(high.x - low.x, 0, 0), y = v3(0, high.y - low.y, 0), z = v3(0, 0, high.z - low.z);
    vec3 nx = scale(x, -1), ny = scale(y, -1), nz = scale(z, -1);
    if (faces & FACE_PX) scene_quad(scene, v3(high.x, low.y, low.z), y, z);
    if (faces & FACE_NX) scene_quad(scene, v3(low.x, low.y, high.z), y, nz);
    if (faces & FACE_PY) scene_quad(scene, v3(low.x, high.y, low.z), z, x);
    if (faces & FACE_NY) scene_quad(scene, v3(high.x, low.y, low.z), z, nx);
    if (faces & FACE_PZ) scene_quad(scene, v3(low.x, low.y, high.z), x, y);
    if (faces & FACE_NZ) scene_quad(scene, v3(low.x, high.y, low.z), x, ny);
}

void scene_box(struct scene *scene, vec3 low, vec3 high) {
    scene_box_faces(scene, low, high, FACE_ALL);
}

void scene_room(struct scene *scene, vec3 low, vec3 high, uint32_t faces) {
    vec3 x = v3(high.x - low.x, 0, 0), y = v3(0, high.y - low.y, 0), z = v3(0, 0, high.z - low.z);
    vec3 ny = scale(y, -1), nz = scale(z, -1);
    if (faces & FACE_PX) scene_quad(scene, v3(high.x, low.y, high.z), y, nz);
    if (faces & FACE_NX) scene_quad(scene, v3(low.x, low.y, low.z), y, z);
    if (faces & FACE_PY) scene_quad(scene, v3(low.x, high.y, low.z), x, z);
    if (faces & FACE_NY) scene_quad(scene, v3(low.x, low.y, low.z), z, x);
    if (faces & FACE_PZ) scene_quad(scene, v3(low.x, high.y, high.z), x, ny);
    if (faces & FACE_NZ) scene_quad(scene, v3(low.x, low.y, low.z), x, y);
}

void scene_tube(struct scene *scene, vec3 from, vec3 to, float radius, uint32_t segments) {
    vec3 axis = sub(to, from), t, b;
    frame_of(unit(axis), &t, &b);
    uint32_t rows = divisions(length(axis), 2 * scene->cell), first = 0;
    for (uint32_t j = 0; j <= rows; j++)
        for (uint32_t i = 0; i <= segments; i++) {
            float angle = 2 * PI_F * (float)i / (float)segments;
            vec3 out = add(scale(t, cosf(angle)), scale(b, sinf(angle)));
            vec3 p = along(along(from, axis, (float)j / (float)rows), out, radius);
            uint32_t index = scene_vertex(scene, p, out);
            if (i == 0 && j == 0) first = index;
        }
    for (uint32_t j = 0; j < rows; j++)
        for (uint32_t i = 0; i < segments; i++) {
            uint32_t a = first + j * (segments + 1) + i, c = a + segments + 2;
            scene_triangle(scene, a, a + 1, c);
            scene_triangle(scene, a, c, c - 1);
        }
    for (int end = 0; end < 2; end++) {
        vec3 normal = unit(end ? axis : scale(axis, -1)), at = end ? to : from;
        uint32_t middle = scene_vertex(scene, at, normal);
        for (uint32_t i = 0; i <= segments; i++) {
            float angle = 2 * PI_F * (float)i / (float)segments * (end ? 1 : -1);
            scene_vertex(scene, along(along(at, t, radius * cosf(angle)), b, radius * sinf(angle)), normal);
            if (i) scene_triangle(scene, middle, middle + i, middle + i + 1);
        }
    }
}

void scene_lathe(struct scene *scene, vec3 center, const float (*profile)[2], uint32_t count, uint32_t segments) {
    for (uint32_t k = 0; k + 1 < count; k++) {
        float dr = profile[k + 1][0] - profile[k][0], dy = profile[k + 1][1] - profile[k][1];
        for (uint32_t i = 0; i <= segments; i++) {
            float angle = 2 * PI_F * (float)i / (float)segments, c = cosf(angle), s = sinf(angle);
            vec3 normal = unit(v3(dy * c, -dr, dy * s));
            uint32_t index = 0;
            for (uint32_t e = 0; e < 2; e++) {
                const float *point = profile[k + e];
                index = scene_vertex(scene, add(center, v3(point[0] * c, point[1], point[0] * s)), normal);
            }
            if (!i) continue;
            scene_triangle(scene, index - 3, index - 2, index - 1);
            scene_triangle(scene, index - 1, index - 2, index);
        }
    }
}

void scene_sphere(struct scene *scene, vec3 center, float radius, uint32_t segments) {
    uint32_t rows = segments / 2, first = 0;
    for (uint32_t j = 0; j <= rows; j++)
        for (uint32_t i = 0; i <= segments; i++) {
            float theta = PI_F * (float)j / (float)rows, angle = 2 * PI_F * (float)i / (float)segments;
            vec3 out = v3(sinf(theta) * cosf(angle), cosf(theta), sinf(theta) * sinf(angle));
            uint32_t index = scene_vertex(scene, along(center, out, radius), out);
            if (i == 0 && j == 0) first = index;
        }
    for (uint32_t j = 0; j < rows; j++)
        for (uint32_t i = 0; i < segments; i++) {
            uint32_t a = first + j * (segments + 1) + i, c = a + segments + 2;
            if (j) scene_triangle(scene, a, a + 1, c);
            if (j + 1 < rows) scene_triangle(scene, a, c, c - 1);
        }
}

void scene_ground(struct scene *scene, float (*height)(float x, float z), float e, vec3 low, float cell,
                  uint32_t across, uint32_t deep) {
    uint32_t first = 0;
    for (uint32_t j = 0; j <= deep; j++)
        for (uint32_t i = 0; i <= across; i++) {
            float x = low.x + cell * (float)i, z = low.z + cell * (float)j;
            vec3 normal = unit(v3(height(x - e, z) - height(x + e, z), 2 * e, height(x, z - e) - height(x, z + e)));
            uint32_t index = scene_vertex(scene, v3(x, height(x, z), z), normal);
            if (i == 0 && j == 0) first = index;
        }
    for (uint32_t j = 0; j < deep; j++)
        for (uint32_t i = 0; i < across; i++) {
            uint32_t a = first + j * (across + 1) + i, c = a + across + 2;
            scene_triangle(scene, a, c, a + 1);
            scene_triangle(scene, a, c - 1, c);
        }
}

void scene_extrude(struct scene *scene, const float (*polygon)[2], uint32_t count, float z0, float z1) {
    for (uint32_t i = 0; i < count; i++) {
        const float *a = polygon[i], *b = polygon[(i + 1) % count];
        scene_quad(scene, v3(a[0], a[1], z0), v3(b[0] - a[0], b[1] - a[1], 0), v3(0, 0, z1 - z0));
    }
    for (int end = 0; end < 2; end++) {
        vec3 normal = v3(0, 0, end ? 1.0f : -1.0f);
        uint32_t first = 0;
        for (uint32_t i = 0; i < count; i++) {
            uint32_t index = scene_vertex(scene, v3(polygon[i][0], polygon[i][1], end ? z1 : z0), normal);
            if (!i) first = index;
        }
        for (uint32_t i = 2; i < count; i++)
            scene_triangle(scene, first, first + (end ? i - 1 : i), first + (end ? i : i - 1));
    }
}

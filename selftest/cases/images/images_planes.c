/* Cases of reflection/cubemap_trace/texels.glsl: the interpolation between texels of a cube map. */
#include <math.h>
#include <stdlib.h>

#include "cases/images/cube_frame.h"
#include "cases/images/image_case_lists.h"
#include "oracles/cube_march.h"
#include "oracles/noise.h"

enum { SIZE = 4, CUBES = CUBE_FRAME_MOST };

/* A plane on each face, from nearly frontal to so steep that neighbours differ by more than a factor of two; arbitrary texels on a
   quarter of the faces. */
static void steep_planes(uint32_t cube, size_t texel, const double d[3], float out[5]) {
    const uint32_t face = (uint32_t)(texel / SIZE / SIZE) + 6 * cube;
    const double x = (double)(texel % SIZE) - 1.5, y = (double)(texel / SIZE % SIZE) - 1.5;
    const double lean[2] = {0.6 * noise(31, face) - 0.3, 0.6 * noise(32, face) - 0.3};
    const double plane = face % 4 == 3 ? noise(33 + cube, (uint32_t)texel) + 0.1 : 1 + lean[0] * x + lean[1] * y;
    for (int k = 0; k < 4; k++) out[k] = 1;
    out[4] = (float)(3 / plane / fmax(fabs(d[0]), fmax(fabs(d[1]), fabs(d[2]))));
}

static bool check_planes(struct frames *frames, const struct image_case *which, struct glint_selftest_finding *finding,
                         struct glint_error *err) {
    static const char *const passes[] = {"cubemap_active", "downsample", "cubemap_trace", NULL};
    static const char *const settings[] = {"cubemap_trace=exact", NULL};
    static const float zero[FRAME_PIXELS] = {0};
    static const uint32_t best[FRAME_PIXELS] = {0};
    struct cube_frame *c = calloc(1, sizeof *c);
    float *found = NULL;
    char *shader = image_shader("exact",
                                "#include \"reflection/cubemap_trace/texels.glsl\"\n#include \"shared/random.glsl\"\n"
                                "void main() {\n"
                                "    ivec2 at = ivec2(gl_GlobalInvocationID.xy);\n"
                                "    if (any(greaterThanEqual(at, imageSize(travelled)))) return;\n"
                                "    vec4 u = random4(uvec2(at), 5u, 4u);\n"
                                "    vec3 v = 2.0 * u.xyz - 1.0;\n"
                                "    uint place = min(uint(4.0 * u.w), 3u);\n"
                                "    imageStore(travelled, at, vec4(%s));\n"
                                "    imageStore(cubemap_index, at, uvec4(0u));\n"
                                "}\n",
                                which->glsl);
    bool ok = (c && shader) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (ok) {
        cube_frame_fill(c, SIZE, CUBES, steep_planes);
        for (int k = 0; k < CUBES; k++) /* in this order from the camera */
            for (int i = 0; i < 3; i++) c->cube[k].center[i] = cube_frame_eye[i] + (i ? 0 : k);
        c->parts[CUBES] = (struct planes){
            "engine.screen_trace.screen_travelled", FRAME_WIDTH, FRAME_HEIGHT, {"Z"}, {zero}, GLINT_F32, NULL};
        c->frame.more_count++;
    }
    struct planes parts[CUBES + 2];
    for (int k = 0; ok && k <= CUBES; k++) parts[k] = c->parts[k];
    parts[CUBES + 1] = (struct planes){
        "engine.cubemap_select.cubemap_best", FRAME_WIDTH, FRAME_HEIGHT, {"index"}, {best}, GLINT_U32, NULL};
    if (ok) c->frame.more = parts, c->frame.more_count = CUBES + 2;
    ok = ok && frames_pipeline(frames, passes, settings, err) && frames_shader(frames, "cubemap_trace", shader, err) &&
         frames_run(frames, &c->frame, err) && (found = image_read(frames, "travelled", GLINT_F32, FRAME_PIXELS, err));
    struct cubes cubes = {.size = SIZE, .count = CUBES};
    for (int k = 0; ok && k < CUBES; k++) cubes.distance_m[k] = c->values[k][4];
    for (uint32_t i = 0; ok && i < FRAME_PIXELS; i++) {
        double u[4], v[3];
        random4_expected(i % FRAME_WIDTH, i / FRAME_WIDTH, 4, u);
        for (int k = 0; k < 3; k++) v[k] = 2 * u[k] - 1;
        const double seen = cube_seen(&cubes, (uint32_t)(4 * u[3]), v);
        image_compare(finding, (double)found[i] / seen, 1, 1, "direction %.9g %.9g %.9g, place %u, %.9g m", v[0], v[1],
                      v[2], (unsigned)(4 * u[3]), seen);
    }
    free(found), free(shader), free(c);
    return ok;
}

#define ON_PLANES "on_planes(cubemap_distance, v, place)"

/* clang-format off */
static const struct image_case list[] = {
    {{"planes between texels", "cube maps of 4: exact on planes of all slopes up to a factor of two between texels; otherwise the nearest texel", ON_PLANES, "of the distance", 4e-6, "a straight line between four quotients, 2.5 ULP each (Vulkan), continued by half a texel, where half of the least is left of it: 16 ULP"}, check_planes, ON_PLANES, NULL},
};
/* clang-format on */

const struct image_list images_planes = {list, sizeof list / sizeof *list};

/* Mistakes in a capture with the previous frame but without motion vectors and cube maps, so that nothing else shows them. */
#include "damage_internal.h"

#include <string.h>

#include "unit.h"

static void leave_the_frame_before(struct rewrite *r) {
    static const char *const motion[] = {"motion.X", "motion.Y", "motion.Z"};
    bool before = false;
    for (size_t i = 0; i < r->count; i++) before = before || !strcmp(r->parts[i].name, "previous.gbuffer");
    remove_cubes(r);
    for (int k = 0; k < 3; k++) {
        rewrite_remove_channel(r, "gbuffer", motion[k]);
        if (before) rewrite_remove_channel(r, "previous.gbuffer", motion[k]);
    }
}

/* Changes the depth of both frames. */
static void each_depth(struct rewrite *r, double (*change)(double v)) {
    static const char *const parts[] = {"gbuffer", "previous.gbuffer"};
    for (int k = 0; k < 2; k++) {
        float *v = damage_floats(r, parts[k], "depth.Z");
        for (size_t i = 0; i < damage_texels_of(r, parts[k]); i++) v[i] = (float)change((double)v[i]);
    }
}

static bool exchanged(struct rewrite *r) {
    static const char *const names[2][2] = {{"glint.worldToView", "glint.previousWorldToView"},
                                            {"glint.viewToClip", "glint.previousViewToClip"}};
    for (int k = 0; k < 2; k++) {
        double now[16], before[16];
        memcpy(now, damage_matrix(r, names[k][0]), sizeof now);
        memcpy(before, damage_matrix(r, names[k][1]), sizeof before);
        damage_set_matrix(r, names[k][0], before);
        damage_set_matrix(r, names[k][1], now);
    }
    return true;
}

bool before_same(struct rewrite *r, UNUSED double strength) {
    leave_the_frame_before(r);
    damage_set_matrix(r, "glint.previousWorldToView", damage_matrix(r, "glint.worldToView"));
    damage_set_matrix(r, "glint.previousViewToClip", damage_matrix(r, "glint.viewToClip"));
    return true;
}

bool before_exchanged(struct rewrite *r, UNUSED double strength) {
    leave_the_frame_before(r);
    return exchanged(r);
}

/* With the colours of the previous frame, but without its depth. */
bool before_exchanged_lit(struct rewrite *r, UNUSED double strength) {
    leave_the_frame_before(r);
    rewrite_remove_part(r, "previous.gbuffer");
    return exchanged(r);
}

/* Not a mistake. */
bool before_right(struct rewrite *r, UNUSED double strength) {
    leave_the_frame_before(r);
    return true;
}
bool before_right_lit(struct rewrite *r, double strength) {
    rewrite_remove_part(r, "previous.gbuffer");
    return before_right(r, strength);
}

/* The camera of another frame. */
bool before_elsewhere(struct rewrite *r, double strength) {
    double m[16];
    leave_the_frame_before(r);
    memcpy(m, damage_matrix(r, "glint.previousWorldToView"), sizeof m);
    m[3] += 0.3 + strength;
    m[11] -= 0.7 + strength;
    damage_set_matrix(r, "glint.previousWorldToView", m);
    return true;
}

/* A projection in Direct3D's form with OpenGL's depth (z + 1) / 2: twice as far in every direction. */
static double as_opengl(double v) {
    return (v + 1) / 2;
}
bool before_clip_z(struct rewrite *r, UNUSED double strength) {
    leave_the_frame_before(r);
    each_depth(r, as_opengl);
    return true;
}

static double as_hundreds(double v) {
    return 100 * v;
}
bool before_hundreds(struct rewrite *r, UNUSED double strength) {
    leave_the_frame_before(r);
    each_depth(r, as_hundreds);
    return true;
}

/* The position of the eye in the engine's left-handed world, everything else in the right-handed one. */
bool before_mirrored(struct rewrite *r, UNUSED double strength) {
    static const char *const names[] = {"glint.worldToView", "glint.previousWorldToView"};
    leave_the_frame_before(r);
    for (int k = 0; k < 2; k++) {
        double m[16];
        memcpy(m, damage_matrix(r, names[k]), sizeof m);
        for (int i = 0; i < 4; i++) m[i] = -m[i];
        damage_set_matrix(r, names[k], m);
    }
    return true;
}

bool before_depth(struct rewrite *r, UNUSED double strength) {
    damage_swap(r, "gbuffer", "previous.gbuffer", "depth.Z");
    leave_the_frame_before(r);
    return true;
}

/* Common to the mistakes: access to a capture's pixels and attributes, and the functions of each file. */
#ifndef DAMAGE_INTERNAL_H
#define DAMAGE_INTERNAL_H

#include "damage.h"

size_t damage_texels_of(struct rewrite *r, const char *part);
/* Converts a channel to floats in storage; NULL if there is none. */
float *damage_floats(struct rewrite *r, const char *part, const char *channel);
/* Exchanges a channel of two parts. */
bool damage_swap(struct rewrite *r, const char *a, const char *b, const char *channel);
bool damage_is_cube(const struct rewrite_part *p);
const double *damage_matrix(struct rewrite *r, const char *name);
void damage_set_matrix(struct rewrite *r, const char *name, const double m[16]);
/* Sets a string attribute of the G-buffer, or of a part. */
void damage_set_text(struct rewrite *r, const char *name, const char *value);
void damage_set_text_of(struct rewrite *r, const char *part, const char *name, const char *value);
/* Face f, texel x y, is taken from face from[f], turned. */
void damage_turn_faces(struct rewrite *r, const char *part, const char *channel, const int from[6], int turn);
void remove_cubes(struct rewrite *r);

#define DAMAGE(name, done)                                                                                             \
    bool name(struct rewrite *r, double strength) {                                                                    \
        (void)strength;                                                                                                \
        return done;                                                                                                   \
    }

#define MISTAKE(name) bool name(struct rewrite *r, double strength);
/* damage_cubes.c */
MISTAKE(faces_exchanged)
MISTAKE(faces_rotated)
MISTAKE(faces_mirrored)
MISTAKE(faces_upside_down)
MISTAKE(distance_planar)
MISTAKE(distance_hundreds)
MISTAKE(distance_hundredths)
MISTAKE(center_negated)
MISTAKE(center_hundreds)
MISTAKE(center_off)
MISTAKE(inner_full)
MISTAKE(sky_inverted)
MISTAKE(sky_colored)
MISTAKE(sky_solid)
MISTAKE(sky_at_0)
MISTAKE(cubes_tiny)
/* damage_before.c: mistakes that the previous frame shows, and those that only it shows */
MISTAKE(before_same)
MISTAKE(before_exchanged)
MISTAKE(before_exchanged_lit)
MISTAKE(before_right)
MISTAKE(before_right_lit)
MISTAKE(before_elsewhere)
MISTAKE(before_clip_z)
MISTAKE(before_hundreds)
MISTAKE(before_mirrored)
MISTAKE(before_depth)
/* damage_light.c: mistakes in lit, scene and the sky, most of them in captures where nothing else shows them */
MISTAKE(light_swapped)
MISTAKE(light_late)
MISTAKE(light_finished)
MISTAKE(light_without_sky)
MISTAKE(light_srgb)
MISTAKE(light_linear)
MISTAKE(sky_srgb)
MISTAKE(sky_linear)
MISTAKE(sky_pre_exposed)
MISTAKE(sky_mirrored)
MISTAKE(sky_upside_down)
MISTAKE(normals_upside_down)
MISTAKE(metals_that_emit)
MISTAKE(sky_exchanged)
MISTAKE(sky_clouds)
MISTAKE(sky_bright)
MISTAKE(sky_cloudy)
MISTAKE(sky_plain_and_bright)
#undef MISTAKE

#endif

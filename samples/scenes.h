/* The built-in scenes: one file in scenes/ and one row here each. */
#ifndef SAMPLES_SCENES_H
#define SAMPLES_SCENES_H

#include "scene.h"

/* SCENE(name, summary) */
#define SCENES(SCENE)                                                                                                  \
    SCENE(mirror_box,                                                                                                  \
          "closed box 0..8 x 0..4 x 0..6 m with a mirror floor: every reflected distance has a closed form")           \
    SCENE(matte, "sunlit blocks of specular 0: nothing reflects")                                                      \
    SCENE(street, "wet road at dusk with puddles, lit windows, thin rails and poles, a car that no cube map holds")

#define DECLARE(name, summary) void scene_##name(struct scene *scene);
SCENES(DECLARE)
#undef DECLARE

#endif

/* The list of built-in scenes: each has a file in scenes/ and a row here. */
#ifndef SAMPLES_SCENES_H
#define SAMPLES_SCENES_H

#include "scene.h"

/* SCENE(name, summary) */
#define SCENES(SCENE)                                                                                                  \
    SCENE(mirror_box,                                                                                                  \
          "closed box 0..8 x 0..4 x 0..6 m with a mirror floor: every reflected distance has a closed form")           \
    SCENE(matte, "sunlit blocks of specular 0: nothing reflects")                                                      \
    SCENE(street,                                                                                                      \
          "wet road at dusk with puddles, lit windows, stippled shrubs, thin rails, a car that no cube map holds")     \
    SCENE(glasshouse, "hall of glass on a terrace by day: panes before and behind what they reflect")                  \
    SCENE(room, "corridor and room with windows, polished tiles, a metal column, stairs, flower pots")                 \
    SCENE(desert_night, "dunes by moonlight under a painted dome: one mirror, and no sky")                             \
    SCENE(rain_street, "cobbled lane in the rain: all of it wet and rough, no mirror")                                 \
    SCENE(still_life, "table by a window: neither things nor camera move")                                             \
    SCENE(lake, "rippling water between hills, with a jetty and a boathouse; a planar reflection map of it")           \
    SCENE(hotel, "lobby with a gallery and the street before it at night; 22 cube maps on three floors and outdoors")  \
    SCENE(plaza, "wet paving of every roughness after sunset: dark silhouettes before an HDR glow")                    \
    SCENE(alley, "foggy alley at night between brick walls: point and spot lights, puddles, a van")                    \
    SCENE(courtyard, "sunlit yard with an arcade, trees with leaves, a parked car and a person")                       \
    SCENE(portrait, "head and shoulders in hard light from the side, its skin in a stencil class of its own")          \
    SCENE(meadow, "grass with a tree and a hut under a wide sky, before a low sun")                                    \
    SCENE(kitchen, "two dim rooms by day: window, door and second window in a mirror, glossy worktops, HDR sky")

#define DECLARE(name, summary) void build_##name(struct scene *scene);
SCENES(DECLARE)
#undef DECLARE

#endif

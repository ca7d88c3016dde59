/* How the six faces of a cube map lie in a texture. */
#ifndef GLINT_PACK_CUBE_H
#define GLINT_PACK_CUBE_H

#include "node.h"

enum cube_layout {
    CUBE_STRIP_VERTICAL,
    CUBE_STRIP_HORIZONTAL,
    CUBE_CROSS_VERTICAL,
    CUBE_CROSS_HORIZONTAL,
    CUBE_LAYERS,
    CUBE_FILES
};

struct cube {
    enum cube_layout layout;
    uint32_t size;   /* texels a side */
    int position[6]; /* where +X −X +Y −Y +Z −Z come in strips, layers and files */
    int axis[3];     /* x y z of the vector that is looked up: an axis of the world, */
    int sign[3];     /* and its sign */
    int turn[6];     /* quarter turns clockwise that set a stored face upright */
    bool mirror, bottom_first;
};

/* Where a texel of the texture lies. */
struct place {
    uint32_t image, layer, x, y; /* image: of six files, layer: of six */
};

/* Reads the texture's `cube`, or derives it from the shape of its image. `said`: receives "by the shape" or NULL. */
bool cube_read(struct cube *cube, const struct node *texture, uint32_t width, uint32_t height, bool files, bool layers,
               struct glint_error *err);
const char *cube_layout_name(enum cube_layout layout);
/* The place of the texel (x, y) of the capture's face 0 … 5. */
struct place cube_place(const struct cube *cube, int face, uint32_t x, uint32_t y);

#endif

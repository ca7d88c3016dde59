/* Finds texels of cube maps. Every arrangement permutes texels and mixes none, so that all arithmetic is of integers: directions are
   multiplied by the number of texels a side, which puts texel centres on odd or even numbers. */
#include "cube.h"

#include <stdlib.h>
#include <string.h>

static const char *const AXES[] = {"+x", "-x", "+y", "-y", "+z", "-z"};
static const char *const LAYOUTS[] = {"strip_vertical",   "strip_horizontal", "cross_vertical",
                                      "cross_horizontal", "layers",           "files"};

const char *cube_layout_name(enum cube_layout layout) {
    return LAYOUTS[layout];
}

static int axis_of(const json_t *name) {
    int axis = 0;
    while (axis < 5 && strcmp(AXES[axis], json_string_value(name))) axis++;
    return axis;
}

static bool read_order(struct cube *cube, const struct node *node, struct glint_error *err) {
    const json_t *list = json_object_get(node->value, "order");
    bool seen[6] = {false};
    for (int i = 0; i < 6; i++) cube->position[i] = i;
    for (int i = 0; list && i < 6; i++) {
        const int face = axis_of(json_array_get(list, (size_t)i));
        const struct node order = node_child(node, "order");
        if (seen[face])
            return node_fail(&order, err, GLINT_ERROR_FORMAT, "expected each face once, found %s twice", AXES[face]);
        seen[face] = true;
        cube->position[face] = i;
    }
    return true;
}

static bool read_axes(struct cube *cube, const struct node *node, struct glint_error *err) {
    const json_t *list = json_object_get(node->value, "axes");
    bool seen[3] = {false};
    for (int i = 0; i < 3; i++) {
        const int axis = list ? axis_of(json_array_get(list, (size_t)i)) : 2 * i;
        const struct node axes = node_child(node, "axes");
        if (seen[axis / 2])
            return node_fail(&axes, err, GLINT_ERROR_FORMAT, "expected each axis of the world once, found %c twice",
                             "xyz"[axis / 2]);
        seen[axis / 2] = true;
        cube->axis[i] = axis / 2;
        cube->sign[i] = axis % 2 ? -1 : 1;
    }
    return true;
}

static bool read_turns(struct cube *cube, const struct node *node, struct glint_error *err) {
    double turns[6] = {0};
    node_numbers(node, "turn", turns);
    for (int i = 0; i < 6; i++) {
        const struct node turn = node_child(node, "turn");
        if (turns[i] != 0 && turns[i] != 1 && turns[i] != 2 && turns[i] != 3)
            return node_fail(&turn, err, GLINT_ERROR_FORMAT, "expected 0, 1, 2 or 3 quarter turns, found %g", turns[i]);
        cube->turn[i] = (int)turns[i];
    }
    return true;
}

/* The size of a face when the texture has this shape; 0 if the shape is another. */
static uint32_t size_of(enum cube_layout layout, uint32_t width, uint32_t height) {
    static const uint32_t across[] = {1, 6, 3, 4, 1, 1}, down[] = {6, 1, 4, 3, 1, 1};
    const uint32_t size = width / across[layout];
    return size && width % across[layout] == 0 && height % down[layout] == 0 && size == height / down[layout] ? size
                                                                                                              : 0;
}

bool cube_read(struct cube *cube, const struct node *texture, uint32_t width, uint32_t height, bool files, bool layers,
               struct glint_error *err) {
    const struct node node = node_child(texture, "cube");
    const char *said = node.value ? node_text(&node, "layout") : NULL, *rows = node_text(texture, "rows");
    *cube = (struct cube){.mirror = node_bool(&node, "mirror", false),
                          .bottom_first = rows && !strcmp(rows, "bottom_first")};
    if (!read_order(cube, &node, err) || !read_axes(cube, &node, err) || !read_turns(cube, &node, err)) return false;
    if (files || (layers && !said)) cube->layout = files ? CUBE_FILES : CUBE_LAYERS;
    else
        while (cube->layout < CUBE_LAYERS &&
               (said ? strcmp(LAYOUTS[cube->layout], said) != 0 : !size_of(cube->layout, width, height)))
            cube->layout++;
    cube->size = size_of(cube->layout, width, height);
    if (cube->size && (cube->layout != CUBE_LAYERS || layers)) return true;
    if (said || files)
        return node_fail(texture, err, GLINT_ERROR_FORMAT, "%s: expected square faces%s, found %u x %u texels",
                         LAYOUTS[cube->layout], cube->layout == CUBE_LAYERS ? " in six layers" : "", width, height);
    return node_fail(texture, err, GLINT_ERROR_FORMAT,
                     "expected a cube map: six faces in a strip (1 : 6), a cross (3 : 4), layers or files, found %u x "
                     "%u texels",
                     width, height);
}

/* ---- Directions, as FORMAT.md orients the faces ---- */

static void direction_of(int face, int s, int t, int n, int out[3]) {
    const int table[6][3] = {{n, -t, -s}, {-n, -t, s}, {s, n, t}, {s, -n, -t}, {s, -t, n}, {-s, -t, -n}};
    memcpy(out, table[face], sizeof table[face]);
}

/* The face that the direction hits, with its s and t. Exactly one component has the size n. */
static int face_of(const int d[3], int n, int *s, int *t) {
    const int axis = abs(d[0]) == n ? 0 : abs(d[1]) == n ? 1 : 2, face = 2 * axis + (d[axis] < 0);
    const int table[6][2] = {{-d[2], -d[1]}, {d[2], -d[1]}, {d[0], d[2]}, {d[0], -d[2]}, {d[0], -d[1]}, {-d[0], -d[1]}};
    *s = table[face][0];
    *t = table[face][1];
    return face;
}

/* ---- Places ---- */

static struct place in_cross(const struct cube *cube, int face, uint32_t x, uint32_t y) {
    static const uint32_t columns[6] = {2, 0, 1, 1, 1, 3}, rows[6] = {1, 1, 0, 2, 1, 1};
    const uint32_t n = cube->size;
    const bool vertical = cube->layout == CUBE_CROSS_VERTICAL, hangs = vertical && face == 5;
    struct place place = {.x = columns[face] * n + x, .y = rows[face] * n + y};
    if (hangs) place = (struct place){.x = n + n - 1 - x, .y = 3 * n + n - 1 - y};
    if (cube->bottom_first) place.y = (vertical ? 4 : 3) * n - 1 - place.y;
    return place;
}

struct place cube_place(const struct cube *cube, int face, uint32_t x, uint32_t y) {
    const int n = (int)cube->size;
    int world[3], looked_up[3], s, t;
    direction_of(face, 2 * (int)x + 1 - n, 2 * (int)y + 1 - n, n, world);
    for (int i = 0; i < 3; i++) looked_up[i] = cube->sign[i] * world[cube->axis[i]];
    const int stored = face_of(looked_up, n, &s, &t);
    uint32_t i = (uint32_t)(s + n - 1) / 2, j = (uint32_t)(t + n - 1) / 2;
    for (int k = 0; k < cube->turn[stored]; k++) {
        const uint32_t before = i;
        i = j;
        j = cube->size - 1 - before;
    }
    if (cube->mirror) i = cube->size - 1 - i;
    if (cube->layout == CUBE_CROSS_VERTICAL || cube->layout == CUBE_CROSS_HORIZONTAL)
        return in_cross(cube, stored, i, j);
    if (cube->bottom_first) j = cube->size - 1 - j;
    const uint32_t at = (uint32_t)cube->position[stored];
    switch (cube->layout) {
    case CUBE_STRIP_VERTICAL:
        return (struct place){.x = i, .y = at * cube->size + j};
    case CUBE_STRIP_HORIZONTAL:
        return (struct place){.x = at * cube->size + i, .y = j};
    case CUBE_FILES:
        return (struct place){.image = at, .x = i, .y = j};
    default:
        return (struct place){.layer = at, .x = i, .y = j};
    }
}

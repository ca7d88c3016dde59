/* What to show: a layer of an EXR file, a capture's part, or an image of a run, as float texels. */
#ifndef GLINT_VIEWER_SOURCE_H
#define GLINT_VIEWER_SOURCE_H

#include <stdint.h>

#include "glint/common.h"

struct source_choice {
    const char *path;  /* "F", "F:PART", "F:PART:LAYER", "RUN", "RUN:IMAGE" */
    const char *part;  /* NULL: what the path says, else a part that shows most */
    const char *layer; /* "depth", "material.roughness"; NULL: the part's colour, else its first layer */
    const char *image; /* of a run; NULL: the last colour image */
};

/* Channels in the order R G B A or X Y Z, else the file's; at most 4. */
struct source {
    char title[300];       /* "screen_travelled", "gbuffer:depth" */
    char unit[64];         /* "" when not known */
    char channels[4][256]; /* without the layer's name */
    uint32_t width, height, components;
    bool integer; /* the texels are whole numbers */
    bool cube;    /* faces of a cube map below each other */
    float *texels;
};

/* The path of "PATH[:PART[:LAYER]]", malloc'd, and what follows it, inside it; NULL for what is not there. */
char *source_split(const char *text, char **part, char **layer);
bool source_open(struct source *source, const struct source_choice *choice, struct glint_error *err);
void source_finish(struct source *source);
/* The place of a channel, -1 when there is none. */
int source_channel(const struct source *source, const char *name);

#endif

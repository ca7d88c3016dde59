/* What to draw: a layer of an EXR file, a part of a capture, or an image of a run, as float texels. */
#ifndef GLINT_VIEWER_SOURCE_H
#define GLINT_VIEWER_SOURCE_H

#include <stdint.h>

#include "glint/common.h"

struct source_choice {
    const char *path;  /* "F", "F:PART", "F:PART:LAYER", "RUN", "RUN:IMAGE" */
    const char *part;  /* NULL: that of the path, else the most visual part */
    const char *layer; /* "depth", "material.roughness"; NULL: the part's colour, else its first layer */
    const char *image; /* of a run; NULL: the last colour image */
};

/* Channels in the order R G B A or X Y Z, else as in the file; at most 4. */
struct source {
    char title[300];       /* "screen_travelled", "gbuffer:depth" */
    char unit[64];         /* "" if unknown */
    char channels[4][256]; /* without the layer's name */
    uint32_t width, height, components;
    bool integer; /* the texels are integers */
    bool display; /* they were encoded for a display, and are decoded here */
    bool cube;    /* faces of a cube map below each other */
    float *texels;
};

/* Splits "PATH[:PART[:LAYER]]": returns the malloc'd path; *part and *layer point into it, or are NULL if absent. */
char *source_split(const char *text, char **part, char **layer);
bool source_open(struct source *source, const struct source_choice *choice, struct glint_error *err);
void source_finish(struct source *source);
/* The index of a channel; -1 if there is none. */
int source_channel(const struct source *source, const char *name);

#endif

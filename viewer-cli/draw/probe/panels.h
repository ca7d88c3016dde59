/* The panels of a pixel's drawing, by kind of record. */
#ifndef GLINT_VIEWER_PROBE_PANELS_H
#define GLINT_VIEWER_PROBE_PANELS_H

#include "draw/probe/drawing.h"

/* draw_encode_picture encodes the pipeline's final image as a data URI; draw_define writes it where <use href="#picture"/> finds it. */
json_t *draw_encode_picture(const struct probe *probe, struct glint_error *err);
void draw_define(struct drawing *drawing);

/* These draw nothing if the pass has no records of such a ray. */
void draw_picture(struct drawing *drawing, const struct ray_records *records, double left, double width);
void draw_screen(struct drawing *drawing, const struct ray_records *records);
void draw_cubes(struct drawing *drawing, const struct ray_records *records);
void draw_mixtures(struct drawing *drawing, const struct ray_records *records);

#endif

/* The panels of a pixel's drawing, one for each kind of record. */
#ifndef GLINT_VIEWER_PROBE_PANELS_H
#define GLINT_VIEWER_PROBE_PANELS_H

#include "draw/probe/drawing.h"

/* The picture that the pipeline made, as a text for an image; and that text where <use href="#picture"/> finds it. */
json_t *draw_encode(const struct probe *probe, struct glint_error *err);
void draw_define(struct drawing *drawing);

/* Nothing where the pass recorded no such ray. */
void draw_picture(struct drawing *drawing, const struct ray_records *records, double left, double width);
void draw_screen(struct drawing *drawing, const struct ray_records *records);
void draw_cubes(struct drawing *drawing, const struct ray_records *records);
void draw_mixtures(struct drawing *drawing, const struct ray_records *records);

#endif

/* Draws the trace of a pixel. */
#ifndef GLINT_VIEWER_PROBE_DRAW_H
#define GLINT_VIEWER_PROBE_DRAW_H

#include "probe/probe.h"

/* Writes an SVG file. A pixel without a ray is an error. */
bool probe_draw(const char *path, const struct probe *probe, struct glint_error *err);

#endif

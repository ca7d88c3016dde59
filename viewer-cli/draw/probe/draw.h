/* Draws the trace of a pixel. */
#ifndef GLINT_VIEWER_PROBE_DRAW_H
#define GLINT_VIEWER_PROBE_DRAW_H

#include "probe/probe.h"

/* The text of an SVG file, malloc'd. NULL on failure; a pixel without a ray is one, with GLINT_ERROR_FORMAT. */
char *probe_draw(const struct probe *probe, struct glint_error *err);

#endif

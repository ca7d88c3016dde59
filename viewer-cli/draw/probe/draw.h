/* A pixel's trace as a drawing. */
#ifndef GLINT_VIEWER_PROBE_DRAW_H
#define GLINT_VIEWER_PROBE_DRAW_H

#include "probe/probe.h"

/* An SVG file. Fails when there is no ray to draw. */
bool probe_draw(const char *path, const struct probe *probe, struct glint_error *err);

#endif

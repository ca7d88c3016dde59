/* --against truth: how far traced rays are from what a path tracer found. */
#ifndef GLINT_VIEWER_AGAINST_H
#define GLINT_VIEWER_AGAINST_H

#include <jansson.h>

#include "glint/study.h"

/* Rays of surfaces rougher than this are not compared with the mirror ray. */
#define AGAINST_ROUGHNESS 0.1

void against_print(const struct glint_trace_table *table);
json_t *against_json(const struct glint_trace_table *table);

#endif

/* A pipeline as the JSON of a preset file. */
#ifndef GLINT_VIEWER_PRESET_JSON_H
#define GLINT_VIEWER_PRESET_JSON_H

#include <jansson.h>

#include "glint/replay.h"

/* The value of a parameter as presets have it: a number, true, false or the name of a choice. */
json_t *parameter_value_json(const struct glint_row *row, double value);
/* Variants, and parameters that differ from their declared defaults. */
json_t *preset_json(const struct glint_pipeline *pipeline, const char *name, const char *title);

#endif

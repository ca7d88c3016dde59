/* What glint info says of a capture's light: sun, lamps, shadow maps, volumes, and how far truths were traced. */
#ifndef GLINT_VIEWER_INFO_LIGHT_H
#define GLINT_VIEWER_INFO_LIGHT_H

#include <jansson.h>

#include "glint/capture.h"

void info_print_light(const struct glint_capture *capture);
/* NULL without a sun. */
json_t *sun_json(const struct glint_frame *frame);
json_t *lights_json(const struct glint_frame *frame);
/* Adds what a part of light or shadow carries to its object. */
void light_part_json(const struct glint_part_info *part, json_t *json);

#endif

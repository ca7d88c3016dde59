/* Describes a capture's camera: position, direction, field of view, planes. */
#ifndef GLINT_VIEWER_CAMERA_FACTS_H
#define GLINT_VIEWER_CAMERA_FACTS_H

#include <jansson.h>

#include "glint/capture.h"

struct camera_facts {
    double position[3], forward[3]; /* world */
    double fov_x_deg, fov_y_deg;
    double near, far; /* units; +inf when there is no far plane */
};

struct camera_facts camera_facts(const struct glint_frame *frame);
/* The notes of glint_frame_notes as JSON, and as lines on stdout. */
json_t *frame_notes_json(const struct glint_frame *frame);
void frame_notes_print(const struct glint_frame *frame);
const char *axis_name(enum glint_axis axis);

#endif

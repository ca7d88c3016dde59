/* Pictures of what a study measures: what a pipeline shows, and its error, in files of the study's folder. */
#ifndef GLINT_VIEWER_DRAWING_H
#define GLINT_VIEWER_DRAWING_H

#include <jansson.h>

#include "glint/judge.h"

/* Writes FOLDER/name, a PNG with its title below. */
bool drawing_write(const char *folder, const char *name, const struct glint_pixels *pixels, const char *title,
                   struct glint_error *err);
/* The picture that the pipeline evaluated last makes; nothing if it makes none. */
bool drawing_write_picture(struct glint_judge *judge, const char *folder, const char *name, struct glint_error *err);
/* The error of a pipeline's result against a target. */
bool drawing_write_error(struct glint_judge *judge, enum glint_target target, const struct glint_pipeline *pipeline,
                         const struct glint_pixels *result, const char *folder, const char *name, const char *title,
                         struct glint_error *err);
/* Adds FOLDER/name to pictures of a page, if it is there. `beside`: the page loads it when it comes into view, and does not contain it. */
void drawing_add(json_t *pictures, const char *folder, const char *name, const char *caption, bool beside);

#endif

/* How the channels of a part are encoded. */
#ifndef GLINT_PACK_ENCODINGS_H
#define GLINT_PACK_ENCODINGS_H

#include "part.h"

/* Chooses the encodings that the manifest leaves open, and checks the others against camera and textures. */
bool encodings_read(struct part *part, const struct glint_camera *camera, struct glint_error *err);

#endif

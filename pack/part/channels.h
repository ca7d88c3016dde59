/* The channels of a part. */
#ifndef GLINT_PACK_CHANNELS_H
#define GLINT_PACK_CHANNELS_H

#include "part.h"

/* Reads the part's channels, and the textures that they name. */
bool channels_read(struct part *part, struct glint_error *err);
void channels_finish(struct part *part);

#endif

/* The values of a part's channels. */
#ifndef GLINT_PACK_CONVERT_H
#define GLINT_PACK_CONVERT_H

#include "part.h"

/* Chooses each channel's type and storage format; the encodings must be known. */
bool channels_choose(struct part *part, struct glint_error *err);
/* Allocates and fills each channel's data. */
bool channels_convert(struct part *part, struct glint_error *err);

#endif

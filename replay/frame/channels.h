/* Channels of one part of a capture, decoded to interleaved floats. */
#ifndef GLINT_REPLAY_CHANNELS_H
#define GLINT_REPLAY_CHANNELS_H

#include "glint/capture.h"
#include "row.h"

struct channels {
    const struct glint_part_info *part;
    const char **names; /* copies */
    size_t count;
    float *data; /* NULL before they are read */
};
bool channels_add(struct channels *channels, const char *name, size_t length, struct glint_error *err);
/* Adds the channels of a capture row ("R G B -"). */
bool channels_add_row(struct channels *channels, const struct glint_row *row, struct glint_error *err);
/* The index of a channel, or `count`. */
size_t channels_find(const struct channels *channels, const char *name, size_t length);
/* Removes channels from the end until `count` are left. */
void channels_keep(struct channels *channels, size_t count);
bool channels_read(struct channels *channels, struct glint_capture *capture, struct glint_error *err);
void channels_finish(struct channels *channels);
/* enlarge.c: resamples a cube map to a larger face size. Colours are interpolated, distances only between texels of one surface. */
bool channels_enlarge(struct channels *channels, uint32_t face, struct glint_error *err);

#endif

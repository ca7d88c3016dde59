/* Images back in host memory. */
#ifndef GLINT_REPLAY_READBACK_H
#define GLINT_REPLAY_READBACK_H

#include "state.h"

/* One level of an image, as callers see it. */
struct image_part {
    struct image *image;
    const struct glint_image *info;
};
enum { PASS_PARTS_MAX = PASS_IMAGES_MAX * LEVELS_MAX };

/* Copies levels of images into the buffer, which grows when it has to, each tightly packed at its offset. */
bool readback_images(struct glint_replay *replay, const struct image_part *parts, size_t count,
                     struct host_buffer *buffer, VkDeviceSize *offsets, struct glint_error *err);
/* All levels of the images shown as a pass's, in the order of its rows; fills at most `capacity`. */
size_t parts_of_pass(const struct glint_replay *replay, const struct glint_pass *pass, struct image_part *parts,
                     size_t capacity);

#endif

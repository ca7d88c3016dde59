/* Images back in host memory. */
#ifndef GLINT_REPLAY_READBACK_H
#define GLINT_REPLAY_READBACK_H

#include "state.h"

/* Copies images into the buffer, which grows when it has to, each tightly packed at its offset. */
bool readback_images(struct glint_replay *replay, struct image *const *images, size_t count, struct host_buffer *buffer,
                     VkDeviceSize *offsets, struct glint_error *err);
/* The listed images that a pass made, in the order of its rows; fills at most `capacity`. */
size_t images_of_pass(const struct glint_replay *replay, const struct glint_pass *pass, struct image **images,
                      size_t capacity);

#endif

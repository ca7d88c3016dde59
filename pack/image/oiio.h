/* Images decoded by OpenImageIO, from memory, as the file stores them: no colour is converted, no alpha is multiplied in. */
#ifndef GLINT_PACK_OIIO_H
#define GLINT_PACK_OIIO_H

#include <stdint.h>

#include "glint/common.h"

#ifdef __cplusplus
extern "C" {
#endif

struct oiio_image {
    uint32_t width, height, channels;
    unsigned bits; /* of a channel: 8, 16, 32 */
    bool is_float; /* or unsigned integers */
    void *pixels;  /* interleaved, tight; malloc'd */
    size_t size;
};

/* `kind` is OpenImageIO's name of the file format: "png", "hdr", "dds". `path` stands in messages only. Images whose pixels would take
   more than `most` bytes are refused. */
bool oiio_decode(const char *path, const char *kind, const uint8_t *data, size_t size, uint64_t most,
                 struct oiio_image *out, struct glint_error *err);

/* The same in the module that oiio_decode loads. */
bool glint_oiio_decode(const char *path, const char *kind, const uint8_t *data, size_t size, uint64_t most,
                       struct oiio_image *out, struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif

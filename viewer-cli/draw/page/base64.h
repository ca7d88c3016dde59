/* Bytes as texts of JSON. */
#ifndef GLINT_VIEWER_BASE64_H
#define GLINT_VIEWER_BASE64_H

#include <jansson.h>
#include <stdint.h>

/* `before` and the bytes in base 64; NULL when memory is short. */
json_t *base64_json(const char *before, const uint8_t *bytes, size_t size);

#endif

/* Encodes bytes as JSON strings. */
#ifndef GLINT_VIEWER_BASE64_H
#define GLINT_VIEWER_BASE64_H

#include <jansson.h>
#include <stdint.h>

/* Returns `before` followed by the bytes in base 64; NULL when out of memory. */
json_t *base64_json(const char *before, const uint8_t *bytes, size_t size);

#endif

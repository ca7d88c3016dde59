/* Captures of the fixture in which some channels of a part are encoded. */
#ifndef ENCODED_H
#define ENCODED_H

#include "fixture.h"

/* The values of up to three encoded channels, large enough for any type. */
extern double encoded_bits[3][FIX_W * FIX_H];

/* Writes encoded_bits as the channels `names` of the part, in the storage format (NULL: not declared), and opens the capture. Encodings
   that leave out Z have no Z channel. Fails the test with the error's message. */
struct glint_capture *encoded_capture(const char *path, const char *part, const struct glint_encodings *encodings,
                                      const char *const *names, size_t count, enum glint_type type, const char *storage,
                                      const struct glint_frame *frame);
/* Reads decoded channels as floats. */
void encoded_read(struct glint_capture *capture, const char *part, const char *const *names, size_t count, float *out);

#endif

/* One part of a capture while its channels are added. */
#ifndef SAMPLES_DUMP_PART_H
#define SAMPLES_DUMP_PART_H

#include "dump.h"
#include "encode.h"

enum { DUMP_MAX_CHANNELS = 24 };

struct dump_part {
    struct glint_part part;
    struct glint_channel channels[DUMP_MAX_CHANNELS];
    void *memory[DUMP_MAX_CHANNELS];
    size_t pixels;
    bool failed;
};

extern const struct storage dump_half, dump_float;

void dump_begin(struct dump_part *part, const struct dump *dump, const char *name, uint32_t width, uint32_t height);
/* Adds a channel; `source` is its first value, consecutive values are `stride_bytes` apart. */
void dump_channel(struct dump_part *part, const char *name, struct storage storage, const float *source,
                  size_t stride_bytes);
void dump_channels3(struct dump_part *part, const char *const names[3], struct storage storage, const vec3 *source,
                    size_t stride_bytes);
/* Begins a part whose first channels are R G B. */
bool dump_colors(struct dump_part *part, const struct dump *dump, const char *name, uint32_t width, uint32_t height,
                 struct storage storage, const vec3 *first, size_t stride_bytes, struct glint_error *err);
/* Hands the part to the writer. */
bool dump_end(struct dump_part *part, const struct dump *dump, struct glint_error *err);

#endif

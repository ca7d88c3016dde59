/* Multi-part scanline OpenEXR files through OpenEXRCore, with chunks compressed and decompressed on all cores. Everything in glint
   that reads or writes EXR files uses it. The reader checks sizes, counts and offsets against limits before it allocates memory. */
#ifndef GLINT_EXR_H
#define GLINT_EXR_H

#include "glint/capture.h"

#ifdef __cplusplus
extern "C" {
#endif

enum glint_exr_attribute_type {
    GLINT_EXR_STRING,
    GLINT_EXR_INT,
    GLINT_EXR_FLOAT,
    GLINT_EXR_DOUBLE,
    GLINT_EXR_V2D,
    GLINT_EXR_V3D,
    GLINT_EXR_V3F,
    GLINT_EXR_M44D,
    GLINT_EXR_FLOATS,
    GLINT_EXR_STRINGS,
    GLINT_EXR_OPAQUE /* any other type, as bytes */
};

struct glint_exr_attribute {
    const char *name;
    enum glint_exr_attribute_type type;
    const char *type_name; /* EXR's name of the type */
    const char *string;
    const char *const *strings; /* `count` of them */
    const double *numbers;      /* int, float, double: 1; v2: 2; v3: 3; m44d: 16, row-major; floats: `count` */
    const void *bytes;          /* opaque: `count` bytes */
    size_t count;
};

struct glint_exr_channel {
    const char *name;
    enum glint_stored stored;
    const void *data;                      /* of the stored type; native byte order */
    size_t x_stride_bytes, y_stride_bytes; /* 0: tight */
};

struct glint_exr_part {
    const char *name;
    uint32_t width, height;
    const struct glint_exr_channel *channels; /* any order; the file sorts them */
    size_t channel_count;
    const struct glint_exr_attribute *attributes;
    size_t attribute_count;
    enum glint_compression compression;
};

/* Writes path.tmp-XXXXXXXX beside `path`, then renames. The memory is read during the call only. threads 0: all cores. */
bool glint_exr_write(const char *path, const struct glint_exr_part *parts, size_t count, uint32_t threads,
                     struct glint_error *err);

struct glint_exr;
struct glint_exr_part_info {
    const char *name; /* "" for a single-part file without a name */
    uint32_t width, height;
    const struct glint_channel_info *channels;
    size_t channel_count;
    const struct glint_exr_attribute *attributes; /* without those that OpenEXR itself requires */
    size_t attribute_count;
};

/* Opens a single- or multi-part file. Tiled and deep parts are listed, but reading them fails as unsupported. */
struct glint_exr *glint_exr_open(const char *path, const struct glint_limits *limits, struct glint_error *err);
void glint_exr_close(struct glint_exr **exr);
size_t glint_exr_part_count(const struct glint_exr *exr);
const struct glint_exr_part_info *glint_exr_part(const struct glint_exr *exr, size_t i);
const struct glint_exr_attribute *glint_exr_attribute(const struct glint_exr_part_info *part, const char *name);
/* Reads channels interleaved: out[(y·width + x)·count + i] is channels[i], and a channel name of NULL yields 0. `type` is GLINT_F16,
   GLINT_F32, GLINT_U8, GLINT_U16 or GLINT_U32. Half and float convert into each other, and keep every bit if no conversion is
   needed. Conversions between float and integer types are errors, as is a value that does not fit the integer type. Of a tiled part it reads the
   largest level, as GLINT_F16, GLINT_F32 or GLINT_U32. */
bool glint_exr_read(struct glint_exr *exr, size_t part, const char *const *channels, size_t count, enum glint_type type,
                    void *out, uint32_t threads, struct glint_error *err);

/* What a colour in the curve of sRGB (glint.color is "srgb") decodes to; continued above 1, and mirrored below 0. */
float glint_linear_of_srgb(float value);

#ifdef __cplusplus
}
#endif
#endif

/* Reads channels of a part, decoded block by block in the threads that decompress them. */
#include <Imath/half.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "capture_internal.h"

enum decoding { AS_STORED, LENGTH, DEPTH, NORMAL, ROUGHNESS, MOTION, PACKED, COLOR };

/* A requested channel: the planes of the file that it is decoded from, and how. */
struct output {
    enum decoding decoding;
    enum glint_normal_encoding normal;
    int axis;     /* X, Y, Z: 0, 1, 2 */
    int plane[3]; /* of the file's requested channels; a normal has X, Y, Z, the others one; -1 for none */
    float absent; /* without a plane: the value of every pixel */
    int mask;     /* the plane of the roughness by which values are read as 0, or -1 */
};

struct job {
    struct glint_decoder decoder;
    const char *names[GLINT_EXR_MAX_WANTED];
    enum glint_stored stored[GLINT_EXR_MAX_WANTED];
    size_t planes;
    struct output outputs[GLINT_EXR_MAX_WANTED];
    size_t count;
    enum glint_type type;
    uint8_t *out;
    struct glint_precision precision[GLINT_EXR_MAX_WANTED]; /* of the planes that are perturbed */
    struct glint_coins coins[GLINT_EXR_MAX_WANTED];
    bool moves[GLINT_EXR_MAX_WANTED];
};

/* The index of a file channel among those to read; adds it once. -1 when the part has none or there is no room. */
static int want_channel(struct job *job, const struct glint_exr_part_info *part, const char *name) {
    for (size_t i = 0; i < job->planes; i++)
        if (!strcmp(job->names[i], name)) return (int)i;
    const int at = glint_exr_channel(part, name);
    if (at < 0 || job->planes == GLINT_EXR_MAX_WANTED) return -1;
    job->names[job->planes] = part->channels[at].name;
    job->stored[job->planes] = part->channels[at].stored;
    return (int)job->planes++;
}

static int axis_of(const char *name) {
    const char last = name[strlen(name) - 1];
    return last == 'Y' ? 1 : last == 'Z' ? 2 : 0;
}

static enum decoding decoding_of(const struct glint_part_info *part, const struct glint_role_channel *row) {
    if (!row) return AS_STORED;
    const int encoding = glint_part_encoding(part, row);
    if (!strcmp(row->encoding, "depth")) return DEPTH;
    if (!strcmp(row->encoding, "normal") || !strcmp(row->encoding, "vertex_normal")) return NORMAL;
    if (!strcmp(row->encoding, "roughness")) return encoding == GLINT_ROUGHNESS_PERCEPTUAL ? AS_STORED : ROUGHNESS;
    if (!strcmp(row->encoding, "motion"))
        return encoding == GLINT_MOTION_UV ? AS_STORED : encoding == GLINT_MOTION_PACKED16 ? PACKED : MOTION;
    if (!strcmp(row->encoding, "motion_depth")) return encoding == GLINT_MOTION_DEPTH_VIEW_LINEAR ? LENGTH : PACKED;
    if (!strcmp(row->encoding, "color")) return encoding == GLINT_COLOR_LINEAR ? AS_STORED : COLOR;
    return !strcmp(row->unit, "m") ? LENGTH : AS_STORED;
}

static bool plan_normal(struct job *job, const struct glint_part_info *part, const struct glint_exr_part_info *file,
                        const struct glint_role_channel *row, struct output *to) {
    char name[64];
    snprintf(name, sizeof name, "%s", row->name);
    to->normal = (enum glint_normal_encoding)glint_part_encoding(part, row);
    for (int axis = 0; axis < 3; axis++) {
        name[strlen(name) - 1] = "XYZ"[axis];
        to->plane[axis] = axis == 2 && !glint_normal_has_z(to->normal) ? -1 : want_channel(job, file, name);
        if (to->plane[axis] < 0 && !(axis == 2 && !glint_normal_has_z(to->normal))) return false;
    }
    return true;
}

/* Surfaces that are too rough for the engine to reflect anything have neither metalness nor specular. */
static bool is_masked(const struct job *job, const struct glint_part_info *part, const char *name) {
    return job->decoder.frame->has_material && job->decoder.frame->material.roughest_reflection > 0 && part->role &&
           !strcmp(part->role->name, "gbuffer") &&
           (!strcmp(name, "material.metalness") || !strcmp(name, "material.specular"));
}

static bool plan_output(struct job *job, const struct glint_part_info *part, const struct glint_exr_part_info *file,
                        const char *name, struct output *to) {
    *to = (struct output){.plane = {-1, -1, -1}, .mask = -1};
    if (!name) return true;
    const struct glint_role_channel *row = glint_role_channel_find(part->role, name);
    to->decoding = decoding_of(part, row);
    to->axis = axis_of(name);
    if (to->decoding == NORMAL) return plan_normal(job, part, file, row, to);
    to->plane[0] = want_channel(job, file, name);
    if (is_masked(job, part, name) && (to->mask = want_channel(job, file, "material.roughness")) < 0) return false;
    if (row && !isnan(row->absent)) to->absent = (float)row->absent;
    return to->plane[0] >= 0 || (row && !isnan(row->absent));
}

/* ---- blocks ---- */

static void store_values(const struct job *job, const float *values, size_t count, uint8_t *out) {
    if (job->type == GLINT_F32) {
        for (size_t i = 0; i < count; i++) memcpy(out + 4 * i * job->count, &values[i], 4);
        return;
    }
    uint16_t half[GLINT_BLOCK];
    for (size_t i = 0; i < count; i++) half[i] = imath_float_to_half(values[i]);
    for (size_t i = 0; i < count; i++) memcpy(out + 2 * i * job->count, &half[i], 2);
}

static void put_absent(const struct job *job, const struct output *from, size_t count, uint8_t *out) {
    const uint16_t half = imath_float_to_half(from->absent);
    const size_t bytes = job->type == GLINT_F16 ? 2 : 4;
    for (size_t i = 0; i < count; i++)
        memcpy(out + bytes * i * job->count, bytes == 2 ? (const void *)&half : &from->absent, bytes);
}

/* Values that are not decoded keep every bit if the types agree. */
static bool put_as_stored(const struct job *job, const struct output *from, const uint8_t *in, size_t count,
                          uint8_t *out) {
    if (from->mask >= 0) return false;
    if (from->plane[0] < 0) {
        put_absent(job, from, count, out);
        return true;
    }
    const bool half = job->stored[from->plane[0]] == GLINT_STORED_HALF;
    if (from->decoding != AS_STORED || job->moves[from->plane[0]] || half != (job->type == GLINT_F16)) return false;
    if (half)
        for (size_t i = 0; i < count; i++) memcpy(out + 2 * i * job->count, in + 2 * i, 2);
    else
        for (size_t i = 0; i < count; i++) memcpy(out + 4 * i * job->count, in + 4 * i, 4);
    return true;
}

struct block {
    float values[3][GLINT_BLOCK];
    int normal[3]; /* the planes that `values` hold the normal of, so that X, Y and Z are decoded once */
    bool has_normal;
};

/* `pixel` is the first one's number. */
static void load_values(const struct job *job, const uint8_t *in, uint64_t pixel, size_t count, int plane, float *out) {
    glint_decode_widen(job->stored[plane], in, count, out);
    if (job->moves[plane]) glint_perturb(&job->precision[plane], &job->coins[plane], pixel, out, count);
}

static const float *normal_of(const struct job *job, const struct output *from, const uint8_t *const *planes,
                              size_t line, uint32_t x, uint64_t pixel, size_t count, struct block *block) {
    if (!block->has_normal || memcmp(block->normal, from->plane, sizeof block->normal)) {
        for (int axis = 0; axis < 3; axis++) {
            const int plane = from->plane[axis];
            if (plane >= 0)
                load_values(job, planes[plane] + line + x * glint_stored_bytes(job->stored[plane]), pixel, count, plane,
                            block->values[axis]);
        }
        float *const n[3] = {block->values[0], block->values[1], block->values[2]};
        glint_decode_normal(&job->decoder, from->normal, n, NULL, count);
        memcpy(block->normal, from->plane, sizeof block->normal);
        block->has_normal = true;
    }
    return block->values[from->axis];
}

/* Packed values are integers, whose half step is 0.5, and are decoded linearly. */
static void decode_packed(const struct job *job, const struct output *from, const uint8_t *in, uint64_t pixel, float *v,
                          size_t count) {
    uint32_t words[GLINT_BLOCK];
    const uint32_t ends[2] = {0, 1};
    float line[2];
    memcpy(words, in, count * 4);
    glint_decode_motion_packed(&job->decoder, from->axis, words, v, count);
    if (!job->moves[from->plane[0]]) return;
    glint_decode_motion_packed(&job->decoder, from->axis, ends, line, 2);
    for (size_t i = 0; i < count; i++)
        v[i] += (float)(0.5 * glint_perturbation_sign(&job->coins[from->plane[0]], pixel + i)) * (line[1] - line[0]);
}

static void mask_values(const struct job *job, const struct output *from, const uint8_t *roughness, uint64_t pixel,
                        float *v, size_t count) {
    float r[GLINT_BLOCK];
    load_values(job, roughness, pixel, count, from->mask, r);
    glint_decode_roughness(&job->decoder, r, count);
    const float roughest = (float)job->decoder.frame->material.roughest_reflection; /* as a roughness is decoded */
    for (size_t i = 0; i < count; i++)
        if (r[i] >= roughest) v[i] = 0;
}

static void decode_values(const struct job *job, const struct output *from, const uint8_t *in, uint64_t pixel, float *v,
                          size_t count) {
    if (from->decoding == PACKED) {
        decode_packed(job, from, in, pixel, v, count);
        return;
    }
    load_values(job, in, pixel, count, from->plane[0], v);
    switch (from->decoding) {
    case LENGTH:
        glint_decode_length(&job->decoder, v, count);
        break;
    case DEPTH:
        glint_decode_depth(&job->decoder, v, count);
        break;
    case ROUGHNESS:
        glint_decode_roughness(&job->decoder, v, count);
        break;
    case MOTION:
        glint_decode_motion(&job->decoder, from->axis, v, count);
        break;
    case COLOR:
        glint_decode_color(&job->decoder, v, count);
        break;
    case AS_STORED:
    case NORMAL:
    case PACKED:
        break;
    }
}

static bool decode_rows(void *user, uint32_t y, uint32_t lines, const uint8_t *const *planes, size_t line_bytes,
                        struct glint_error *err) {
    (void)err;
    const struct job *job = user;
    const uint32_t width = job->decoder.width;
    const size_t bytes = job->type == GLINT_F16 ? 2 : 4;
    struct block block;
    float values[GLINT_BLOCK];
    for (uint32_t l = 0; l < lines; l++)
        for (uint32_t x = 0; x < width; x += GLINT_BLOCK) {
            const size_t count = width - x < GLINT_BLOCK ? width - x : GLINT_BLOCK, line = l * line_bytes;
            const uint64_t pixel = (uint64_t)(y + l) * width + x;
            block.has_normal = false;
            for (size_t i = 0; i < job->count; i++) {
                const struct output *from = &job->outputs[i];
                uint8_t *out = job->out + (pixel * job->count + i) * bytes;
                const uint8_t *in = from->plane[0] < 0 ? NULL
                                                       : planes[from->plane[0]] + line +
                                                             x * glint_stored_bytes(job->stored[from->plane[0]]);
                if (put_as_stored(job, from, in, count, out)) continue;
                if (from->decoding == NORMAL) {
                    store_values(job, normal_of(job, from, planes, line, x, pixel, count, &block), count, out);
                } else {
                    if (in) decode_values(job, from, in, pixel, values, count);
                    else
                        for (size_t k = 0; k < count; k++) values[k] = from->absent;
                    if (from->mask >= 0)
                        mask_values(job, from,
                                    planes[from->mask] + line + x * glint_stored_bytes(job->stored[from->mask]), pixel,
                                    values, count);
                    store_values(job, values, count, out);
                }
            }
        }
    return true;
}

/* Sets which planes are perturbed. The depth of sky is at an end of its encoding's range and stays. */
static void plan_perturbation(const struct glint_capture *capture, const struct glint_part_info *part,
                              const struct glint_exr_part_info *file, struct job *job) {
    const struct glint_perturbation *p = &capture->perturbation;
    for (size_t i = 0; p->seed && i < job->planes; i++) {
        const int at = glint_exr_channel(file, job->names[i]);
        const struct glint_role_channel *row = glint_role_channel_find(part->role, job->names[i]);
        job->moves[i] = glint_perturbation_moves(p, part, job->names[i]);
        job->coins[i] = glint_perturbation_coins(p, part, job->names[i]);
        job->precision[i] = glint_precision_of(part->channels[at].storage, job->names[i], job->stored[i]);
        if (row && !strcmp(row->encoding, "depth")) glint_precision_of_depth(&job->precision[i], &job->decoder);
    }
}

/* ---- the calls ---- */

struct glint_decoder glint_decoder_of(const struct glint_capture *capture, const struct glint_part_info *part) {
    return (struct glint_decoder){.frame = &capture->frame,
                                  .camera = part->has_planar ? &part->planar.camera
                                            : part->previous ? &capture->frame.previous
                                                             : &capture->frame.camera,
                                  .encodings = part->encodings,
                                  .width = part->width,
                                  .height = part->height};
}

static const struct glint_source *source_of(const struct glint_capture *capture, const struct glint_part_info *part,
                                            struct glint_error *err) {
    const size_t i = part ? (size_t)(part - capture->parts) : capture->count;
    if (i < capture->count && &capture->parts[i] == part) return &capture->sources[i];
    glint_fail(err, GLINT_ERROR_USAGE, "%s: expected a part of this capture, found another", capture->exr->path);
    return NULL;
}

bool glint_capture_read(struct glint_capture *capture, const struct glint_part_info *part, const char *const *channels,
                        size_t count, enum glint_type type, void *out, uint32_t threads, struct glint_error *err) {
    const struct glint_source *source = source_of(capture, part, err);
    if (!source) return false;
    if (type == GLINT_U8 || type == GLINT_U16 || type == GLINT_U32)
        return glint_exr_read(source->exr, source->part, channels, count, type, out, threads, err);
    if ((type != GLINT_F16 && type != GLINT_F32) || !count || count > GLINT_EXR_MAX_WANTED)
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "%s: part %s: expected 1 to %d channels and a plain type, found %zu, type %d",
                          capture->exr->path, part->name, GLINT_EXR_MAX_WANTED, count, (int)type);
    const struct glint_exr_part_info *file = &source->exr->parts[source->part].info;
    struct job job = {.count = count, .type = type, .out = out};
    job.decoder = glint_decoder_of(capture, part);
    for (size_t i = 0; i < count; i++) {
        if (!plan_output(&job, part, file, channels[i], &job.outputs[i]))
            return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: %s missing", capture->exr->path, part->name,
                              channels[i]);
        const int plane = job.outputs[i].plane[0];
        if (plane >= 0 && (job.stored[plane] == GLINT_STORED_UINT) != (job.outputs[i].decoding == PACKED))
            return glint_fail(err, GLINT_ERROR_USAGE, "%s: part %s: %s: expected half or float, found uint",
                              capture->exr->path, part->name, channels[i]);
    }
    if (!job.planes) { /* nothing is stored of what is requested */
        for (size_t i = 0; i < count; i++)
            put_absent(&job, &job.outputs[i], (size_t)part->width * part->height,
                       job.out + i * (type == GLINT_F16 ? 2 : 4));
        return true;
    }
    plan_perturbation(capture, part, file, &job);
    return glint_exr_rows(source->exr, source->part, job.names, job.planes, threads, decode_rows, &job, err);
}

bool glint_capture_read_raw(struct glint_capture *capture, const struct glint_part_info *part,
                            const char *const *channels, size_t count, enum glint_type type, void *out,
                            uint32_t threads, struct glint_error *err) {
    const struct glint_source *source = source_of(capture, part, err);
    return source && glint_exr_read(source->exr, source->part, channels, count, type, out, threads, err);
}

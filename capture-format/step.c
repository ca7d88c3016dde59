/* The resolution of storage formats. */
#include <math.h>
#include <string.h>

#include "capture_internal.h"

double glint_channel_step(const struct glint_capture *capture, const struct glint_part_info *part, const char *channel,
                          double stored) {
    for (size_t i = 0; i < part->channel_count; i++) {
        const struct glint_channel_info *c = &part->channels[i];
        if (strcmp(c->name, channel) != 0 || c->stored == GLINT_STORED_UINT) continue;
        struct glint_precision declared = glint_precision_of(c->storage, channel, c->stored);
        /* a declared storage format is never finer than the type in the file */
        const struct glint_precision own = glint_precision_of("", channel, c->stored);
        const struct glint_role_channel *row = glint_role_channel_find(part->role, channel);
        const struct glint_decoder decoder = glint_decoder_of(capture, part);
        if (row && !strcmp(row->encoding, "depth")) glint_precision_of_depth(&declared, &decoder);
        return 2 * fmax(glint_half_step(&declared, stored), glint_half_step(&own, stored));
    }
    return 0;
}

/* What is stored at a distance in units, and back. */
static double stored_at(const struct glint_decoder *d, double units) {
    const double *m = d->camera->view_to_clip, near = d->frame->depth_near, far = d->frame->depth_far;
    const double z = m[10] * m[14] + m[11] / units;
    switch (d->encodings.depth) {
    case GLINT_DEPTH_VIEW_LINEAR:
        break;
    case GLINT_DEPTH_DEVICE:
    case GLINT_DEPTH_REVERSED:
    case GLINT_DEPTH_REVERSED_INFINITE:
        return d->frame->clip_z == GLINT_CLIP_Z_MINUS_ONE_TO_ONE ? (z + 1) / 2 : z;
    case GLINT_DEPTH_LOGARITHMIC:
        return log(units / near) / log(far / near);
    case GLINT_DEPTH_LOGARITHMIC_REVERSED:
        return 1 - log(units / near) / log(far / near);
    }
    return units;
}

static double units_of(const struct glint_decoder *d, double stored) {
    const double *m = d->camera->view_to_clip, near = d->frame->depth_near, far = d->frame->depth_far;
    const double z = d->frame->clip_z == GLINT_CLIP_Z_MINUS_ONE_TO_ONE ? 2 * stored - 1 : stored;
    double units;
    switch (d->encodings.depth) {
    case GLINT_DEPTH_VIEW_LINEAR:
        break;
    case GLINT_DEPTH_DEVICE:
        units = stored >= 1 ? INFINITY : m[11] / (z - m[10] * m[14]);
        return units > 0 ? units : INFINITY;
    case GLINT_DEPTH_REVERSED:
    case GLINT_DEPTH_REVERSED_INFINITE:
        units = stored <= 0 ? INFINITY : m[11] / (z - m[10] * m[14]);
        return units > 0 ? units : INFINITY;
    case GLINT_DEPTH_LOGARITHMIC:
        return stored >= 1 ? INFINITY : near * pow(far / near, stored);
    case GLINT_DEPTH_LOGARITHMIC_REVERSED:
        return stored <= 0 ? INFINITY : near * pow(far / near, 1 - stored);
    }
    return stored;
}

double glint_depth_step(const struct glint_capture *capture, const struct glint_part_info *part, double at_m) {
    const struct glint_decoder d = glint_decoder_of(capture, part);
    const double unit = d.frame->metres_per_unit, v = stored_at(&d, at_m / unit);
    if (!glint_part_has_channel(part, "depth.Z") || !(v > -1e-12)) return (double)NAN;
    if (d.encodings.depth != GLINT_DEPTH_VIEW_LINEAR && v > 1 + 1e-12) return (double)NAN;
    const double step = glint_channel_step(capture, part, "depth.Z", v), below = floor(v / step) * step;
    return fabs(units_of(&d, below + step) - units_of(&d, below)) * unit;
}

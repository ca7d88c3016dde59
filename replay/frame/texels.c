/* Packs values into an image's format and counts invalid values. */
#include "texels.h"

#include <math.h>
#include <string.h>

#include <Imath/half.h>

#include "parallel.h"

/* ---- Invalid values ---- */

float half_clamped(float value) {
    return isfinite(value) && fabsf(value) > HALF_LARGEST ? copysignf(HALF_LARGEST, value) : value;
}

/* In lengths +inf is the distance of the sky; inverse lengths become infinite at the camera. */
static bool may_be_infinite(const struct glint_row *row) {
    return strcmp(row->unit, "m") == 0 || strcmp(row->unit, "1/m") == 0;
}

static void note_first(struct bad_values *found, size_t index, float value) {
    if (found->not_finite + found->clamped > 1 && index > found->first) return;
    found->first = index;
    found->value = value;
}

void bad_value(struct bad_values *found, const struct glint_row *row, bool half, size_t index, float value) {
    const bool infinite = isinf(value) != 0, beyond = half && !infinite && fabsf(value) > HALF_LARGEST;
    if (!isnan(value) && !beyond && (!infinite || may_be_infinite(row))) return;
    *(beyond ? &found->clamped : &found->not_finite) += 1;
    note_first(found, index, value);
}

void bad_values_add(struct bad_values *found, const struct bad_values *more) {
    if (!more->not_finite && !more->clamped) return;
    const bool none = !found->not_finite && !found->clamped;
    found->not_finite += more->not_finite;
    found->clamped += more->clamped;
    if (none || more->first < found->first) found->first = more->first, found->value = more->value;
}

/* Texels that the device stored as the largest half were at least that large, so they count as clamped. */
struct bad_values bad_halves(const struct glint_row *row, const uint16_t *texels, size_t count) {
    struct bad_values found = {0};
    for (size_t i = 0; i < count; i++) {
        const uint16_t magnitude = texels[i] & 0x7FFF;
        if (magnitude < 0x7BFF) continue;
        if (magnitude == 0x7BFF) found.clamped++, note_first(&found, i, imath_half_to_float(texels[i]));
        else bad_value(&found, row, true, i, imath_half_to_float(texels[i]));
    }
    return found;
}

struct bad_values bad_floats(const struct glint_row *row, const float *texels, size_t count) {
    struct bad_values found = {0};
    for (size_t i = 0; i < count; i++)
        if (!isfinite(texels[i])) bad_value(&found, row, false, i, texels[i]);
    return found;
}

/* ---- Packing ---- */

/* Counts invalid values of one component. */
static void count_bad(struct packing *p, size_t c, const uint32_t *from, size_t stride, size_t begin, size_t end) {
    const size_t components = format_components(p->format);
    struct bad_values bad = {0};
    for (size_t i = begin; i < end; i++, from += stride) {
        float value;
        memcpy(&value, from, sizeof value);
        bad_value(&bad, p->row, format_bytes(p->format) / components == 2, i * components + c, value);
    }
    pthread_mutex_lock(&p->lock);
    bad_values_add(&p->bad, &bad);
    pthread_mutex_unlock(&p->lock);
}

static void pack_rows(void *user, size_t first, size_t last) {
    struct packing *p = user;
    const size_t components = format_components(p->format), begin = first * p->width, end = last * p->width;
    uint32_t missing;
    memcpy(&missing, &p->missing, sizeof missing);
    for (size_t c = 0; c < components; c++) {
        const uint32_t *from = p->at[c] == SIZE_MAX ? &missing : p->from + p->at[c] + begin * p->stride;
        const size_t stride = p->at[c] == SIZE_MAX ? 0 : p->stride;
        const size_t bytes = format_bytes(p->format) / components;
        if (p->row && stride) count_bad(p, c, from, stride, begin, end);
        if (bytes == 1)
            for (size_t i = begin; i < end; i++, from += stride)
                ((uint8_t *)p->to)[i * components + c] = (uint8_t)*from;
        else if (bytes == 2)
            for (size_t i = begin; i < end; i++, from += stride) {
                float value;
                memcpy(&value, from, sizeof value);
                ((uint16_t *)p->to)[i * components + c] = imath_float_to_half(half_clamped(value));
            }
        else
            for (size_t i = begin; i < end; i++, from += stride) ((uint32_t *)p->to)[i * components + c] = *from;
    }
}

void pack_texels(struct packing *packing, uint32_t width, uint32_t height) {
    packing->width = width;
    pthread_mutex_init(&packing->lock, NULL);
    parallel_rows(height, pack_rows, packing);
    pthread_mutex_destroy(&packing->lock);
}

void pack_place(struct packing *packing, const struct channels *channels, const struct glint_row *row) {
    size_t c = 0;
    for (size_t i = 0; i < 4; i++) packing->at[i] = SIZE_MAX;
    for (const char *at = row->source; *at && c < 4; c++) {
        size_t length = strcspn(at, " "), found = channels_find(channels, at, length);
        if (found < channels->count) packing->at[c] = found;
        at += length + (at[length] == ' ');
    }
}

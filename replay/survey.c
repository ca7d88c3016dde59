/* What a frame holds: shares of sky and of reflecting surfaces, ranges. */
#include "survey.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <Imath/half.h>

#include "frame_block.h"

static const char *const surveyed[] = {"depth.Z", "material.roughness", "material.metalness", "material.specular"};

size_t channels_find(const struct channels *channels, const char *name, size_t length) {
    size_t i = 0;
    while (i < channels->count &&
           (strncmp(channels->names[i], name, length) != 0 || strlen(channels->names[i]) != length))
        i++;
    return i;
}

bool channels_add(struct channels *channels, const char *name, size_t length, struct glint_error *err) {
    if (channels_find(channels, name, length) < channels->count) return true;
    const char **larger = realloc(channels->names, (channels->count + 1) * sizeof *larger);
    if (larger) channels->names = larger;
    char *copy = larger ? strndup(name, length) : NULL;
    if (!copy) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    channels->names[channels->count++] = copy;
    return true;
}

bool channels_add_row(struct channels *channels, const struct glint_row *row, struct glint_error *err) {
    for (const char *at = row->source; *at;) {
        size_t length = strcspn(at, " ");
        if (!(length == 1 && *at == '-') && !channels_add(channels, at, length, err)) return false;
        at += length + (at[length] == ' ');
    }
    return true;
}

bool channels_add_survey(struct channels *channels, struct glint_error *err) {
    for (size_t i = 0; i < sizeof surveyed / sizeof surveyed[0]; i++)
        if (!channels_add(channels, surveyed[i], strlen(surveyed[i]), err)) return false;
    return true;
}

bool channels_read(struct channels *channels, struct glint_capture *capture, struct glint_error *err) {
    size_t values = (size_t)channels->part->width * channels->part->height * channels->count;
    channels->data = malloc(values * sizeof *channels->data);
    if (!channels->data)
        return glint_fail(err, GLINT_ERROR_MEMORY, "%s: part %s: no memory for %zu channels",
                          glint_capture_path(capture), channels->part->name, channels->count);
    return glint_capture_read(capture, channels->part, channels->names, channels->count, GLINT_F32, channels->data, 0,
                              err);
}

void channels_finish(struct channels *channels) {
    for (size_t i = 0; i < channels->count; i++) free((char *)channels->names[i]);
    free(channels->names);
    free(channels->data);
    *channels = (struct channels){0};
}

static void widen(float range[2], float value) {
    if (value < range[0]) range[0] = value;
    if (value > range[1]) range[1] = value;
}

static void count_pixel(struct glint_survey_pixels *pixels, float roughness) {
    const int bin = (int)(roughness * GLINT_SURVEY_BINS);
    pixels->count++;
    widen(pixels->roughness, roughness);
    pixels->by_roughness[bin < GLINT_SURVEY_BINS ? bin : GLINT_SURVEY_BINS - 1]++;
}

static float as_stored(float roughness) {
    const float held = imath_half_to_float(imath_float_to_half(roughness));
    return held > 0 ? fminf(held, 1) : 0; /* NaN is 0 */
}

void survey_channels(const struct channels *channels, struct glint_survey *survey) {
    size_t at[4];
    for (size_t i = 0; i < 4; i++) at[i] = channels_find(channels, surveyed[i], strlen(surveyed[i]));
    survey->surfaces = survey->reflecting = (struct glint_survey_pixels){.roughness = {INFINITY, -INFINITY}};
    survey->depth_m[0] = INFINITY, survey->depth_m[1] = -INFINITY;
    survey->pixels = (uint64_t)channels->part->width * channels->part->height;
    for (uint64_t p = 0; p < survey->pixels; p++) {
        const float *pixel = channels->data + p * channels->count;
        if (!(pixel[at[0]] < INFINITY)) {
            survey->sky++;
            continue;
        }
        const float roughness = as_stored(pixel[at[1]]);
        widen(survey->depth_m, fmaxf(pixel[at[0]], 0));
        count_pixel(&survey->surfaces, roughness);
        /* As shared/shown.glsl has it: a value that is none counts. */
        if (!(pixel[at[2]] == 0 && pixel[at[3]] == 0)) count_pixel(&survey->reflecting, roughness);
    }
}

void survey_capture_parts(const struct glint_capture *capture, struct glint_survey *survey) {
    for (size_t i = 0; i < glint_capture_part_count(capture); i++) {
        const struct glint_part_info *part = glint_capture_part(capture, i);
        survey->cubemaps += part->has_cubemap;
        survey->volumes += part->has_cubemap && part->cubemap.inner != GLINT_VOLUME_NONE;
    }
    survey->has_sky = glint_capture_find(capture, "sky") != NULL;
    survey->has_planar = glint_capture_find(capture, MIRROR_PART) != NULL;
    const struct glint_part_info *gbuffer = glint_capture_find(capture, "gbuffer");
    survey->has_fresnel = gbuffer && glint_part_has_channel(gbuffer, "material.fresnel");
    survey->has_water = glint_capture_find(capture, "water") != NULL;
    survey->has_transparent = glint_capture_find(capture, "transparent") != NULL;
    survey->has_previous = glint_capture_frame(capture)->has_previous;
    survey->has_fog = glint_capture_frame(capture)->has_fog;
}

bool glint_survey_capture(struct glint_capture *capture, struct glint_survey *survey, struct glint_error *err) {
    *survey = (struct glint_survey){0};
    struct channels channels = {.part = glint_capture_find(capture, "gbuffer")};
    bool ok =
        channels.part || glint_fail(err, GLINT_ERROR_FORMAT, "%s: part gbuffer: missing", glint_capture_path(capture));
    ok = ok && channels_add_survey(&channels, err) && channels_read(&channels, capture, err);
    if (ok) survey_channels(&channels, survey);
    if (ok) survey_capture_parts(capture, survey);
    channels_finish(&channels);
    return ok;
}

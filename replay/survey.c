/* What a frame holds: shares of sky and of reflecting surfaces, ranges, and the facts that follow. */
#include "survey.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

void survey_channels(const struct channels *channels, struct glint_survey *survey) {
    size_t at[4];
    for (size_t i = 0; i < 4; i++) at[i] = channels_find(channels, surveyed[i], strlen(surveyed[i]));
    float *ranges[] = {survey->depth_m, survey->roughness_range, survey->metalness_range, survey->specular_range};
    for (size_t i = 0; i < 4; i++) ranges[i][0] = INFINITY, ranges[i][1] = -INFINITY;
    survey->pixels = (uint64_t)channels->part->width * channels->part->height;
    for (uint64_t p = 0; p < survey->pixels; p++) {
        const float *pixel = channels->data + p * channels->count;
        if (!(pixel[at[0]] < INFINITY)) {
            survey->sky++;
            continue;
        }
        for (size_t i = 0; i < 4; i++) widen(ranges[i], pixel[at[i]]);
        if (!(pixel[at[2]] > 0) && !(pixel[at[3]] > 0)) continue;
        survey->reflecting++;
        survey->smooth += !(pixel[at[1]] > 0.1f);
        int bin = (int)(fminf(fmaxf(pixel[at[1]], 0), 1) * GLINT_SURVEY_BINS); /* fmaxf turns NaN into 0 */
        survey->roughness[bin < GLINT_SURVEY_BINS ? bin : GLINT_SURVEY_BINS - 1]++;
    }
    for (size_t i = 0; i < 4; i++)
        if (ranges[i][0] > ranges[i][1]) ranges[i][0] = ranges[i][1] = 0; /* nothing but sky */
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

bool survey_fact(const struct glint_survey *survey, const char *fact, char *reason, size_t size, bool *known) {
    *known = true;
    if (strcmp(fact, "reflecting") == 0) {
        snprintf(reason, size, "%" PRIu64 " of %" PRIu64 " pixels reflect", survey->reflecting, survey->pixels);
        return survey->reflecting > 0;
    }
    if (strcmp(fact, "reflections") == 0) { /* of whatever surface */
        snprintf(reason, size, "%" PRIu64 " of %" PRIu64 " pixels reflect%s", survey->reflecting, survey->pixels,
                 survey->has_transparent ? ", and a transparent surface" : "");
        return survey->reflecting > 0 || survey->has_transparent;
    }
    const bool smooth = strcmp(fact, "smooth") == 0;
    if (smooth || strcmp(fact, "rough") == 0) {
        const uint64_t count = smooth ? survey->smooth : survey->reflecting - survey->smooth;
        snprintf(reason, size, "%" PRIu64 " of %" PRIu64 " pixels reflect with roughness %s 0.1", count, survey->pixels,
                 smooth ? "up to" : "above");
        return count > 0;
    }
    if (strcmp(fact, "cubemaps") == 0) {
        snprintf(reason, size, "%u cube map%s", survey->cubemaps, survey->cubemaps == 1 ? "" : "s");
        return survey->cubemaps > 0;
    }
    if (strcmp(fact, "volumes") == 0) {
        snprintf(reason, size, "%u cube map%s with an inner volume", survey->volumes, survey->volumes == 1 ? "" : "s");
        return survey->volumes > 0;
    }
    if (strcmp(fact, "sky") == 0) {
        snprintf(reason, size, "%" PRIu64 " of %" PRIu64 " pixels are sky", survey->sky, survey->pixels);
        return survey->sky > 0;
    }
    if (strcmp(fact, "transparent") == 0) {
        snprintf(reason, size, "%s transparent surface", survey->has_transparent ? "a" : "no");
        return survey->has_transparent;
    }
    const bool water = strcmp(fact, "water") == 0;
    if (water || strcmp(fact, "planar") == 0) {
        const bool has = water ? survey->has_water : survey->has_planar;
        snprintf(reason, size, "%s %s", has ? "a" : "no", water ? "water surface" : "planar reflection map");
        return has;
    }
    if (strcmp(fact, "fresnel") == 0) {
        snprintf(reason, size, "materials %s how they rise towards grazing angles",
                 survey->has_fresnel ? "say" : "do not say");
        return survey->has_fresnel;
    }
    *known = false;
    return false;
}

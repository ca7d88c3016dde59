/* The figures of the survey that the host counts. */
#include "survey.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <Imath/half.h>

static const char *const surveyed[] = {"depth.Z", "material.roughness", "material.metalness", "material.specular"};

bool channels_add_survey(struct channels *channels, struct glint_error *err) {
    for (size_t i = 0; i < sizeof surveyed / sizeof surveyed[0]; i++)
        if (!channels_add(channels, surveyed[i], strlen(surveyed[i]), err)) return false;
    return true;
}

static void widen_range(float range[2], float value) {
    if (value < range[0]) range[0] = value;
    if (value > range[1]) range[1] = value;
}

static void count_pixel(struct glint_survey_pixels *pixels, float roughness) {
    const int bin = (int)(roughness * GLINT_SURVEY_BINS);
    pixels->count++;
    widen_range(pixels->roughness, roughness);
    pixels->by_roughness[bin < GLINT_SURVEY_BINS ? bin : GLINT_SURVEY_BINS - 1]++;
}

static float stored_roughness(float roughness) {
    const float held = imath_half_to_float(imath_float_to_half(roughness));
    return held > 0 ? fminf(held, 1) : 0; /* NaN counts as 0 */
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
        const float roughness = stored_roughness(pixel[at[1]]);
        widen_range(survey->depth_m, fmaxf(pixel[at[0]], 0));
        count_pixel(&survey->surfaces, roughness);
        /* A NaN counts as reflecting, as in shared/shown.glsl. */
        if (!(pixel[at[2]] == 0 && pixel[at[3]] == 0)) count_pixel(&survey->reflecting, roughness);
    }
    survey->sunlit = survey->lamplit = survey->surfaces.count;
    survey->luminous = survey->stippled = survey->skin =
        survey->pixels; /* the host does not read the picture and its masks */
    survey->light[1] = INFINITY;
}

void survey_capture_parts(const struct glint_capture *capture, struct glint_survey *survey) {
    for (size_t i = 0; i < glint_capture_part_count(capture); i++) {
        const struct glint_part_info *part = glint_capture_part(capture, i);
        survey->cubemaps += part->has_cubemap;
        survey->volumes += part->has_cubemap && part->cubemap.inner != GLINT_VOLUME_NONE;
        survey->has_shadows |= part->has_shadow && !part->shadow.has_light;
        survey->distances += part->has_cubemap && glint_part_has_channel(part, "distance.Z");
    }
#define SURVEY_PART(member, name) survey->member |= glint_capture_find(capture, name) != NULL;
#include "survey_parts.h"
    const struct glint_frame *frame = glint_capture_frame(capture);
    for (uint32_t i = 0; i < frame->class_count; i++) survey->has_skin |= !strcmp(frame->classes[i].name, "skin");
    const struct glint_part_info *gbuffer = glint_capture_find(capture, GLINT_PART_GBUFFER);
    survey->has_fresnel = gbuffer && glint_part_has_channel(gbuffer, "material.fresnel");
    survey->has_previous = glint_capture_frame(capture)->has_previous;
    survey->exposure = glint_capture_frame(capture)->exposure;
    survey->has_fog = glint_capture_frame(capture)->has_fog;
    survey->has_sun = glint_capture_frame(capture)->has_sun;
    survey->lamps = glint_capture_frame(capture)->light_count;
    survey->has_atmosphere = glint_capture_frame(capture)->has_atmosphere;
}

bool glint_survey_capture(struct glint_capture *capture, struct glint_survey *survey, struct glint_error *err) {
    *survey = (struct glint_survey){0};
    struct channels channels = {.part = glint_capture_find(capture, GLINT_PART_GBUFFER)};
    bool ok =
        channels.part || glint_fail(err, GLINT_ERROR_FORMAT, "%s: part gbuffer: missing", glint_capture_path(capture));
    ok = ok && channels_add_survey(&channels, err) && channels_read(&channels, capture, err);
    if (ok) survey_channels(&channels, survey);
    if (ok) survey_capture_parts(capture, survey);
    channels_finish(&channels);
    return ok;
}

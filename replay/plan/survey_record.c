/* The survey as JSON, for run.json and glint info --json. */
#include "survey.h"

#include <math.h>

#include "record.h"

static json_t *numbers_record(const uint64_t *values, size_t count) {
    json_t *list = json_array();
    for (size_t i = 0; i < count; i++) record_append(&list, json_integer((json_int_t)values[i]));
    return list;
}

/* null for a number that does not exist or is infinite. */
static json_t *number_record(float value) {
    return isfinite(value) ? json_real((double)value) : json_null();
}

static json_t *range_record(const float values[2]) {
    return json_pack("[oo]", number_record(values[0]), number_record(values[1]));
}

static json_t *pixels_record(const struct glint_survey_pixels *p) {
    uint64_t binned = 0;
    for (int b = 0; b < GLINT_SURVEY_BINS; b++) binned += p->by_roughness[b];
    return json_pack("{sIsoso}", "count", (json_int_t)p->count, "roughness", range_record(p->roughness), "by_roughness",
                     binned == p->count ? numbers_record(p->by_roughness, GLINT_SURVEY_BINS) : json_null());
}

bool glint_survey_class(const struct glint_survey *survey, const struct glint_stencil_class *class, uint64_t *count) {
    for (unsigned bit = 0; bit < 8; bit++)
        if (class->value == 1u << bit && class->mask == 1u << bit) {
            *count = survey->stencil_bits[bit];
            return true;
        }
    return false;
}

static json_t *stencil_record(const struct glint_survey *survey, const struct glint_frame *frame) {
    json_t *classes = json_object();
    uint64_t count;
    for (uint32_t i = 0; i < frame->class_count; i++)
        if (glint_survey_class(survey, &frame->classes[i], &count))
            record_set(&classes, frame->classes[i].name, json_integer((json_int_t)count));
    return classes;
}

const char *glint_survey_motion(const struct glint_survey *survey) {
    return survey->moving ? "objects" : survey->moved ? "camera" : NULL;
}

json_t *time_record(const struct glint_time *time) {
    return json_pack("{sIsIsIsIsb}", "n", (json_int_t)time->n, "min", (json_int_t)time->min_ns, "median",
                     (json_int_t)time->median_ns, "max", (json_int_t)time->max_ns, "cold", time->cold);
}

uint32_t glint_survey_faces(const struct glint_survey *survey, enum glint_survey_face kind) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < survey->active_surveyed; i++) {
        const struct glint_survey_cubemap *map = &survey->active[i];
        const uint8_t faces[] = {map->open, map->sky, survey->active_traced ? map->crossed : 63,
                                 survey->active_traced ? map->nearby : 63};
        for (uint32_t left = faces[kind]; left; left &= left - 1) count++;
    }
    return count;
}

/* Masks of faces as integers. */
static json_t *cubemaps_record(const struct survey_state *state) {
    const struct glint_survey *survey = &state->figures;
    json_t *list = json_array();
    for (uint32_t i = 0; i < survey->active_surveyed; i++) {
        const struct glint_survey_cubemap *map = &survey->active[i];
        json_t *entry = json_pack("{sIsisi}", "number", (json_int_t)map->number, "open", map->open, "sky", map->sky);
        if (survey->active_traced) record_set(&entry, "crossed", json_integer(map->crossed));
        if (survey->active_traced) record_set(&entry, "nearby", json_integer(map->nearby));
        record_append(&list, entry);
    }
    json_t *traced = survey->active_traced ? time_record(&state->trace_time) : NULL;
    const bool whole = traced || !survey->active_traced;
    json_t *record = json_pack("{si si si si si so so so*}", "faces", (int)(6 * survey->active_surveyed), "open",
                               (int)glint_survey_faces(survey, GLINT_SURVEY_OPEN), "sky",
                               (int)glint_survey_faces(survey, GLINT_SURVEY_SKY), "crossed",
                               (int)glint_survey_faces(survey, GLINT_SURVEY_CROSSED), "nearby",
                               (int)glint_survey_faces(survey, GLINT_SURVEY_NEARBY), "active", list, "time_ns",
                               time_record(&state->cubes.time), "reach_time_ns", traced);
    return record_if(whole, record);
}

json_t *survey_record(const struct survey_state *state, const struct glint_frame *frame) {
    const struct glint_survey *survey = &state->figures;
    json_t *json = json_pack("{sIsIsosososIsIsbsbsb}", "pixels", (json_int_t)survey->pixels, "sky",
                             (json_int_t)survey->sky, "surfaces", pixels_record(&survey->surfaces), "reflecting",
                             pixels_record(&survey->reflecting), "depth_m", range_record(survey->depth_m), "cubemaps",
                             (json_int_t)survey->cubemaps, "volumes", (json_int_t)survey->volumes, "probe",
                             survey->has_probe, "planar", survey->has_planar, "previous", survey->has_previous);
    record_set(&json, "counted_on", json_string(survey->on_device ? "device" : "host"));
    if (json && survey->on_device) record_set(&json, "time_ns", time_record(&state->time));
    if (json && survey->active_surveyed) record_set(&json, "active_cubemaps", cubemaps_record(state));
    if (!json || !survey->on_device || survey->partial) return json;
    json_t *more =
        json_pack("{so so sI sI ss? sI sI so so}", "metalness", numbers_record(survey->metalness, GLINT_SURVEY_BINS),
                  "weight", numbers_record(survey->weight, GLINT_SURVEY_WEIGHTS), "water", (json_int_t)survey->water,
                  "transparent", (json_int_t)survey->transparent, "motion", glint_survey_motion(survey), "moved",
                  (json_int_t)survey->moved, "moving", (json_int_t)survey->moving, "stencil",
                  stencil_record(survey, frame), "luminance", range_record(survey->light));
    const bool whole = json_object_update_new(json, more) == 0;
    return record_if(whole, json);
}

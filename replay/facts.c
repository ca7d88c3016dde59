/* The facts that declarations ask for, in rows NEEDS and FACT, and how the survey answers. Every answer is conservative: a
   fact that does not hold leaves no pixel for which the pass could do anything. */
#include "survey.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct question {
    const struct glint_survey *survey;
    const struct glint_survey_pixels *shown; /* pixels whose reflection the picture shows */
    double value;                            /* of the parameter that the fact is about */
    char *reason;
    size_t size;
};

static bool reflecting(const struct question *q) {
    snprintf(q->reason, q->size, "%" PRIu64 " of %" PRIu64 " pixels reflect", q->shown->count, q->survey->pixels);
    return q->shown->count > 0;
}

static bool reflections(const struct question *q) {
    const bool opaque = reflecting(q);
    const size_t end = strlen(q->reason);
    if (q->survey->has_transparent) snprintf(q->reason + end, q->size - end, ", and a transparent surface");
    return opaque || q->survey->has_transparent;
}

/* Whether a list of what reflects leaves something out. */
static bool sparse(const struct question *q) {
    const double part = q->survey->pixels ? (double)q->shown->count / (double)q->survey->pixels : 0;
    snprintf(q->reason, q->size, "%.3g %% of the pixels reflect, the limit is %.3g %%", 100 * part, 100 * q->value);
    return part <= q->value;
}

/* "as smooth as 0.02 of 1000 pixels that reflect" */
static void say_extreme(const struct question *q, const char *word, float roughness) {
    if (q->shown->count == 0) snprintf(q->reason, q->size, "0 of %" PRIu64 " pixels reflect", q->survey->pixels);
    else
        snprintf(q->reason, q->size, "the %s of %" PRIu64 " reflecting pixels has roughness %.3g", word,
                 q->shown->count, (double)roughness);
}

static void say_limit(const struct question *q, const char *word) {
    const size_t end = strlen(q->reason);
    if (q->shown->count > 0) snprintf(q->reason + end, q->size - end, ", the limit is %s %.3g", word, q->value);
}

static bool smooth(const struct question *q) {
    say_extreme(q, "smoothest", q->shown->roughness[0]);
    say_limit(q, "at most");
    return q->shown->count > 0 && q->shown->roughness[0] <= (float)q->value;
}

static bool rough(const struct question *q) {
    say_extreme(q, "roughest", q->shown->roughness[1]);
    say_limit(q, "at least");
    return q->shown->count > 0 && q->shown->roughness[1] >= (float)q->value;
}

/* A ray of a perfect mirror stands for no cone, so that only finest levels are looked up. */
static bool cones(const struct question *q) {
    say_extreme(q, "roughest", q->shown->roughness[1]);
    if (q->survey->has_transparent) snprintf(q->reason, q->size, "a transparent surface");
    return q->survey->has_transparent || q->shown->roughness[1] > 0;
}

static bool cubemaps(const struct question *q) {
    snprintf(q->reason, q->size, "%u cube map%s", q->survey->cubemaps, q->survey->cubemaps == 1 ? "" : "s");
    return q->survey->cubemaps > 0;
}

static bool volumes(const struct question *q) {
    snprintf(q->reason, q->size, "%u cube map%s with an inner volume", q->survey->volumes,
             q->survey->volumes == 1 ? "" : "s");
    return q->survey->volumes > 0;
}

static bool sky(const struct question *q) {
    snprintf(q->reason, q->size, "%" PRIu64 " of %" PRIu64 " pixels are sky", q->survey->sky, q->survey->pixels);
    return q->survey->sky > 0;
}

/* Whether a distance cube map has texels without a surface. */
static bool cube_sky(const struct question *q) {
    const uint32_t open = glint_survey_faces(q->survey, GLINT_SURVEY_OPEN);
    if (q->survey->looked_at == 0) snprintf(q->reason, q->size, "the cube maps may show the sky");
    else snprintf(q->reason, q->size, "%u of %u cube faces show the sky", open, 6 * q->survey->looked_at);
    return open > 0 || q->survey->looked_at == 0;
}

/* Whether some ray may end in the sky, or is seen through fog that takes its colour. */
static bool sky_seen(const struct question *q) {
    const uint32_t open = glint_survey_faces(q->survey, GLINT_SURVEY_OPEN),
                   sky = glint_survey_faces(q->survey, GLINT_SURVEY_SKY);
    const bool unknown = q->survey->looked_at == 0, seen = q->survey->sky > 0 || unknown || open > 0 || sky > 0;
    if (q->survey->has_fog) snprintf(q->reason, q->size, "fog takes the colour of the sky");
    else if (unknown && q->survey->sky > 0) snprintf(q->reason, q->size, "%" PRIu64 " pixels are sky", q->survey->sky);
    else if (unknown) snprintf(q->reason, q->size, "the cube maps may show the sky");
    else
        snprintf(q->reason, q->size, "%" PRIu64 " pixels and %u of %u cube faces show the sky", q->survey->sky,
                 open > sky ? open : sky, 6 * q->survey->looked_at);
    return seen || q->survey->has_fog;
}

static bool there_is(const struct question *q, bool is, const char *what) {
    snprintf(q->reason, q->size, "%s %s", is ? "a" : "no", what);
    return is;
}

static bool transparent(const struct question *q) {
    return there_is(q, q->survey->has_transparent, "transparent surface");
}
static bool water(const struct question *q) {
    return there_is(q, q->survey->has_water, "water surface");
}
static bool planar(const struct question *q) {
    return there_is(q, q->survey->has_planar, "planar reflection map");
}

static bool history(const struct question *q) {
    snprintf(q->reason, q->size, "%s",
             q->survey->has_history ? "there is a frame before" : "no frame before, or a cut");
    return q->survey->has_history;
}
static bool fresnel(const struct question *q) {
    snprintf(q->reason, q->size, "materials %s how they rise towards grazing angles",
             q->survey->has_fresnel ? "say" : "do not say");
    return q->survey->has_fresnel;
}

static const struct {
    const char *name;
    bool (*holds)(const struct question *q);
    bool has_value, of_parts; /* of_parts: what parts the capture has tells it, without a look at pixels */
} facts[] = {
    {"reflecting", reflecting, false, false},
    {"reflections", reflections, false, false}, /* of whatever surface */
    {"sparse", sparse, true, false},
    {"smooth", smooth, true, false},
    {"rough", rough, true, false},
    {"cones", cones, false, false},
    {"sky", sky, false, false},
    {"cube_sky", cube_sky, false, true},
    {"sky_seen", sky_seen, false, false},
    {"cubemaps", cubemaps, false, true},
    {"volumes", volumes, false, true},
    {"transparent", transparent, false, true},
    {"water", water, false, true},
    {"planar", planar, false, true},
    {"fresnel", fresnel, false, true},
    {"history", history, false, true},
};

/* "rough 0.1" is a fact about a value. */
static bool fact_is(const char *fact, size_t i) {
    const size_t length = strcspn(fact, " ");
    return strlen(facts[i].name) == length && strncmp(facts[i].name, fact, length) == 0 &&
           facts[i].has_value == (fact[length] != 0);
}

bool fact_is_of_parts(const char *fact) {
    for (size_t i = 0; i < sizeof facts / sizeof *facts; i++)
        if (fact_is(fact, i)) return facts[i].of_parts;
    return false;
}

bool fact_is_of_cubemaps(const char *fact) {
    return strcmp(fact, "cube_sky") == 0 || strcmp(fact, "sky_seen") == 0;
}

bool survey_fact(const struct glint_survey *survey, bool shows_all, const char *fact, char *reason, size_t size,
                 bool *known) {
    const size_t length = strcspn(fact, " ");
    const struct question question = {survey, shows_all ? &survey->surfaces : &survey->reflecting,
                                      fact[length] ? strtod(fact + length, NULL) : 0, reason, size};
    for (size_t i = 0; i < sizeof facts / sizeof *facts; i++)
        if (fact_is(fact, i)) {
            *known = true;
            return facts[i].holds(&question);
        }
    *known = false;
    return false;
}

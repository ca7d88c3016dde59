/* Explains one pixel of a run in a few sentences: which tracer ended its ray, where and why, where the colour came from, how far it is
   from what is right, and which single parameter would change that. Everything that is said was recorded or tried. */
#ifndef GLINT_VIEWER_EXPLAIN_H
#define GLINT_VIEWER_EXPLAIN_H

#include <jansson.h>

#include "glint/study.h"
#include "io/progress.h"
#include "options/opened.h"
#include "probe/probe.h"

/* What the pixel is compared with. */
enum explain_goal {
    EXPLAIN_NOTHING, /* it has no ray, or it is right, or nothing is known to compare it with */
    EXPLAIN_RAY,     /* the ray brings another colour than the same ray of the reference tracers */
    EXPLAIN_RESULT   /* the ray is right: the true result at the pixel, and of the pixels around it */
};

/* A single change of the pipeline and the symmetric error with it. */
struct explain_try {
    char change[160]; /* for --set; for --use if it is a variant */
    bool variant;
    char before[48];      /* the value that the run has */
    double error, around; /* around: mean over the pixels around it, for EXPLAIN_RESULT */
};
enum { EXPLAIN_TRIES_MAX = 1000, EXPLAIN_AROUND = 4 /* pixels to each side */ };

struct explain {
    const struct glint_effect *effect;
    const char *run; /* its folder */
    struct probe probe;
    struct opened *opened;
    struct glint_replay_options options; /* as the run was made */
    struct progress *progress;
    bool without_fog; /* compared without fog, which the truth does not have */

    const char *truth; /* "truth", or the folder of a reference; NULL: none is known */
    struct glint_pixels true_pixels;
    float *true_error; /* relative standard error of each of its pixels, or NULL */

    enum explain_goal goal;
    bool within_noise; /* the error is less than twice the standard error of what the pixel is compared with */
    struct explain_try start, best; /* best.change "": no change helps */
    struct explain_try *tries;
    size_t tried, limit; /* of what could be tried at most `limit` */
    bool more;           /* the limit left some untried */
};

/* facts.c: single facts from the records of the probe. The first ray of the pixel stands for all. */
const struct glint_probe_record *explain_record(const struct probe_side *side, const struct glint_pass *pass,
                                                const char *kind, bool last);
/* The i-th pass that ended the ray or passed it on, in order; NULL past the last. *end is its record. */
const struct glint_pass *explain_tracer(const struct probe_side *side, size_t i, const struct glint_probe_record **end);
/* The tracer in which the ray ended, or NULL if the pixel has no ray. */
const struct glint_pass *explain_last_tracer(const struct probe_side *side, const struct glint_probe_record **end);
/* The value of a channel of the capture at the pixel, such as "roughness"; NAN: the capture does not have it. */
double explain_channel(const struct probe_side *side, const char *channel);
/* The value of the effect's result. NULL: there is none. */
const struct probe_value *explain_result(const struct probe_side *side, const struct glint_effect *effect);
/* Radiance of the image with this role. NULL: there is none. */
const struct probe_value *explain_radiance(const struct probe_side *side, enum glint_pass_role role);
/* Whether two ends are the same place: of the same kind, and within 5 % of the distance. */
bool explain_same_end(const struct probe_side *a, const struct probe_side *b);

/* tries.c */
/* Three channels of a pixel; of an image with fewer its first one three times. */
void explain_triple(const struct glint_pixels *pixels, size_t at, double triple[3]);
double explain_error(const double *found, const double *right);
/* Compares the pixel with what is right, decides the goal, and tries single changes. */
bool explain_find(struct explain *explain, struct glint_error *err);

/* text.c: the sentences, as an array of texts; the caller releases it. */
json_t *explain_sentences(const struct explain *explain);
json_t *explain_json(const struct explain *explain, json_t *sentences);

#endif

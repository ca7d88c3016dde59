/* --against: compares a run with the truth in the capture, the preset `reference`, or both. */
#ifndef GLINT_VIEWER_AGAINST_H
#define GLINT_VIEWER_AGAINST_H

#include <argp.h>
#include <jansson.h>

#include "glint/reference.h"
#include "options/effect_args.h"
#include "options/metric_args.h"

struct against {
    const char *name;                                /* of --effect, or NULL */
    const struct glint_effect *effects[EFFECTS_MAX]; /* that are compared, one after the other */
    size_t effect_count;
    bool truth, reference;
    bool all;                /* the reference runs every pass too */
    glint_progress progress; /* for the replay of the reference */
    void *user;
    const char *run;                     /* run folder of the reference; NULL: the reference is replayed */
    struct glint_metric_options metrics; /* those of METRIC_OPTIONS */
    struct glint_device *device;
    struct glint_pipeline *pipeline;
    struct glint_replay
        *replay; /* its own, so that the history of the run it is compared with stays; NULL until it is needed */
};

/* Reads "truth", "reference", "reference=RUN", "both" or "both=RUN". */
void against_parse(struct against *against, char *text, struct argp_state *state);
/* Opens the run that holds the reference, if there is one, before any work. *without_fog: what is compared with has no fog, as the truth. */
bool against_prepare(const struct against *against, bool *without_fog, struct glint_error *err);
/* The images that are compared, NULL-terminated, in `names`, which has room for those of all effects. */
const char *const *against_results(const struct against *against, const char *names[]);
/* Finds the effects, and makes ready for runs of `pipeline`; does nothing when there is nothing to compare with. */
bool against_begin(struct against *against, struct glint_device *device, const struct glint_pipeline *pipeline,
                   const struct list *captures, struct glint_error *err);
void against_finish(struct against *against);

/* With a reference as well as a truth their images say what an error comes from: what a run is off the reference is its
   algorithms' error, and what the reference is off the truth is information that the capture's data lack. */
struct comparison {
    const struct glint_effect *effect;
    const char *unit;      /* of its result */
    bool several;          /* of several that are compared */
    bool truth, reference; /* what the run is compared with */
    bool has_rays, has_image, jittered;
    struct glint_trace_table rays;
    struct glint_metric_table to_truth, to_reference;
    /* Of each pixel: the mean of |found - true| over the channels; 0 where the effect is not judged. NULL: not compared. */
    struct glint_pixels truth_error, reference_error;
    struct glint_image_errors missing;
    bool other_capture;  /* the run that holds the reference was made from another one, as a frame of its shot */
    char no_image[1024]; /* why, when there is none */
    /* Where both have the light of the first class from, after a run with diagnostics: glint_classes_cross. */
    struct glint_classes found_source, reference_source;
    uint64_t *sources;
};
/* Compares the result of effect number `effect`. Call after a run. Release with comparison_finish even after a failure. */
bool against_compare(struct against *against, size_t effect, struct glint_replay *replay, struct glint_capture *capture,
                     const struct glint_pipeline *pipeline, struct comparison *comparison, struct glint_error *err);
void against_print(const struct comparison *comparison);
/* Adds "against_truth", "against_reference", "missing_information" to what is said of a run; if several effects are compared, to the object
   "effects.NAME" in it. */
void against_json(const struct comparison *comparison, json_t *run);
/* Adds the images of errors to the run that was compared: `error` and `flip` of the truth, `reference_error` and `reference_flip`. If
   several effects are compared, EFFECT_ precedes the names. */
bool against_write_images(const struct comparison *comparisons, size_t count, const char *folder,
                          struct glint_error *err);
/* False when one of the images contains NaN or infinite pixels: reports how many, and the first. */
bool against_valid(const struct comparison *comparison, const char *capture, struct glint_error *err);
void comparison_finish(struct comparison *comparison);

#endif

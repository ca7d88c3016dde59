/* --effect: which effect's result a command judges. */
#ifndef GLINT_VIEWER_EFFECT_ARGS_H
#define GLINT_VIEWER_EFFECT_ARGS_H

#include "command.h"
#include "glint/study.h"
#include "options/args.h"

enum { KEY_EFFECT = 832, EFFECTS_MAX = 16 };

/* clang-format off */
#define EFFECT_OPTION_(default_) \
    {"effect", KEY_EFFECT, "EFFECT", 0, "Effect whose result is judged, of those that glint passes lists (default: " default_ " that the pipeline makes and that can be judged)", 0}
/* Of commands that judge one effect, and of those that judge several, one after the other. */
#define EFFECT_OPTION EFFECT_OPTION_("the first")
#define EFFECTS_OPTION EFFECT_OPTION_("all")
/* clang-format on */

/* What decides which effects can be judged. */
struct effect_search {
    const char *name;                              /* that of --effect, or NULL */
    const struct glint_pipeline *const *pipelines; /* an effect counts if one of them makes its result */
    size_t pipeline_count;
    bool reference;            /* … and the preset `reference` makes it, */
    const struct list *truths; /* or one of these captures holds its truth. NULL and false: anything counts */
};
/* Finds the effects in the order of glint_effects(): that of the name, which a pipeline has to make, or all that can be judged; if there are
   none, those that are made, or else the first of all, whose lack is then reported where it is missed. 0 on failure. */
size_t effects_find(const struct effect_search *search, const struct glint_effect *found[EFFECTS_MAX],
                    struct glint_error *err);
/* The first of them, for one pipeline. A note says which it is if there are several. NULL on failure. */
const struct glint_effect *effect_find(const struct command *command, const char *name,
                                       const struct glint_pipeline *pipeline, bool reference, const struct list *truths,
                                       struct glint_error *err);
/* The effect of that name, or the first of those whose result the run holds; the first of all if it holds none. NULL if there is none of
   that name. */
const struct glint_effect *effect_of_run(const char *name, const struct glint_run *run, struct glint_error *err);

#endif

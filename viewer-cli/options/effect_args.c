/* --effect: which effect's result a command judges. */
#include "options/effect_args.h"

#include <stdio.h>
#include <string.h>

#include "nearest.h"

static const struct glint_effect *named(const char *name, struct glint_error *err) {
    size_t count;
    const struct glint_effect *all = glint_effects(&count), *effect = glint_effect_find(name);
    struct glint_nearest near = glint_nearest_to(name);
    for (size_t i = 0; i < count; i++) glint_nearest_offer(&near, all[i].name);
    if (!effect) glint_fail(err, GLINT_ERROR_USAGE, "there is no effect %s%s", name, glint_nearest_or_known(&near));
    return effect;
}

static bool is_made(const struct effect_search *search, const struct glint_effect *effect) {
    for (size_t p = 0; p < search->pipeline_count; p++)
        if (glint_study_made(search->pipelines[p], effect)) return true;
    return search->pipeline_count == 0;
}

/* Whether the capture holds the truth of the effect, as one of the pipelines estimates it. */
static bool holds_truth(const struct effect_search *search, const struct glint_effect *effect,
                        const struct glint_capture *capture) {
    char part[96];
    for (size_t p = 0; p < search->pipeline_count; p++) {
        glint_study_truth_part(effect, search->pipelines[p], part);
        if (glint_capture_find(capture, part)) return true;
    }
    return false;
}

/* Marks the effects whose truth one of the captures holds. What cannot be opened here, or is read only once from a pipe, counts for the first
   effect, whose replay reports what is wrong with it. */
static void judge_by_truths(const struct effect_search *search, const struct glint_effect *const effects[],
                            size_t count, bool judged[]) {
    for (size_t c = 0; c < search->truths->count; c++) {
        const char *path = search->truths->items[c];
        struct glint_capture *capture = strcmp(path, "-") != 0 ? glint_capture_open(path, NULL, NULL) : NULL;
        if (!capture) judged[0] = true;
        for (size_t e = 0; capture && e < count; e++) judged[e] |= holds_truth(search, effects[e], capture);
        glint_capture_close(&capture);
    }
}

size_t effects_find(const struct effect_search *search, const struct glint_effect *found[EFFECTS_MAX],
                    struct glint_error *err) {
    size_t all, made = 0, kept = 0;
    bool judged[EFFECTS_MAX];
    const struct glint_effect *effects = glint_effects_by_default(&all);
    if (search->name) {
        if (!(found[0] = named(search->name, err))) return 0;
        if (found[0]->no_truth && (search->truths || search->reference))
            return glint_fail(err, GLINT_ERROR_USAGE, "--effect %s: it has neither a truth nor a reference: %s",
                              search->name, found[0]->no_truth);
        return is_made(search, found[0]) ||
               glint_fail(err, GLINT_ERROR_USAGE, "--effect %s: no slot of the pipeline makes the %s", search->name,
                          found[0]->noun);
    }
    for (size_t e = 0; e < all && made < EFFECTS_MAX; e++)
        if (is_made(search, &effects[e])) found[made++] = &effects[e];
    if (made == 0) found[made++] = effects;
    if (made == 1) return made;
    struct glint_pipeline *reference = search->reference ? glint_pipeline_create("reference", err) : NULL;
    if (search->reference && !reference) return 0;
    for (size_t e = 0; e < made; e++)
        judged[e] = reference ? glint_study_made(reference, found[e]) != NULL : !search->truths;
    if (search->truths) judge_by_truths(search, found, made, judged);
    for (size_t e = 0; e < made; e++)
        if (judged[e]) found[kept++] = found[e];
    if (reference) glint_pipeline_destroy(&reference);
    return kept ? kept : made;
}

const struct glint_effect *effect_find(const struct command *command, const char *name,
                                       const struct glint_pipeline *pipeline, bool reference, const struct list *truths,
                                       struct glint_error *err) {
    const struct effect_search search = {name, &pipeline, 1, reference, truths};
    const struct glint_effect *found[EFFECTS_MAX];
    const size_t count = effects_find(&search, found, err);
    char others[256] = "";
    if (!count) return NULL;
    for (size_t e = 1; e < count; e++) {
        const size_t length = strlen(others);
        snprintf(others + length, sizeof others - length, "%s%s", length ? ", " : "", found[e]->name);
    }
    if (count > 1) command_note(command, "judges the effect %s; --effect chooses another: %s", found[0]->name, others);
    return found[0];
}

const struct glint_effect *effect_of_run(const char *name, const struct glint_run *run, struct glint_error *err) {
    size_t count;
    const struct glint_effect *effects = glint_effects_by_default(&count);
    if (name) return named(name, err);
    for (size_t e = 0; e < count; e++)
        if (glint_study_run_result_image(run, &effects[e])) return &effects[e];
    return effects;
}

/* Whether two pipelines make the same result of an effect. */
#include "glint/study.h"

#include <string.h>

enum { PASSES_MAX = 64 };

static bool depends(const void *pipeline, size_t later, size_t earlier) {
    return glint_pass_depends(glint_pipeline_pass(pipeline, later), glint_pipeline_pass(pipeline, earlier));
}

/* Marks the passes on which the result depends; false if no pass makes it. */
static bool mark(const struct glint_pipeline *pipeline, const struct glint_effect *effect, bool marked[PASSES_MAX]) {
    const size_t count = glint_pipeline_pass_count(pipeline);
    const struct glint_row *result = glint_study_made(pipeline, effect);
    if (!result || count > PASSES_MAX) return false;
    for (size_t i = 0; i < count; i++)
        marked[i] = glint_pass_output(glint_pipeline_pass(pipeline, i), result->name) != NULL;
    glint_passes_mark_needed(marked, count, depends, pipeline);
    return true;
}

static bool same_pass(const struct glint_pipeline *a, const struct glint_pipeline *b, const struct glint_pass *pass) {
    if (glint_pipeline_find(b, pass->slot) != pass) return false;
    const char *own = glint_pipeline_shader_file(a, pass), *other = glint_pipeline_shader_file(b, pass);
    if (own || other) return own && other && !strcmp(own, other);
    for (size_t r = 0; r < pass->row_count; r++)
        if (glint_row_is_parameter(&pass->rows[r]) &&
            glint_pipeline_value(a, pass, &pass->rows[r]) != glint_pipeline_value(b, pass, &pass->rows[r]))
            return false;
    return true;
}

bool glint_study_same(const struct glint_pipeline *a, const struct glint_pipeline *b,
                      const struct glint_effect *effect) {
    const struct glint_pipeline *const pipelines[] = {a, b};
    bool marked[2][PASSES_MAX] = {{false}};
    if (!mark(a, effect, marked[0]) || !mark(b, effect, marked[1])) return false;
    if (glint_pipeline_rays(a) != glint_pipeline_rays(b)) return false;
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < glint_pipeline_pass_count(pipelines[k]); i++)
            if (marked[k][i] && !same_pass(pipelines[k], pipelines[!k], glint_pipeline_pass(pipelines[k], i)))
                return false;
    return true;
}

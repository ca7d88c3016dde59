/* Compares a planned run with one that ran all passes: which images the plan skips, and at which texels it traces no ray. */
#include <stdlib.h>
#include <string.h>

#include "diff/diff.h"
#include "glint/passes.h"
#include "report/report.h"

/* The side that was planned if the other ran all passes; -1: neither, or both. */
static int planned_side(const struct diff *diff) {
    bool all[2];
    for (int k = 0; k < 2; k++) {
        if (!diff->sides[k].json) return -1;
        all[k] = json_is_true(json_object_get(diff->sides[k].json, "all"));
    }
    return all[0] == all[1] ? -1 : all[0];
}

/* The declaration of a run's image; NULL for coarser levels and unknown passes. */
static const struct glint_row *row_of(const struct diff_image *image) {
    const struct glint_pass *pass = glint_pass_find(image->slot, image->variant);
    for (size_t r = 0; pass && r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        if ((row->kind == GLINT_ROW_WRITE || row->kind == GLINT_ROW_DIAGNOSTIC) && !strcmp(row->name, image->name))
            return row;
    }
    return NULL;
}

/* A plan skips passes and unused outputs of other passes; a run of all passes processes no tile lists. */
bool diff_is_planned_out(const struct diff *diff, const struct diff_pair *pair) {
    if (diff->planned < 0 || (pair->a && pair->b)) return false;
    const struct diff_image *image = diff_pair_image(pair);
    const struct diff_side *without = &diff->sides[pair->a ? 1 : 0];
    const struct glint_row *row = row_of(image);
    const json_t *pass = report_pass(without->json, image->slot);
    const char *reason = json_string_value(json_object_get(pass, "reason"));
    if (!reason || !strcmp(reason, GLINT_REASON_NOT_ASKED) || !strcmp(reason, GLINT_REASON_SKIPPED)) return false;
    if (without != &diff->sides[diff->planned]) return row && row->size == GLINT_SIZE_LIST;
    bool others = !json_is_true(json_object_get(pass, "ran"));
    for (size_t i = 0; i < without->count; i++) others |= !strcmp(without->images[i].slot, image->slot);
    return others;
}

/* The normals of the rays, as declared by passes that trace rays; NULL: the run has none. */
static const struct diff_image *find_ray_normals(const struct diff_side *side) {
    size_t count;
    const struct glint_pass *passes = glint_passes(&count);
    for (size_t p = 0; p < count; p++)
        for (size_t r = 0; r < passes[p].row_count; r++) {
            const struct glint_row *row = &passes[p].rows[r];
            const struct diff_image *normals =
                row->kind == GLINT_ROW_ALONG_RAYS ? diff_side_image(side, row->image) : NULL;
            if (normals && normals->channel_count >= 3) return normals;
        }
    return NULL;
}

/* A plan may skip texels of rays only; every pixel of the final image counts. */
static bool is_ray_image(const struct diff_image *image) {
    const struct glint_row *row = row_of(image);
    return row && row->size == GLINT_SIZE_HALF;
}

static float *read_normals(struct diff_side *side, const struct diff_image *image, struct glint_error *err) {
    float *normals = malloc((size_t)image->width * image->height * 3 * sizeof *normals);
    if (!normals) glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    else if (!diff_side_read(side, image, image->channels, 3, false, normals, err)) free(normals), normals = NULL;
    return normals;
}

static bool is_ray(const float normal[3]) {
    return normal[0] != 0 || normal[1] != 0 || normal[2] != 0;
}

bool diff_planned_begin(struct diff *diff, struct glint_error *err) {
    diff->planned = planned_side(diff);
    if (diff->planned < 0) return true;
    struct diff_side *sides[2] = {&diff->sides[diff->planned], &diff->sides[1 - diff->planned]};
    const struct diff_image *own = find_ray_normals(sides[0]),
                            *other = own ? diff_side_image(sides[1], own->name) : NULL;
    if (!other || own->width != other->width || own->height != other->height) return true;
    const size_t texels = (size_t)own->width * own->height;
    float *normals[2] = {read_normals(sides[0], own, err), NULL};
    if (normals[0]) normals[1] = read_normals(sides[1], other, err);
    bool ok = normals[1] && ((diff->rayless = calloc(texels, sizeof *diff->rayless)) ||
                             glint_fail(err, GLINT_ERROR_MEMORY, "out of memory"));
    diff->rays_width = own->width, diff->rays_height = own->height;
    for (size_t i = 0; ok && i < texels; i++) {
        diff->rayless[i] = !is_ray(&normals[0][3 * i]) && is_ray(&normals[1][3 * i]);
        diff->rayless_count += diff->rayless[i];
    }
    free(normals[0]), free(normals[1]);
    return ok;
}

void diff_planned_skip(const struct diff *diff, const struct diff_pair *pair, size_t count, const uint32_t *a,
                       uint32_t *b) {
    if (!diff->rayless || pair->a->width != diff->rays_width || pair->a->height != diff->rays_height ||
        !is_ray_image(pair->a))
        return;
    const size_t texels = (size_t)diff->rays_width * diff->rays_height;
    for (size_t i = 0; i < texels; i++)
        if (diff->rayless[i]) memcpy(&b[i * count], &a[i * count], count * sizeof *b);
}

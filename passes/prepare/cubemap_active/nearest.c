/* Chooses the active cube maps around the player and the order in which each start tries the others. */
#include <math.h>
#include <string.h>

#include "glint/passes.h"

enum { MOST_ACTIVE = 16 };

/* Squared distance with the part along up scaled. */
static double distance2(const double a[3], const double b[3], int up, double vertical) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        double d = (a[i] - b[i]) * (i == up ? vertical : 1);
        sum += d * d;
    }
    return sum;
}

static int up_component(enum glint_axis up) {
    switch (up) {
    case GLINT_AXIS_X:
    case GLINT_AXIS_NEG_X:
        return 0;
    case GLINT_AXIS_Z:
    case GLINT_AXIS_NEG_Z:
        return 2;
    default:
        return 1;
    }
}

/* The nearest `count` of the capture's cube maps, nearest first; ties go to the lower number. */
static size_t nearest(const struct glint_host_context *context, size_t count, size_t active[MOST_ACTIVE]) {
    const struct glint_frame *frame = context->frame;
    const double *player = frame->has_player ? frame->player : context->eye;
    double vertical = context->value(context, "vertical_penalty");
    double distances[MOST_ACTIVE];
    size_t used = 0;
    for (size_t i = 0; i < context->cubemap_count; ++i) {
        double d = distance2(context->cubemaps[i].center, player, up_component(frame->up), vertical);
        size_t place = used;
        while (place > 0 && d < distances[place - 1]) --place;
        if (place >= count) continue;
        for (size_t k = used < count ? used++ : count - 1; k > place; --k) {
            distances[k] = distances[k - 1];
            active[k] = active[k - 1];
        }
        distances[place] = d;
        active[place] = i;
    }
    return used;
}

/* When all active ones are indoors, the nearest outdoor one takes the last place. */
static void force_outdoor(const struct glint_host_context *context, size_t *active, size_t count) {
    for (size_t i = 0; i < count; ++i)
        if (context->cubemaps[active[i]].outdoor) return;
    const struct glint_frame *frame = context->frame;
    const double *player = frame->has_player ? frame->player : context->eye;
    double vertical = context->value(context, "vertical_penalty"), best = INFINITY;
    for (size_t i = 0; i < context->cubemap_count; ++i) {
        if (!context->cubemaps[i].outdoor) continue;
        double d = distance2(context->cubemaps[i].center, player, up_component(frame->up), vertical);
        if (d < best) {
            best = d;
            active[count - 1] = i;
        }
    }
}

/* Places in the order in which a ray that starts in cube map `start` tries them: itself, then by distance to its
 * centre. */
static void chain_from(const struct glint_host_context *context, const size_t *active, size_t count, size_t start,
                       uint32_t *chain, size_t length) {
    bool taken[MOST_ACTIVE] = {false};
    for (size_t k = 0; k < length; ++k) {
        size_t best = start;
        double best_distance = INFINITY;
        for (size_t i = 0; k > 0 && i < count; ++i) {
            double d = distance2(context->cubemaps[active[i]].center, context->cubemaps[active[start]].center, 0, 1);
            if (taken[i] || !(d < best_distance)) continue;
            best_distance = d;
            best = i;
        }
        taken[best] = true;
        chain[k] = (uint32_t)best;
    }
}

/* A box as the planes of its faces. */
static uint32_t volume_planes(const struct glint_cubemap *cubemap, double planes[GLINT_MAX_PLANES][4]) {
    memset(planes, 0, sizeof cubemap->planes);
    if (cubemap->inner == GLINT_VOLUME_BOX)
        for (size_t k = 0; k < 3; ++k) {
            planes[2 * k][k] = -1;
            planes[2 * k][3] = cubemap->box_min[k];
            planes[2 * k + 1][k] = 1;
            planes[2 * k + 1][3] = -cubemap->box_max[k];
        }
    if (cubemap->inner != GLINT_VOLUME_HULL) return cubemap->inner == GLINT_VOLUME_BOX ? 6 : 0;
    memcpy(planes, cubemap->planes, sizeof cubemap->planes);
    return cubemap->plane_count < GLINT_MAX_PLANES ? cubemap->plane_count : GLINT_MAX_PLANES;
}

static uint32_t volume_texels(const struct glint_cubemap *cubemap) {
    double planes[GLINT_MAX_PLANES][4];
    return 1 + volume_planes(cubemap, planes) + (cubemap->inner == GLINT_VOLUME_SPHERE);
}

/* One row of active_volume: head, planes with unit normals, sphere. */
static void fill_volume(const struct glint_cubemap *cubemap, const double eye[3], double metres, float *row) {
    double planes[GLINT_MAX_PLANES][4], center[3];
    uint32_t count = volume_planes(cubemap, planes);
    for (size_t k = 0; k < 3; ++k) center[k] = cubemap->center[k] - eye[k];
    row[0] = (float)count;
    row[1] = cubemap->inner == GLINT_VOLUME_SPHERE;
    for (uint32_t i = 0; i < count; ++i) {
        const double *n = planes[i];
        double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        double offset = n[3] - (n[0] * center[0] + n[1] * center[1] + n[2] * center[2]);
        for (size_t k = 0; k < 3; ++k) row[4 * (1 + i) + k] = (float)(n[k] / length);
        row[4 * (1 + i) + 3] = (float)(offset / length * metres);
    }
    if (cubemap->inner != GLINT_VOLUME_SPHERE) return;
    for (size_t k = 0; k < 3; ++k) row[4 + k] = (float)((cubemap->sphere_center[k] + center[k]) * metres);
    row[7] = (float)(cubemap->sphere_radius * metres);
}

bool glint_host_cubemap_active_nearest(struct glint_host_context *context, struct glint_error *err) {
    if (context->cubemap_count == 0)
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "cubemap_active/nearest: no cube map in the capture, expected at least one");
    size_t limit = (size_t)context->value(context, "count"), active[MOST_ACTIVE] = {0};
    size_t count = nearest(context, limit < MOST_ACTIVE ? limit : MOST_ACTIVE, active);
    if (context->value(context, "force_outdoor") != 0) force_outdoor(context, active, count);
    size_t chain = (size_t)context->value(context, "chain");
    if (chain > count) chain = count;

    uint32_t width = (uint32_t)count;
    struct glint_table *index = context->table(context, "active_index", width, 1, err);
    struct glint_table *center = index ? context->table(context, "active_center", width, 1, err) : NULL;
    struct glint_table *chains = center ? context->table(context, "active_chain", (uint32_t)chain, width, err) : NULL;
    uint32_t texels = 1;
    for (size_t i = 0; i < count; ++i) {
        uint32_t own = volume_texels(&context->cubemaps[active[i]]);
        if (own > texels) texels = own;
    }
    struct glint_table *volume = chains ? context->table(context, "active_volume", texels, width, err) : NULL;
    if (!volume) return false;
    double metres = context->frame->metres_per_unit > 0 ? context->frame->metres_per_unit : 1;
    for (size_t i = 0; i < count; ++i) {
        const struct glint_cubemap *cubemap = &context->cubemaps[active[i]];
        index->texels.u[i] = (uint32_t)active[i];
        for (size_t k = 0; k < 3; ++k)
            center->texels.f[4 * i + k] = (float)((cubemap->center[k] - context->eye[k]) * metres);
        center->texels.f[4 * i + 3] = (float)(cubemap->fade > 0 ? cubemap->fade : 1);
        fill_volume(cubemap, context->eye, metres, &volume->texels.f[4 * i * texels]);
        chain_from(context, active, count, i, &chains->texels.u[chain * i], chain);
    }
    return true;
}

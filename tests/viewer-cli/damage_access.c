/* Access to the data that mistakes change. */
#include "damage_internal.h"

#include <stdlib.h>
#include <string.h>

#include "unit.h"

size_t damage_texels_of(struct rewrite *r, const char *part) {
    const struct rewrite_part *p = rewrite_find(r, part);
    return (size_t)p->part.width * p->part.height;
}

/* Converts a channel to floats in storage; NULL if there is none. */
float *damage_floats(struct rewrite *r, const char *part, const char *channel) {
    struct rewrite_part *p = rewrite_find(r, part);
    struct glint_error err = {0};
    for (size_t c = 0; c < p->part.channel_count; c++) {
        if (strcmp(p->channels[c].name, channel)) continue;
        if (p->channels[c].stored != GLINT_STORED_FLOAT &&
            !glint_exr_read(r->exr, (size_t)(p - r->parts), &channel, 1, GLINT_F32, p->data[c], 0, &err))
            fail_msg("%s", err.message);
        p->channels[c].stored = GLINT_STORED_FLOAT;
        return p->data[c];
    }
    return NULL;
}

bool damage_swap(struct rewrite *r, const char *a, const char *b, const char *channel) {
    float *of[2] = {damage_floats(r, a, channel), damage_floats(r, b, channel)};
    for (size_t i = 0; i < damage_texels_of(r, a); i++) {
        const float t = of[0][i];
        of[0][i] = of[1][i];
        of[1][i] = t;
    }
    return true;
}

bool damage_is_cube(const struct rewrite_part *p) {
    return !strncmp(p->name, "cubemap.", 8);
}

const double *damage_matrix(struct rewrite *r, const char *name) {
    return rewrite_attribute(r, "gbuffer", name)->numbers;
}

void damage_set_matrix(struct rewrite *r, const char *name, const double m[16]) {
    static double kept[4][16];
    static int next;
    double *to = kept[next++ % 4];
    memcpy(to, m, sizeof kept[0]);
    rewrite_attribute(r, "gbuffer", name)->numbers = to;
}

void damage_set_text(struct rewrite *r, const char *name, const char *value) {
    damage_set_text_of(r, "gbuffer", name, value);
}

void damage_set_text_of(struct rewrite *r, const char *part, const char *name, const char *value) {
    struct rewrite_part *g = rewrite_find(r, part);
    size_t i = 0;
    while (i < g->part.attribute_count && strcmp(g->attributes[i].name, name)) i++;
    g->part.attribute_count += i == g->part.attribute_count;
    g->attributes[i] =
        (struct glint_exr_attribute){.name = name, .type = GLINT_EXR_STRING, .type_name = "string", .string = value};
}

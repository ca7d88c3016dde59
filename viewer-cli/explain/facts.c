/* Single facts from the records of a probed pixel. */
#include <math.h>
#include <string.h>

#include "explain/explain.h"

static uint32_t first_ray(const struct probe_side *side) {
    for (size_t i = 0; i < side->trace.count; i++)
        if (glint_probe_is(&side->trace.records[i], "screen_end") ||
            glint_probe_is(&side->trace.records[i], "cubemap_end"))
            return side->trace.records[i].ray;
    return side->trace.count ? side->trace.records[0].ray : 0;
}

const struct glint_probe_record *explain_record(const struct probe_side *side, const struct glint_pass *pass,
                                                const char *kind, bool last) {
    const struct glint_probe_record *found = NULL;
    const uint32_t ray = first_ray(side);
    for (size_t i = 0; i < side->trace.count && (last || !found); i++) {
        const struct glint_probe_record *record = &side->trace.records[i];
        if (record->ray == ray && (!pass || record->pass == pass) && glint_probe_is(record, kind)) found = record;
    }
    return found;
}

static const struct glint_probe_record *end_of(const struct probe_side *side, const struct glint_pass *pass) {
    const struct glint_probe_record *end = explain_record(side, pass, "screen_end", true);
    if (!end) end = explain_record(side, pass, "cubemap_end", true);
    return end && glint_probe_value(end, "end") > 0 ? end : NULL;
}

/* Water and glass trace rays of their own, whose slots have a prefix; these are about the opaque surface. */
static bool is_tracer(const struct glint_pass *pass) {
    return glint_pass_role(pass, GLINT_ROLE_SCREEN_END) || glint_pass_role(pass, GLINT_ROLE_CUBEMAP_END);
}

const struct glint_pass *explain_tracer(const struct probe_side *side, size_t i,
                                        const struct glint_probe_record **end) {
    for (size_t p = 0; p < side->pass_count; p++) {
        const struct glint_pass *pass = side->passes[p].pass;
        *end = side->passes[p].shown && is_tracer(pass) ? end_of(side, pass) : NULL;
        if (!*end) continue;
        if (i-- == 0) return pass;
        if (glint_probe_is(*end, "screen_end") && glint_probe_value(*end, "finished") > 0) break;
    }
    *end = NULL;
    return NULL;
}

const struct glint_pass *explain_last_tracer(const struct probe_side *side, const struct glint_probe_record **end) {
    const struct glint_pass *last = NULL, *pass;
    const struct glint_probe_record *of = NULL;
    *end = NULL;
    for (size_t i = 0; (pass = explain_tracer(side, i, &of)); i++) last = pass, *end = of;
    return last;
}

double explain_channel(const struct probe_side *side, const char *channel) {
    for (size_t i = 0; i < side->value_count; i++) {
        const struct probe_value *value = &side->values[i];
        if (value->pass || !value->row->source) continue;
        const char *name = value->row->source; /* "normal.X normal.Y normal.Z material.roughness" */
        for (uint32_t c = 0; c < value->count && *name; c++) {
            const size_t length = strcspn(name, " "), part = strcspn(name, ".") + 1;
            if (part < length && length - part == strlen(channel) && !strncmp(name + part, channel, length - part))
                return value->values[c];
            name += length + (name[length] == ' ');
        }
    }
    return NAN;
}

static const struct probe_value *value_of(const struct probe_side *side, const char *image, uint32_t components) {
    for (size_t i = side->value_count; image && i-- > 0;)
        if (side->values[i].pass && side->values[i].count >= components && !strcmp(side->values[i].row->name, image))
            return &side->values[i];
    return NULL;
}

const struct probe_value *explain_result(const struct probe_side *side, const struct glint_effect *effect) {
    const struct probe_value *value = NULL;
    for (size_t k = 0; !value && k < GLINT_EFFECT_RESULTS && effect->results[k]; k++) {
        value = value_of(side, effect->results[k], 1);
        if (value && value->row->size != GLINT_SIZE_FULL) value = NULL;
    }
    return value;
}

const struct probe_value *explain_radiance(const struct probe_side *side, enum glint_pass_role role) {
    const char *image = NULL;
    for (size_t p = 0; p < side->pass_count; p++) {
        const struct glint_row *row = side->passes[p].shown ? glint_pass_role(side->passes[p].pass, role) : NULL;
        if (row) image = row->image;
    }
    return value_of(side, image, 3);
}

bool explain_same_end(const struct probe_side *a, const struct probe_side *b) {
    const struct glint_probe_record *ends[2];
    const struct glint_pass *tracers[2] = {explain_last_tracer(a, &ends[0]), explain_last_tracer(b, &ends[1])};
    if (!tracers[0] || !tracers[1]) return tracers[0] == tracers[1];
    if (strcmp(tracers[0]->slot, tracers[1]->slot) != 0) return false;
    const double m[2] = {(double)glint_probe_value(ends[0], "travelled_m"),
                         (double)glint_probe_value(ends[1], "travelled_m")};
    if (!isfinite(m[0]) || !isfinite(m[1])) return isfinite(m[0]) == isfinite(m[1]);
    return fabs(m[0] - m[1]) <= 0.05 * fmax(fabs(m[0]), fabs(m[1]));
}

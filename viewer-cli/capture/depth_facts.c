/* Computes the resolution of the depth storage at several distances. */
#include "capture/depth_facts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "options/args.h"

struct depth_facts depth_facts(const struct glint_capture *capture) {
    static const double at_m[DEPTH_PLACES] = {1, 10, 100};
    const struct glint_part_info *part = glint_capture_find(capture, "gbuffer");
    struct depth_facts f = {.encoding = glint_encoding_name("depth", (int)part->encodings.depth), .storage = ""};
    for (size_t i = 0; i < part->channel_count; i++)
        if (!strcmp(part->channels[i].name, "depth.Z")) f.storage = part->channels[i].storage;
    for (int i = 0; i < DEPTH_PLACES; i++) {
        f.at_m[i] = at_m[i];
        f.step_m[i] = glint_depth_step(capture, part, at_m[i]);
    }
    return f;
}

static void length_text(double m, char *text, size_t size) {
    static const struct {
        double from, scale;
        const char *unit;
    } units[] = {{1, 1, "m"}, {1e-2, 1e2, "cm"}, {1e-3, 1e3, "mm"}, {0, 1e6, "µm"}};
    size_t i = 0;
    while (m < units[i].from) i++;
    snprintf(text, size, "%.2g %s", m * units[i].scale, units[i].unit);
    if (m >= 99.5) snprintf(text, size, "%.0f m", m); /* no exponents */
}

void depth_steps_text(const struct depth_facts *f, char *text, size_t size) {
    size_t length = 0;
    text[0] = '\0';
    for (int i = 0; i < DEPTH_PLACES; i++) {
        char step[32] = "out of range";
        if (isinf(f->step_m[i])) snprintf(step, sizeof step, "not distinct from sky");
        else if (!isnan(f->step_m[i])) length_text(f->step_m[i], step, sizeof step);
        const int n = snprintf(text + length, size - length, "%s%s at %g m", i ? ", " : "", step, f->at_m[i]);
        if (n > 0 && (size_t)n < size - length) length += (size_t)n;
    }
}

json_t *depth_facts_json(const struct depth_facts *f) {
    json_t *steps = json_array();
    for (int i = 0; i < DEPTH_PLACES; i++)
        json_array_append_new(steps, json_pack("{sf so}", "at_m", f->at_m[i], "step_m", json_number(f->step_m[i])));
    return json_pack("{ss ss so}", "storage", f->storage, "encoding", f->encoding, "steps", steps);
}

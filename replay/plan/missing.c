/* What a plan's passes would read and the capture does not have. */
#include <string.h>

#include "planner.h"

static bool is_of_role(const char *part, const char *role) {
    const size_t length = strlen(role);
    return strncmp(part, role, length) == 0 && (!part[length] || part[length] == '.');
}

static bool has_channels(const struct glint_part_info *part, const char *channels) {
    for (size_t c = 0; c < part->channel_count; c++)
        if (strncmp(part->channels[c].name, channels, strlen(channels)) == 0) return true;
    return false;
}

/* The capture's parts of a role, and how many of them have channels that begin so. */
static size_t count_parts(const struct glint_capture *capture, const char *role, const char *channels, size_t *having) {
    size_t parts = 0;
    *having = 0;
    for (size_t i = 0; i < glint_capture_part_count(capture); i++) {
        const struct glint_part_info *part = glint_capture_part(capture, i);
        if (!is_of_role(part->name, role)) continue;
        parts++;
        *having += has_channels(part, channels);
    }
    return parts;
}

bool glint_capture_lacks(const struct glint_capture *capture, const struct glint_absence *absence) {
    size_t having;
    if (absence->other && absence->beside != (count_parts(capture, absence->other, "", &having) > 0)) return false;
    const size_t parts = count_parts(capture, absence->role, absence->channels, &having);
    return absence->channels[0] ? having < parts : parts == 0;
}

/* Whether any pass says what it does without an image. */
static bool is_declared(const char *image) {
    size_t count;
    const struct glint_pass *all = glint_passes(&count);
    for (size_t i = 0; i < count; i++)
        if (glint_pass_row(&all[i], GLINT_ROW_WITHOUT, image)) return true;
    return false;
}

/* Where passes say what they do without an image, it matters to these alone: others bind it because their slot does. */
static bool matters(const struct graph *graph, const struct glint_row *image) {
    bool declared = false;
    for (size_t p = 0; p < graph->pass_count; p++)
        declared |= graph->passes[p].runs && glint_pass_row(graph->passes[p].pass, GLINT_ROW_WITHOUT, image->name);
    return declared || !is_declared(image->name);
}

static bool is_read(const struct graph *graph, const struct glint_absence *absence) {
    for (size_t i = 0; i < graph->image_count; i++)
        if (glint_absence_concerns(absence, graph->images[i].row) && matters(graph, graph->images[i].row)) return true;
    return false;
}

size_t plan_missing(const struct frame_plan *plan, const struct glint_absence *missing[MISSING_MAX]) {
    size_t count, found = 0;
    const struct glint_absence *all = glint_absences(&count);
    for (size_t i = 0; i < count && found < MISSING_MAX; i++)
        if (is_read(&plan->graph, &all[i]) && glint_capture_lacks(plan->source->capture, &all[i]))
            missing[found++] = &all[i];
    return found;
}

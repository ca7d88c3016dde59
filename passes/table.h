/* The functions over the generated tables; included at the end of the generated file. */
const struct glint_pass *glint_passes(size_t *count) {
    *count = sizeof pass_table / sizeof pass_table[0];
    return pass_table;
}

const struct glint_pass *glint_pass_find(const char *slot, const char *variant) {
    for (size_t i = 0; i < sizeof pass_table / sizeof pass_table[0]; i++)
        if (strcmp(pass_table[i].slot, slot) == 0 && strcmp(pass_table[i].variant, variant) == 0) return &pass_table[i];
    return NULL;
}

const struct glint_effect *glint_effects(size_t *count) {
    *count = sizeof effect_table / sizeof effect_table[0];
    return effect_table;
}

const struct glint_effect *glint_effects_by_default(size_t *count) {
    const struct glint_effect *all = glint_effects(count);
    while (*count && (all[*count - 1].of_all || !all[*count - 1].truth)) --*count;
    return all;
}

const struct glint_effect *glint_effect_find(const char *name) {
    for (size_t i = 0; i < sizeof effect_table / sizeof effect_table[0]; i++)
        if (strcmp(effect_table[i].name, name) == 0) return &effect_table[i];
    return NULL;
}

size_t glint_effect_class_count(const struct glint_effect *effect) {
    size_t count = 0;
    while (count < GLINT_EFFECT_CLASSES && effect->classes[count].name) count++;
    return count;
}

const char *glint_effect_class_name(const struct glint_effect *effect, size_t label) {
    return label ? effect->classes[label - 1].name : "all";
}

size_t glint_effect_class_of(const struct glint_effect *effect, double value) {
    const size_t last = glint_effect_class_count(effect);
    size_t label = 1;
    while (label < last && !(value <= effect->classes[label - 1].most)) label++;
    return label;
}

bool glint_pass_assumes(const struct glint_pass *pass, const struct glint_row *parameter) {
    for (size_t i = 0; i < pass->row_count; i++)
        if (pass->rows[i].kind == GLINT_ROW_ASSUMED && strcmp(pass->rows[i].name, parameter->name) == 0) return true;
    return false;
}

const struct glint_row *glint_capture_images(size_t *count) {
    *count = sizeof capture_rows / sizeof capture_rows[0];
    return capture_rows;
}

const struct glint_absence *glint_absences(size_t *count) {
    static const struct glint_absence absences[] = {
#define ABSENCE(role, channels, cost) {role, channels, cost, NULL, false},
#define ABSENCE_UNLESS(other, role, channels, cost) {role, channels, cost, other, false},
#define ABSENCE_BESIDE(other, role, channels, cost) {role, channels, cost, other, true},
#include "absences.h"
    };
    *count = sizeof absences / sizeof absences[0];
    return absences;
}

bool glint_absence_concerns(const struct glint_absence *absence, const struct glint_row *image) {
    const size_t length = strlen(absence->channels);
    if (image->kind != GLINT_ROW_CAPTURE || strcmp(image->role, absence->role) != 0) return false;
    for (const char *at = image->source; at; at = strchr(at, ' ') ? strchr(at, ' ') + 1 : NULL)
        if (strncmp(at, absence->channels, length) == 0) return true;
    return false;
}

const char *glint_pass_text(const char *path) {
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        if (strcmp(texts[i].path, path) == 0) return texts[i].text;
    return NULL;
}

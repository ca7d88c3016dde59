/* Which attributes of the format a part may carry: names that begin with `glint.` are reserved for FORMAT.md. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "attributes.h"
#include "nearest.h"
#include "part.h"

/* A name of the format, and where it may be. */
struct known {
    const char *name;
    char text[64]; /* the name of some planes of a hull, or of an attribute of a light */
    bool everywhere;
    const struct glint_encoding_row *encoding; /* NULL: on the parts of the scope */
    enum glint_scope scope;
};

/* Whether the role has channels with the encoding, which a part may lack. */
static bool has_encoding(const struct glint_role *role, const char *which) {
    const bool space = !strcmp(which, "normal_space");
    for (size_t i = 0; i < role->channel_count; i++) {
        const char *encoding = role->channels[i].encoding;
        if (!strcmp(encoding, which) || (space && strstr(encoding, "normal"))) return true;
    }
    return false;
}

/* The number of four of a hull's planes that `name` seems to mean; 0 if it means none. */
static size_t planes_number(const struct glint_attribute_row *row, const char *name) {
    const size_t length = strlen(row->name);
    if (strncmp(name, row->name, length) != 0 || name[length] != '.') return 0;
    const unsigned long number = strtoul(name + length + 1, NULL, 10);
    return number < GLINT_MAX_PLANES / 4 ? number : 0;
}

/* The names of all parts, those of encodings, then those of the rows; of the planes of a hull and of lights only the one that `name` seems
   to mean is there. */
static bool known_at(size_t i, const char *name, struct known *known) {
    static const char *const common[] = {GLINT_VERSION_ATTRIBUTE, GLINT_STORAGE_ATTRIBUTE, GLINT_SIBLING_ATTRIBUTE,
                                         GLINT_SIBLING_HASH_ATTRIBUTE};
    enum { COMMON = sizeof common / sizeof *common };
    size_t encodings, rows;
    uint32_t light = 0;
    const struct glint_encoding_row *encoding = glint_encoding_rows(&encodings);
    const struct glint_attribute_row *row = glint_attribute_rows(&rows);
    if (i < COMMON) {
        *known = (struct known){.name = common[i], .everywhere = i < 2, .scope = GLINT_SCOPE_CUBEMAP};
        return true;
    }
    if ((i -= COMMON) < encodings) {
        *known = (struct known){.name = encoding[i].attribute, .encoding = &encoding[i]};
        return true;
    }
    if ((i -= encodings) >= rows) return false;
    row += i;
    known->everywhere = false;
    known->encoding = NULL;
    known->scope = row->scope;
    if (row->kind == GLINT_KIND_PLANES) {
        snprintf(known->text, sizeof known->text, "%s.%02zu", row->name, planes_number(row, name));
        known->name = known->text;
    } else {
        glint_light_number(name, &light);
        known->name = glint_attribute_name(row, light, known->text);
    }
    return true;
}

static bool is_here(const struct known *known, const struct glint_part_info *part) {
    if (known->encoding) return has_encoding(part->role, known->encoding->which);
    return known->everywhere || glint_scope_is_on(known->scope, part->role, part->previous);
}

static const char *place_of(const struct known *known) {
    return known->encoding ? "on parts with such channels" : glint_scope_row(known->scope)->place;
}

static bool report_unknown(struct glint_check *check, const struct glint_part_info *part, const char *name) {
    struct glint_nearest nearest = glint_nearest_to(name);
    struct known candidates[64];
    size_t count = 0;
    for (size_t i = 0; count < sizeof candidates / sizeof *candidates && known_at(i, name, &candidates[count]); i++)
        if (is_here(&candidates[count], part)) glint_nearest_offer(&nearest, candidates[count++].name);
    return glint_violation(check, GLINT_RULE_ATTRIBUTE, part->name, name, "expected an attribute of the format%s",
                           glint_nearest_text(&nearest));
}

static bool check_name(struct glint_check *check, const struct glint_part_info *part, const char *name) {
    struct known known;
    const char *place = NULL;
    for (size_t i = 0; known_at(i, name, &known); i++) {
        if (strcmp(known.name, name) != 0) continue;
        if (is_here(&known, part)) return true;
        if (!place) place = place_of(&known);
    }
    if (!place) return report_unknown(check, part, name);
    return glint_violation(check, GLINT_RULE_ATTRIBUTE, part->name, name, "expected it %s only", place);
}

bool glint_attribute_names_check(struct glint_check *check, const struct glint_exr_part_info *from,
                                 const struct glint_part_info *part) {
    if (!part->role->channels) return true;
    for (size_t i = 0; i < from->attribute_count; i++) {
        const char *name = from->attributes[i].name;
        if (glint_attribute_is_ours(name) && !check_name(check, part, name)) return false;
        if (!strcmp(name, "envmap") && !glint_violation(check, GLINT_RULE_ATTRIBUTE, part->name, name,
                                                        "expected none, whose faces lie in another way"))
            return false;
    }
    return true;
}

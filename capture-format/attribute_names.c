/* Which attributes of the format a part may carry: names that begin with `glint.` are reserved for FORMAT.md. */
#include <stdio.h>
#include <string.h>

#include "attributes.h"
#include "nearest.h"
#include "part.h"

/* A name of the format, and where it may be. */
struct known {
    const char *name; /* NULL: none */
    char text[64];    /* the name of some planes of a hull, or of an attribute of a light */
    bool here;
    const char *place;
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

/* The names of all parts, those of encodings, then those of the rows; a hull has a name for each four planes, and of lights only the one
   that `name` seems to mean is there. */
static bool known_at(size_t i, const struct glint_part_info *part, const char *name, struct known *known) {
    static const char *const common[] = {GLINT_VERSION_ATTRIBUTE, GLINT_STORAGE_ATTRIBUTE, GLINT_SIBLING_ATTRIBUTE,
                                         GLINT_SIBLING_HASH_ATTRIBUTE};
    enum { COMMON = sizeof common / sizeof *common, HULLS = GLINT_MAX_PLANES / 4 };
    size_t encodings, rows;
    uint32_t number = 0;
    const struct glint_encoding_row *encoding = glint_encoding_rows(&encodings);
    const struct glint_attribute_row *row = glint_attribute_rows(&rows);
    if (i < COMMON) {
        known->name = common[i];
        known->here = i < 2 || glint_scope_is_on(GLINT_SCOPE_CUBEMAP, part->role, part->previous);
        known->place = glint_scope_row(GLINT_SCOPE_CUBEMAP)->place;
        return true;
    }
    if ((i -= COMMON) < encodings) {
        known->name = encoding[i].attribute;
        known->here = has_encoding(part->role, encoding[i].which);
        known->place = "on parts with such channels";
        return true;
    }
    if ((i -= encodings) >= rows * HULLS) return false;
    row += i / HULLS;
    known->name = NULL;
    if (row->kind == GLINT_KIND_PLANES) {
        snprintf(known->text, sizeof known->text, "%s.%02zu", row->name, i % HULLS);
        known->name = known->text;
    } else if (i % HULLS == 0) {
        glint_light_number(name, &number);
        known->name = glint_attribute_name(row, number, known->text);
    }
    if (!known->name) return true;
    known->here = glint_scope_is_on(row->scope, part->role, part->previous);
    known->place = glint_scope_row(row->scope)->place;
    return true;
}

static bool report_unknown(struct glint_check *check, const struct glint_part_info *part, const char *name) {
    struct glint_nearest nearest = glint_nearest_to(name);
    struct known candidates[64];
    size_t count = 0;
    for (size_t i = 0; count < sizeof candidates / sizeof *candidates && known_at(i, part, name, &candidates[count]);
         i++) {
        if (!candidates[count].name || !candidates[count].here) continue;
        glint_nearest_offer(&nearest, candidates[count++].name);
    }
    return glint_violation(check, GLINT_RULE_ATTRIBUTE, part->name, name, "expected an attribute of the format%s",
                           glint_nearest_text(&nearest));
}

static bool check_name(struct glint_check *check, const struct glint_part_info *part, const char *name) {
    struct known known;
    const char *place = NULL;
    for (size_t i = 0; known_at(i, part, name, &known); i++) {
        if (!known.name || strcmp(known.name, name) != 0) continue;
        if (known.here) return true;
        if (!place) place = known.place;
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

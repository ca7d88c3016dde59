/* Names that are nearest to an unknown one, by edit distance: an insertion, removal, substitution or swap of neighbours counts one. */
#include "nearest.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#define LONGEST 64
#define FAR ((size_t)-1)

static size_t min_distance(size_t a, size_t b) {
    return a < b ? a : b;
}

/* FAR if it cannot be below `limit`. */
static size_t edit_distance(const char *a, const char *b, size_t limit) {
    size_t na = strlen(a), nb = strlen(b);
    if (na > LONGEST || nb > LONGEST) return FAR;
    size_t row[3][LONGEST + 1];
    for (size_t j = 0; j <= nb; j++) row[0][j] = j;
    for (size_t i = 1; i <= na; i++) {
        size_t *now = row[i % 3], *above = row[(i + 2) % 3], *above2 = row[(i + 1) % 3];
        size_t least = now[0] = i;
        for (size_t j = 1; j <= nb; j++) {
            int ca = tolower((unsigned char)a[i - 1]), cb = tolower((unsigned char)b[j - 1]);
            now[j] = min_distance(min_distance(now[j - 1], above[j]) + 1, above[j - 1] + (ca != cb));
            if (i > 1 && j > 1 && ca == tolower((unsigned char)b[j - 2]) && cb == tolower((unsigned char)a[i - 2]))
                now[j] = min_distance(now[j], above2[j - 2] + 1);
            least = min_distance(least, now[j]);
        }
        if (least >= limit) return FAR; /* and no later row has less, as a swap adds one */
    }
    return row[na % 3][nb];
}

void text_list(char *text, size_t size, const char *item) {
    size_t used = strlen(text), length = strlen(item);
    if (used + length + 8 < size) snprintf(text + used, size - used, "%s%s", used ? ", " : "", item);
    else if (used + 6 < size && (used < 3 || strcmp(text + used - 3, "…") != 0))
        snprintf(text + used, size - used, ", …");
}

struct glint_nearest glint_nearest_to(const char *wanted) {
    return (struct glint_nearest){.wanted = wanted, .distance = 2 + strlen(wanted) / 4};
}

void glint_nearest_offer(struct glint_nearest *nearest, const char *candidate) {
    if (!candidate || !*candidate || (nearest->last && !strcmp(nearest->last, candidate))) return;
    nearest->last = candidate;
    text_list(nearest->known, sizeof nearest->known, candidate);
    /* A prefix or substring is a likely abbreviation. Names whose lengths differ by more than the best distance cannot be nearer. */
    const size_t wanted = strlen(nearest->wanted), length = strlen(candidate);
    size_t distance = wanted >= 3 && strstr(candidate, nearest->wanted) ? 1 : FAR;
    if ((wanted > length ? wanted - length : length - wanted) < nearest->distance)
        distance = min_distance(distance, edit_distance(nearest->wanted, candidate, nearest->distance));
    if (distance >= nearest->distance) return;
    nearest->best = candidate;
    nearest->distance = distance;
}

const char *glint_nearest_text(struct glint_nearest *nearest) {
    if (!nearest->best) return "";
    snprintf(nearest->text, sizeof nearest->text, " (did you mean %s?)", nearest->best);
    return nearest->text;
}

const char *glint_nearest_or_known(struct glint_nearest *nearest) {
    if (nearest->best || !nearest->known[0]) return glint_nearest_text(nearest);
    snprintf(nearest->text, sizeof nearest->text, "; known: %s", nearest->known);
    return nearest->text;
}

/* The nearest of some names, against distances that are computed by their definition. */
#include <stdbool.h>
#include <string.h>

#include "fixture.h"
#include "nearest.h"
#include "unit.h"

enum { LETTERS = 3, LONGEST = 9, NAMES = 6, ROUNDS = 20000 };

static size_t smaller(size_t a, size_t b) {
    return a < b ? a : b;
}

/* An insertion, removal, substitution or swap of neighbours counts one. */
static size_t distance_of(const char *a, size_t na, const char *b, size_t nb) {
    size_t all[LONGEST + 1][LONGEST + 1];
    for (size_t i = 0; i <= na; i++)
        for (size_t j = 0; j <= nb; j++) {
            all[i][j] = i && j ? all[i - 1][j - 1] + (a[i - 1] != b[j - 1]) : i + j;
            if (i) all[i][j] = smaller(all[i][j], all[i - 1][j] + 1);
            if (j) all[i][j] = smaller(all[i][j], all[i][j - 1] + 1);
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                all[i][j] = smaller(all[i][j], all[i - 2][j - 2] + 1);
        }
    return all[na][nb];
}

static void random_name(char name[LONGEST + 1], uint32_t seed) {
    const size_t length = 1 + (size_t)(fixture_noise(seed, 0) * LONGEST * 0.999);
    for (size_t i = 0; i < length; i++)
        name[i] = (char)('a' + (int)(fixture_noise(seed, (uint32_t)i + 1) * LETTERS * 0.999));
    name[length] = '\0';
}

static void the_first_of_the_nearest_is_found(UNUSED void **state) {
    size_t found = 0;
    for (uint32_t round = 0; round < ROUNDS; round++) {
        char wanted[LONGEST + 1], names[NAMES][LONGEST + 1];
        random_name(wanted, round * (NAMES + 1));
        struct glint_nearest nearest = glint_nearest_to(wanted);
        size_t least = 2 + strlen(wanted) / 4;
        const char *best = NULL;
        for (uint32_t n = 0; n < NAMES; n++) {
            random_name(names[n], round * (NAMES + 1) + n + 1);
            size_t distance = distance_of(wanted, strlen(wanted), names[n], strlen(names[n]));
            if (strlen(wanted) >= 3 && strstr(names[n], wanted)) distance = smaller(distance, 1); /* an abbreviation */
            if (distance < least) least = distance, best = names[n];
            glint_nearest_offer(&nearest, names[n]);
        }
        if (nearest.best != best)
            fail_msg("%s: expected %s, found %s", wanted, best ? best : "none", nearest.best ? nearest.best : "none");
        found += best != NULL;
    }
    assert_in_range(found, ROUNDS / 4, ROUNDS - ROUNDS / 50);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_first_of_the_nearest_is_found)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Evaluates facts, which are rows of passes/facts.h, by the survey's figures. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "survey.h"

/* `by_limit`: the fact comes with a limit, as "rough 0.1". */
static bool is_fact(const char *fact, const char *name, bool by_limit) {
    const size_t length = strcspn(fact, " ");
    return strlen(name) == length && strncmp(name, fact, length) == 0 && by_limit == (fact[length] != 0);
}

enum fact_about survey_fact_about(const char *fact) {
#define FACT(name, about, holds, words)                                                                                \
    if (is_fact(fact, #name, false)) return FACT_##about;
#define FACT_BY(name, about, holds, words)                                                                             \
    if (is_fact(fact, #name, true)) return FACT_##about;
#include "facts.h"
#undef FACT
#undef FACT_BY
    return FACT_UNKNOWN;
}

/* "the smoothest of 1000 reflecting pixels has roughness 0.02, required: at most 0.1". The limit is omitted if limit_word is NULL. */
static int say_roughness(char *reason, size_t size, const struct glint_survey *s,
                         const struct glint_survey_pixels *shown, const char *word, int end, const char *limit_word,
                         double limit) {
    if (shown->count == 0) return snprintf(reason, size, "0 of %llu pixels reflect", (unsigned long long)s->pixels);
    const int length = snprintf(reason, size, "the %s of %llu reflecting pixels has roughness %.3g", word,
                                (unsigned long long)shown->count, (double)shown->roughness[end]);
    if (limit_word && length > 0 && (size_t)length < size)
        snprintf(reason + length, size - (size_t)length, ", required: %s %.3g", limit_word, limit);
    return length;
}

bool survey_fact(const struct glint_survey *s, bool shows_all, const char *fact, char *reason, size_t size) {
    const struct glint_survey_pixels *shown = shows_all ? &s->surfaces : &s->reflecting;
    const double share = s->pixels ? (double)shown->count / (double)s->pixels : 0;
    const double limit = fact[strcspn(fact, " ")] ? strtod(fact + strcspn(fact, " "), NULL) : 0;
    const uint32_t faces = 6 * s->active_surveyed, open = glint_survey_faces(s, GLINT_SURVEY_OPEN),
                   translucent = glint_survey_faces(s, GLINT_SURVEY_SKY);
#define N(count) ((unsigned long long)(count))
#define SAY(...) snprintf(reason, size, __VA_ARGS__)
#define SAY_ROUGHNESS(word, end) say_roughness(reason, size, s, shown, word, end, NULL, limit)
#define SAY_LIMIT(word, end, limit_word) say_roughness(reason, size, s, shown, word, end, limit_word, limit)
#define FACT(name, about, holds, words)                                                                                \
    if (is_fact(fact, #name, false)) {                                                                                 \
        (void)(words);                                                                                                 \
        return holds;                                                                                                  \
    }
#define FACT_BY(name, about, holds, words)                                                                             \
    if (is_fact(fact, #name, true)) {                                                                                  \
        (void)(words);                                                                                                 \
        return holds;                                                                                                  \
    }
#include "facts.h"
    return false;
}

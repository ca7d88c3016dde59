/* What is found in many captures: a row for each, the worst first, and how many captures have each finding. */
#ifndef GLINT_VIEWER_LINT_SURVEY_H
#define GLINT_VIEWER_LINT_SURVEY_H

#include <jansson.h>

#include "lint/lint.h"

enum { LINT_CERTAIN, LINT_LIKELY, LINT_POSSIBLE, LINT_LIKELIHOODS };
struct lint_survey_row {
    const char *path; /* the caller's */
    size_t found[LINT_LIKELIHOODS];
    json_t *findings; /* [{"id", "likelihood"}] */
    char *failure;    /* why the capture cannot be read; NULL if it can */
};
struct lint_survey {
    struct lint_survey_row *rows; /* zero-initialised; of all captures */
    size_t count;
};

/* What was found in a capture, as a line of a journal: {"findings": [{"id", "likelihood"}]}. It does not depend on the size of its images. */
json_t *lint_survey_line(const struct lint_findings *findings);
/* That of a capture that cannot be read: {"failure"}. */
json_t *lint_survey_failure(const char *failure);
/* Adds a line; false without memory, and for one that somebody else has made and that lacks something, without an error. */
bool lint_survey_add(struct lint_survey *survey, const char *path, const json_t *line, struct glint_error *err);
/* Sorts the rows: captures that cannot be read first, then by the number of certain, likely and possible findings. */
void lint_survey_sort(struct lint_survey *survey);
/* Whether every capture can be read and has no finding. */
bool lint_survey_is_clean(const struct lint_survey *survey);
json_t *lint_survey_json(const struct lint_survey *survey);
void lint_survey_print(const struct lint_survey *survey);
void lint_survey_finish(struct lint_survey *survey);

#endif

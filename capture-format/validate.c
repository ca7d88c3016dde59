/* Checks every rule of FORMAT.md and reports all violations. */
#include "capture_internal.h"

/* Faults of the file are violations; faults of the machine and exceeded limits are failures. */
static bool is_violation(const struct glint_error *err) {
    return err->code == GLINT_ERROR_FORMAT || err->code == GLINT_ERROR_UNSUPPORTED;
}

bool glint_capture_validate(const char *path, const struct glint_limits *limits, glint_report report, void *user,
                            size_t *violations, struct glint_error *err) {
    struct glint_error fault = {0};
    struct glint_check check = {.file = path, .report = report, .user = user, .err = &fault};
    struct glint_capture *capture = glint_capture_open_checked(path, limits, &check);
    bool ok = capture != NULL;
    /* Headers say how to decode pixels, so these are only checked if the headers are valid. */
    for (size_t i = 0; ok && !check.violations && i < capture->count; i++)
        ok = glint_validate_pixels(&check, capture, i, &fault);
    glint_capture_close(&capture);
    if (!ok && is_violation(&fault)) {
        report(user, glint_rule_rows()[GLINT_RULE_OPENEXR].name, fault.message);
        check.violations++;
        ok = true;
    }
    if (!ok && err) *err = fault;
    *violations = check.violations;
    return ok;
}

/* Checks every rule of FORMAT.md and reports all that are broken. */
#include "capture_internal.h"

/* What is wrong with the file is a violation; what is wrong with the machine or the limits is a failure. */
static bool is_violation(const struct glint_error *err) {
    return err->code == GLINT_ERROR_FORMAT || err->code == GLINT_ERROR_UNSUPPORTED;
}

bool glint_capture_validate(const char *path, const struct glint_limits *limits, glint_report report, void *user,
                            size_t *violations, struct glint_error *err) {
    struct glint_error fault = {0};
    struct glint_check check = {.file = path, .report = report, .user = user, .err = &fault};
    struct glint_capture *capture = glint_capture_open_checked(path, limits, &check);
    bool ok = capture != NULL;
    /* What pixels mean depends on the headers: they are looked at when those keep every rule. */
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

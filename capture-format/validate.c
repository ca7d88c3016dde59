/* Checks every rule of FORMAT.md and reports all that are broken. */
#include "capture_internal.h"

bool glint_capture_validate(const char *path, const struct glint_limits *limits, glint_report report, void *user,
                            size_t *violations, struct glint_error *err) {
    struct glint_error open_error = {0};
    struct glint_check check = {.file = path, .report = report, .user = user, .err = &open_error};
    struct glint_capture *capture = glint_capture_open_checked(path, limits, &check);
    if (!capture && open_error.code == GLINT_ERROR_FORMAT) {
        report(user, "openexr", open_error.message);
        check.violations++;
    } else if (!capture) {
        if (err) *err = open_error;
        return false;
    }
    glint_capture_close(&capture);
    *violations = check.violations;
    return true;
}

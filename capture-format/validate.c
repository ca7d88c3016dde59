/* Checks every rule of FORMAT.md and reports all violations. */
#include "capture_internal.h"

/* Faults of the file are violations; faults of the machine and exceeded limits are failures. */
static bool is_violation(const struct glint_error *err) {
    return err->code == GLINT_ERROR_FORMAT || err->code == GLINT_ERROR_UNSUPPORTED;
}

/* The pixels in the capture itself of a cube map that is in a sibling. */
static bool check_placeholder(struct glint_check *check, struct glint_capture *capture, size_t p,
                              struct glint_error *err) {
    static const enum glint_type types[] = {GLINT_F16, GLINT_F32, GLINT_U32};
    const struct glint_exr_part_info *part = &capture->exr->parts[p].info;
    if (!capture->parts[p].sibling[0]) return true;
    for (size_t c = 0; c < part->channel_count; c++) {
        const char *names[] = {part->channels[c].name};
        uint8_t pixels[6 * sizeof(uint32_t)] = {0}, any = 0;
        if (!glint_exr_read(capture->exr, p, names, 1, types[part->channels[c].stored], pixels, 0, err)) return false;
        for (size_t i = 0; i < sizeof pixels; i++) any |= pixels[i];
        if (any)
            glint_violation(check, GLINT_RULE_SIBLING, part->name, names[0], "expected a placeholder of black pixels");
    }
    return true;
}

bool glint_capture_validate(const char *path, const struct glint_limits *limits, glint_report report, void *user,
                            size_t *violations, struct glint_error *err) {
    struct glint_error fault = {0};
    struct glint_check check = {.file = path, .report = report, .user = user, .err = &fault};
    struct glint_capture *capture = glint_capture_open_checked(path, limits, &check);
    bool ok = capture != NULL;
    /* Headers say how to decode pixels, so these are only checked if the headers are valid. */
    for (size_t i = 0; ok && !check.violations && i < capture->count; i++)
        ok = check_placeholder(&check, capture, i, &fault) && glint_validate_pixels(&check, capture, i, &fault);
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

/* The options that diff and check share. */
#include "diff/options.h"

#include "io/progress.h"

struct diff_args diff_args_default(void) {
    return (struct diff_args){.options = {.limits = glint_difference_limits()}};
}

static error_t parse_limit(int key, char *arg, struct argp_state *state, struct glint_difference_limits *limits) {
    double value;
    arg_numbers("limit", arg, &value, 1, state);
    if (!(value >= 0)) argp_error(state, "%s: expected a number that is not negative", arg);
    switch (key) {
    case KEY_FAIL:
        limits->fail.absolute = value;
        return 0;
    case KEY_FAIL_RELATIVE:
        limits->fail.relative = value;
        return 0;
    case KEY_FAIL_PERCENT:
        limits->fail.percent = value;
        return 0;
    case KEY_HARD_FAIL:
        limits->fail.hard = value;
        return 0;
    case KEY_WARN:
        limits->warn.absolute = value;
        return 0;
    case KEY_WARN_RELATIVE:
        limits->warn.relative = value;
        return 0;
    case KEY_WARN_PERCENT:
        limits->warn.percent = value;
        return 0;
    case KEY_HARD_WARN:
        limits->warn.hard = value;
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

error_t diff_args_parse(int key, char *arg, struct argp_state *state, struct diff_args *a) {
    switch (key) {
    case 'o':
        a->heat = arg;
        return 0;
    case KEY_BESIDE:
        a->beside = arg;
        return 0;
    case KEY_FLICKER:
        a->flicker = arg;
        return 0;
    case KEY_HTML:
        a->html = arg;
        return 0;
    case KEY_ONLY_DIFFERENT:
        a->only_different = true;
        return 0;
    case KEY_ALLOW:
        a->options.limits.allow_failures = arg_uint("allowfailures", arg, 0, UINT32_MAX, state);
        return 0;
    case 'a':
        return 0;
    case 'v':
        a->verbose = true;
        return 0;
    case 'q':
        a->quiet = true;
        return 0;
    case 'j':
        a->json = true;
        return 0;
    }
    if (key >= KEY_FAIL && key <= KEY_HARD_WARN) return parse_limit(key, arg, state, &a->options.limits);
    return metric_args_parse(key, arg, state, &a->options.metrics);
}

static bool write_all(const struct diff_args *a, struct diff *diff, struct glint_error *err) {
    if (a->only_different && !diff->status) return true;
    return (!a->heat || diff_write_heat(a->heat, diff, err)) &&
           (!a->beside || diff_write_beside(a->beside, diff, err)) &&
           (!a->flicker || diff_write_flicker(a->flicker, diff, err)) &&
           (!a->html || diff_write_page(a->html, diff, NULL, err));
}

bool diff_args_compare(const struct diff_args *a, const char *const paths[2], struct diff *diff,
                       struct glint_error *err) {
    struct progress progress;
    *diff = (struct diff){.options = a->options};
    diff->options.heat = a->heat || a->beside || a->html;
    progress_begin(&progress);
    const bool ok = diff_sides_open(diff->sides, paths, err) && diff_compare(diff, progress_report, &progress, err) &&
                    write_all(a, diff, err);
    progress_end(&progress);
    return ok;
}

enum diff_status diff_args_fail(const struct command *command, const struct glint_error *err) {
    const enum status status = command_fail(command, err);
    return status == STATUS_INTERRUPTED ? (enum diff_status)STATUS_INTERRUPTED
           : status == STATUS_USAGE     ? DIFF_USAGE
                                        : DIFF_FILE;
}

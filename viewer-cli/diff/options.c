/* The options that diff and check share. */
#include "diff/options.h"

#include "io/progress.h"

struct diff_args diff_args_default(void) {
    return (struct diff_args){.options = {.limits = glint_difference_limits()}};
}

static error_t parse_limit(const char *arg, struct argp_state *state, double *limit) {
    double value;
    arg_numbers("limit", arg, &value, 1, state);
    if (!(value >= 0)) argp_error(state, "%s: expected a number that is not negative", arg);
    *limit = value;
    return 0;
}

error_t diff_args_parse(int key, char *arg, struct argp_state *state, struct diff_args *a) {
    struct glint_difference_limits *limits = &a->options.limits;
    switch (key) {
    case KEY_FAIL:
        return parse_limit(arg, state, &limits->fail.absolute);
    case KEY_FAIL_RELATIVE:
        return parse_limit(arg, state, &limits->fail.relative);
    case KEY_FAIL_PERCENT:
        return parse_limit(arg, state, &limits->fail.percent);
    case KEY_HARD_FAIL:
        return parse_limit(arg, state, &limits->fail.hard);
    case KEY_WARN:
        return parse_limit(arg, state, &limits->warn.absolute);
    case KEY_WARN_RELATIVE:
        return parse_limit(arg, state, &limits->warn.relative);
    case KEY_WARN_PERCENT:
        return parse_limit(arg, state, &limits->warn.percent);
    case KEY_HARD_WARN:
        return parse_limit(arg, state, &limits->warn.hard);
    case 'a':
        return 0;
    }
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

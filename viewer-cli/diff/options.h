/* The options that diff and check share: limits, and what to write and print. */
#ifndef GLINT_VIEWER_DIFF_OPTIONS_H
#define GLINT_VIEWER_DIFF_OPTIONS_H

#include "command.h"
#include "options/args.h"
#include "diff/diff.h"
#include "options/metric_args.h"

struct diff_args {
    struct diff_options options;
    const char *heat, *beside, *flicker, *html;
    bool overwrite, only_different, verbose, quiet, json;
};

enum {
    KEY_FAIL = 256,
    KEY_FAIL_RELATIVE,
    KEY_FAIL_PERCENT,
    KEY_HARD_FAIL,
    KEY_ALLOW,
    KEY_WARN,
    KEY_WARN_RELATIVE,
    KEY_WARN_PERCENT,
    KEY_HARD_WARN,
    KEY_ONLY_DIFFERENT,
    KEY_BESIDE,
    KEY_FLICKER,
    KEY_HTML,
    KEY_RESAMPLE,
    KEY_AFTER_DIFF
};

/* clang-format off */
#define DIFF_HEAT "a heat map of the differences; for several images, a sheet of those that differ"
#define DIFF_OPTIONS(output, help) \
    {"fail",          KEY_FAIL,          "X", 0, "A pixel fails when a value differs by more than X (default 1e-6)", 0}, \
    {"failrelative",  KEY_FAIL_RELATIVE, "X", 0, "... and also by more than X times the mean magnitude of both values (default 0)", 0}, \
    {"failpercent",   KEY_FAIL_PERCENT,  "P", 0, "Allow this percentage of the pixels to fail (default 0)", 0}, \
    {"hardfail",      KEY_HARD_FAIL,     "X", 0, "Fail if any value differs by more than X (default: no limit)", 0}, \
    {"allowfailures", KEY_ALLOW,         "N", 0, "Allow N pixels of an image to fail by any amount (default 0)", 0}, \
    {"warn",          KEY_WARN,          "X", 0, "Like --fail, for warnings (default 1e-6)", 0}, \
    {"warnrelative",  KEY_WARN_RELATIVE, "X", 0, "Like --failrelative, for warnings (default 0)", 0}, \
    {"warnpercent",   KEY_WARN_PERCENT,  "P", 0, "Like --failpercent, for warnings (default 0)", 0}, \
    {"hardwarn",      KEY_HARD_WARN,     "X", 0, "Like --hardfail, for warnings (default: no limit)", 0}, \
    {"output",        'o',               output, 0, help, 0}, \
    {"side-by-side",  KEY_BESIDE,        "FILE.png", 0, "Write both images and the heat map side by side; for several images, one row for each that differs", 0}, \
    {"flicker",       KEY_FLICKER,       "FILE.png", 0, "Write an animated PNG that alternates between both images; of several images, the first that differs", 0}, \
    {"html",          KEY_HTML,          "FILE.html", 0, "Write an HTML page with tables, histograms, and each image that differs under a slider with pixel values", 0}, \
    OVERWRITE_OPTION, \
    {"od",            KEY_ONLY_DIFFERENT, NULL, 0, "Write these files only if something differs", 0}, \
    {"resample",      KEY_RESAMPLE,      NULL, 0, "Compare images of different sizes: the larger one is averaged over the area of each texel of the smaller one", 0}, \
    METRIC_OPTIONS, \
    {"all",           'a',               NULL, 0, "Accepted for compatibility with idiff -a; all parts are always compared", 0}, \
    {"verbose",       'v',               NULL, 0, "Also list images that are equal", 0}, \
    {"quiet",         'q',               NULL, 0, "Print nothing; only set the exit status", 0}, \
    {"json",          'j',               NULL, 0, "Print JSON", 0}
/* Where those go that need no more than parsing: `args` is the struct diff_args in the command's arguments of this type. */
#define DIFF_TARGETS(type, args) \
    STORED_OUTPUT('o', type, args.heat, OUTPUT_PNG), \
    STORED_OUTPUT(KEY_BESIDE, type, args.beside, OUTPUT_PNG), \
    STORED_OUTPUT(KEY_FLICKER, type, args.flicker, OUTPUT_PNG), \
    STORED_OUTPUT(KEY_HTML, type, args.html, OUTPUT_HTML), \
    STORED(KEY_OVERWRITE, type, args.overwrite), \
    STORED(KEY_ONLY_DIFFERENT, type, args.only_different), \
    STORED(KEY_RESAMPLE, type, args.options.resample), \
    STORED_NUMBER(KEY_ALLOW, type, args.options.limits.allow_failures, 0, UINT32_MAX), \
    STORED('v', type, args.verbose), \
    STORED('q', type, args.quiet), \
    STORED('j', type, args.json)
/* clang-format on */

/* The limits of idiff. */
struct diff_args diff_args_default(void);
/* Parses the others; ARGP_ERR_UNKNOWN for any other key. */
error_t diff_args_parse(int key, char *arg, struct argp_state *state, struct diff_args *args);

/* Compares two sides, and writes the requested pictures and page. Release `diff` even if this fails. */
bool diff_args_compare(const struct diff_args *args, const char *const paths[2], struct diff *diff,
                       struct glint_error *err);
/* Prints an error and returns its exit status. */
enum diff_status diff_args_fail(const struct command *command, const struct glint_error *err);

#endif

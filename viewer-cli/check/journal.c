/* What the journal of a check of many runs belongs to, and what each run costs. */
#include <dirent.h>
#include <stdlib.h>

#include "check/check.h"
#include "record.h"

/* When its run.json was written, and its size. */
static json_t *run_json(const char *folder) {
    char path[4096];
    double bytes = 0;
    return journal_path(folder, "run.json", path, NULL) ? survey_file(path, &bytes) : json_string("path too long");
}

/* The bytes of the files in a folder. */
static double cost_of(const char *folder) {
    char path[4096];
    double bytes = 0;
    DIR *entries = opendir(folder);
    for (const struct dirent *entry; entries && (entry = readdir(entries));)
        if (entry->d_name[0] != '.' && journal_path(folder, entry->d_name, path, NULL))
            json_decref(survey_file(path, &bytes));
    if (entries) closedir(entries);
    return bytes;
}

static json_t *limit_json(const struct glint_difference_limit *limit) {
    return json_pack("[o, o, o, o]", json_number(limit->absolute), json_number(limit->relative),
                     json_number(limit->percent), json_number(limit->hard));
}

static json_t *define(const struct check_pairs *pairs, const struct diff_options *o) {
    json_t *runs = json_array();
    for (size_t i = 0; i < pairs->count; i++) {
        record_append(&runs, run_json(pairs->items[i].run));
        record_append(&runs, run_json(pairs->items[i].baseline));
    }
    return json_pack("{s:i, s:s, s:o, s:o, s:o, s:I, s:I, s:o, s:o, s:b}", "format", 1, "glint", GLINT_VERSION, "runs",
                     runs, "fail", limit_json(&o->limits.fail), "warn", limit_json(&o->limits.warn), "allow",
                     (json_int_t)o->limits.allow_failures, "metrics", (json_int_t)o->metrics.metrics, "ppd",
                     json_number(o->metrics.ppd), "peak", json_number(o->metrics.peak), "resample", (int)o->resample);
}

bool check_survey_open(struct survey *survey, const struct check_pairs *pairs, const struct diff_args *args,
                       struct glint_error *err) {
    double *costs = calloc(pairs->count + 1, sizeof *costs);
    survey->count = pairs->count;
    for (size_t i = 0; costs && survey->shard.count && i < pairs->count; i++) {
        const struct check_pair *pair = &pairs->items[i];
        if (pair->has_run && pair->has_baseline) costs[i] = cost_of(pair->run);
    }
    json_t *definition = costs ? define(pairs, &args->options) : NULL;
    const bool ok = (definition || fail_memory(err)) && survey_open(survey, definition, costs, false, err);
    free(costs);
    return ok;
}

/* Runs several presets on the same capture, in alternating rounds. */
#include "compare/compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/sort.h"
#include "journal/again.h"
#include "options/pipeline_args.h"
#include "draw/view/pixels.h"

const char *const contest_over[CONTEST_OVER] = {"water", "transparent"};

static void label_of(char label[64], const char *preset) {
    const char *name = strrchr(preset, '/') ? strrchr(preset, '/') + 1 : preset;
    size_t length = strlen(name);
    if (length > 5 && !strcmp(name + length - 5, ".json")) length -= 5;
    snprintf(label, 64, "%.*s", (int)(length < 63 ? length : 63), name);
}

static struct contestant *find_contestant(const struct contest *contest, const char *label, size_t length) {
    for (size_t i = 0; i < contest->all_count; i++)
        if (strlen(contest->all[i].label) == length && !memcmp(contest->all[i].label, label, length))
            return &contest->all[i];
    return NULL;
}

static bool set_contestant(const struct contest *contest, const char *setting, struct glint_error *err) {
    const char *cut = strchr(setting, ':');
    if (!cut || cut == setting || !cut[1])
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "--set %s: expected PRESET:SLOT.PARAM=VALUE, such as kf2:resolve.blur=0", setting);
    const struct contestant *contestant = find_contestant(contest, setting, (size_t)(cut - setting));
    if (!contestant)
        return glint_fail(err, GLINT_ERROR_USAGE, "--set %s: preset %.*s is not among --presets", setting,
                          (int)(cut - setting), setting);
    struct glint_error own = {0};
    return glint_pipeline_set(contestant->pipeline, cut + 1, &own) ||
           glint_fail(err, own.code, "preset %s: %s", contestant->label, own.message);
}

bool contest_begin(struct contest *contest, const char *const *presets, const struct list *settings,
                   struct glint_error *err) {
    size_t count = 0;
    while (presets[count]) count++;
    contest->all = calloc(count + 1, sizeof *contest->all);
    contest->contestants = calloc(count + 1, sizeof *contest->contestants);
    if (!contest->all || !contest->contestants) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; i < count; i++) {
        struct contestant *c = &contest->all[i];
        label_of(c->label, presets[i]);
        if (find_contestant(contest, c->label, strlen(c->label)))
            return glint_fail(err, GLINT_ERROR_USAGE, "preset %s is listed twice in --presets", c->label);
        contest->all_count++;
        if (!(c->pipeline = glint_pipeline_create(presets[i], err)) || !pipeline_fog_off(c->pipeline, err))
            return false;
    }
    for (size_t i = 0; i < settings->count; i++)
        if (!set_contestant(contest, settings->items[i], err)) return false;
    return true;
}

void contest_finish(struct contest *contest) {
    for (size_t i = 0; i < contest->all_count; i++) glint_pipeline_destroy(&contest->all[i].pipeline);
    if (contest->judge) glint_judge_destroy(&contest->judge);
    free(contest->all);
    free(contest->contestants);
    contest->all = contest->contestants = NULL;
    contest->all_count = contest->count = 0;
}

/* Adds the name of a contestant to that of an earlier one that makes the same result; false if there is none. */
static bool joined(struct contest *contest, const struct contestant *c) {
    for (size_t k = 0; contest->join && k < contest->count; k++) {
        struct contestant *earlier = &contest->contestants[k];
        const size_t length = strlen(earlier->label);
        if (!glint_study_same(earlier->pipeline, c->pipeline, contest->effect)) continue;
        snprintf(earlier->label + length, sizeof earlier->label - length, " = %s", c->label);
        return true;
    }
    return false;
}

void contest_judge(struct contest *contest, const struct glint_effect *effect) {
    if (contest->judge) glint_judge_destroy(&contest->judge);
    contest->effect = effect;
    contest->count = 0;
    for (size_t i = 0; i < contest->all_count; i++) {
        if (contest->skip && !glint_study_made(contest->all[i].pipeline, effect)) continue;
        if (!joined(contest, &contest->all[i])) contest->contestants[contest->count++] = contest->all[i];
    }
}

static void answer_finish(struct answer *answer) {
    glint_verdict_finish(&answer->verdict);
    glint_pixels_finish(&answer->picture);
    *answer = (struct answer){0};
}

static bool same_reason(const struct glint_verdict_pass *a, const struct glint_verdict_pass *b) {
    return !a->ran && !b->ran && !strcmp(a->reason, b->reason);
}

/* "a, b left out: nothing reflects" where `a` is result i, once for all passes of that reason. */
static void note_reason(FILE *notes, const struct glint_verdict_pass *results, size_t count, size_t i) {
    if (results[i].ran) return;
    for (size_t k = 0; k < i; k++)
        if (same_reason(&results[k], &results[i])) return;
    if (ftell(notes) > 0) fputs("; ", notes);
    for (size_t k = i; k < count; k++)
        if (same_reason(&results[k], &results[i])) fprintf(notes, "%s%s", k > i ? ", " : "", results[k].pass->slot);
    fprintf(notes, " left out: %s", results[i].reason);
}

/* Records which passes ran, and a note of those that did not. */
static bool note_passes(struct showing *s, const struct glint_verdict *verdict, struct glint_error *err) {
    size_t size = 0;
    FILE *notes = open_memstream(&s->notes, &size);
    if (!notes) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    s->passes = json_array();
    for (size_t i = 0; i < verdict->pass_count; i++) {
        const struct glint_verdict_pass *p = &verdict->passes[i];
        json_array_append_new(s->passes, json_pack("{s:s, s:s, s:b, s:s}", "slot", p->pass->slot, "variant",
                                                   p->pass->variant, "ran", p->ran, "reason", p->reason));
    }
    for (size_t i = 0; i < verdict->pass_count; i++) note_reason(notes, verdict->passes, verdict->pass_count, i);
    return fclose(notes) == 0 || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

static void count_given(struct showing *s, const uint8_t *given, const uint8_t *labels, size_t pixels) {
    for (size_t i = 0; i < pixels; i++) {
        if (labels[i] == GLINT_CLASS_NONE) continue;
        s->judged[0]++;
        s->given[0] += given[i];
        if (labels[i] == GLINT_CLASS_UNKNOWN) continue;
        s->judged[labels[i]]++;
        s->given[labels[i]] += given[i];
    }
}

/* Errors over the pixels of a mask. */
static bool masked_errors(const struct answer *a, const uint8_t *mask, const uint8_t *labels,
                          struct glint_image_errors *errors, struct glint_error *err) {
    size_t pixels = (size_t)a->verdict.result.width * a->verdict.result.height;
    uint8_t *kept = malloc(pixels + 1);
    if (!kept) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; i < pixels; i++) kept[i] = mask[i] ? labels[i] : GLINT_CLASS_NONE;
    bool ok = glint_study_image(&a->verdict.result, a->truth, a->truth->components, kept, a->truth_error, errors, err);
    free(kept);
    return ok;
}

/* Compares the final image with the true one where water or glass covers opaque surfaces. */
static bool read_picture(struct glint_judge *judge, struct showing *s, struct answer *a, struct glint_error *err) {
    struct glint_replay *replay = glint_judge_replay(judge);
    const struct glint_image *image = glint_study_picture(replay);
    if (!image) return true;
    snprintf(a->picture_name, sizeof a->picture_name, "%s", image->name);
    bool ok = pixels_read(replay, image, &a->picture, err);
    for (int k = 0; ok && k < CONTEST_OVER; k++) {
        s->over[k].drawn = glint_study_reads_part(replay, contest_over[k]);
        ok =
            glint_study_overlay_error(&a->picture, glint_judge_capture(judge), contest_over[k], &s->over[k].error, err);
    }
    return ok;
}

/* Runs once with diagnostics for images and end reasons; timed rounds run without. */
static bool measure_contestant(const struct contest *contest, size_t i, struct showing *s, struct answer *a,
                               struct glint_error *err) {
    const struct glint_pipeline *pipeline = contest->contestants[i].pipeline;
    const uint8_t *labels = glint_judge_labels(contest->judge);
    progress_phase(contest->progress, "%.32s", contest->contestants[i].label);
    struct again again = {&cmd_compare, contest->device, &contest->judge, 1, 0, false};
    bool ok;
    do {
        answer_finish(a);
        ok = glint_judge_evaluate(contest->judge, pipeline, (uint32_t)i, &a->verdict, progress_report,
                                  contest->progress, err) &&
             read_picture(contest->judge, s, a, err);
    } while (!ok && again_try(&again, err, "preset %s", contest->contestants[i].label));
    if (!ok) return false;
    missing_add(contest->missing, glint_judge_replay(contest->judge));
    if (!note_passes(s, &a->verdict, err)) return false;
    s->ends = a->verdict.ends;
    s->steps_px = a->verdict.steps_px;
    s->fetches_px = a->verdict.fetches_px;
    count_given(s, a->verdict.coverage, labels, (size_t)a->verdict.result.width * a->verdict.result.height);
    s->compared = a->verdict.no_truth.code == GLINT_OK;
    snprintf(s->failure, sizeof s->failure, "%s", a->verdict.no_truth.message);
    if (!s->compared) return true;
    a->truth = glint_judge_target(contest->judge, GLINT_TARGET_TRUTH, pipeline, &a->truth_error, NULL, NULL, err);
    return a->truth && masked_errors(a, a->verdict.coverage, labels, &s->own, err);
}

/* Times one round in which every pass is executed, after a warm-up round. */
static bool time_round(const struct contest *contest, size_t i, struct showing *s, uint32_t round,
                       struct glint_error *err) {
    struct glint_cost cost;
    progress_phase(contest->progress, "%.24s, times", contest->contestants[i].label);
    struct again again = {&cmd_compare, contest->device, &contest->judge, 1, 0, false};
    bool ok;
    do
        ok = glint_judge_time(contest->judge, contest->contestants[i].pipeline, (uint32_t)i, true, &cost,
                              progress_report, contest->progress, err);
    while (!ok && again_try(&again, err, "preset %s, round %u", contest->contestants[i].label, round + 1));
    if (!ok) return false;
    s->frame_ms[round] = (double)cost.frame_ns * 1e-6;
    s->cubemaps_ms[round] = (double)cost.cubemaps_ns * 1e-6;
    glint_cost_finish(&cost);
    return true;
}

static struct contest_time statistics(double *ms, uint32_t n) {
    const double median = glint_median(ms, n);
    return (struct contest_time){n, ms[0], median, ms[n - 1]};
}

/* Whether a failure ends the comparison; other failures are recorded for the preset. */
static bool fail_alone(const struct contest *contest, struct showing *s, const struct contestant *c,
                       const struct glint_error *own, struct glint_error *err) {
    if (own->code == GLINT_ERROR_INTERRUPTED || own->code == GLINT_ERROR_MEMORY || glint_device_lost(contest->device))
        return glint_fail(err, own->code, "preset %s: %s", c->label, own->message);
    s->ran = s->compared = false;
    snprintf(s->failure, sizeof s->failure, "%s", own->message);
    return true;
}

/* Times presets in the order A B C A B C …, so that slow changes, such as of the device's clock, affect all equally. */
static bool take_turns(const struct contest *contest, struct showing *showings, struct glint_error *err) {
    for (uint32_t round = 0; round < contest->rounds; round++)
        for (size_t i = 0; i < contest->count; i++) {
            struct showing *s = &showings[i];
            struct glint_error own = {0};
            if (round == 0 && s->ran) {
                s->frame_ms = calloc(contest->rounds, sizeof *s->frame_ms);
                s->cubemaps_ms = calloc(contest->rounds, sizeof *s->cubemaps_ms);
                if (!s->frame_ms || !s->cubemaps_ms) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
            }
            if (s->ran && !time_round(contest, i, s, round, &own) &&
                !fail_alone(contest, s, &contest->contestants[i], &own, err))
                return false;
        }
    for (size_t i = 0; i < contest->count; i++) {
        if (!showings[i].ran) continue;
        showings[i].frame = statistics(showings[i].frame_ms, contest->rounds);
        showings[i].cubemaps = statistics(showings[i].cubemaps_ms, contest->rounds);
    }
    return true;
}

/* Errors over the pixels that all presets cover, so that covering only easy pixels is no advantage. */
static bool share_pixels(const struct contest *contest, struct showing *showings, const struct answer *answers,
                         const uint8_t *labels, size_t pixels, struct glint_error *err) {
    uint8_t *mask = malloc(pixels + 1);
    bool ok = mask || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (ok) memset(mask, 1, pixels);
    for (size_t i = 0; ok && i < contest->count; i++)
        for (size_t k = 0; showings[i].compared && showings[i].given[0] && k < pixels; k++)
            mask[k] &= answers[i].verdict.coverage[k];
    for (size_t i = 0; ok && i < contest->count; i++)
        if (showings[i].compared) ok = masked_errors(&answers[i], mask, labels, &showings[i].shared, err);
    free(mask);
    return ok;
}

static bool look_at_all(const struct contest *contest, struct showing *showings, struct answer *answers,
                        struct contest_pictures *pictures, struct glint_error *err) {
    const struct glint_pixels *truth = NULL;
    const uint8_t *labels = glint_judge_labels(contest->judge);
    for (size_t i = 0; i < contest->count; i++) {
        const struct contestant *c = &contest->contestants[i];
        struct glint_error own = {0};
        showings[i].ran = measure_contestant(contest, i, &showings[i], &answers[i], &own);
        if (showings[i].ran && pictures && !contest_draw(pictures, i + 1, c, &answers[i], labels, err)) return false;
        if (!showings[i].ran && !fail_alone(contest, &showings[i], c, &own, err)) return false;
        if (!truth && showings[i].compared) truth = answers[i].truth;
    }
    return !pictures || contest_draw_truth(pictures, truth, glint_judge_capture(contest->judge), err);
}

static bool load(struct contest *contest, struct glint_capture *capture, struct glint_error *err) {
    const struct glint_judge_options options = {.effect = contest->effect, .truth = true};
    return (contest->judge || (contest->judge = glint_judge_create(contest->device, &options, err))) &&
           glint_judge_load(contest->judge, capture, err);
}

/* The judge goes with the capture: presets share the images that it keeps, other captures do not. */
static void unload(struct contest *contest, struct answer *answers) {
    for (size_t i = 0; answers && i < contest->count; i++) answer_finish(&answers[i]);
    if (contest->judge) glint_judge_destroy(&contest->judge);
    free(answers);
}

bool contest_picture(struct contest *contest, struct glint_capture *capture, struct contest_pictures *pictures,
                     struct glint_error *err) {
    struct answer *answers = calloc(contest->count + 1, sizeof *answers);
    struct showing *showings = calloc(contest->count + 1, sizeof *showings);
    const bool ok = ((answers && showings) || fail_memory(err)) && load(contest, capture, err) &&
                    look_at_all(contest, showings, answers, pictures, err);
    for (size_t i = 0; showings && i < contest->count; i++) showing_finish(&showings[i]);
    unload(contest, answers);
    free(showings);
    return ok;
}

bool contest_run(struct contest *contest, struct glint_capture *capture, struct showing *showings,
                 struct contest_pictures *pictures, struct glint_error *err) {
    const struct glint_part_info *gbuffer = glint_capture_find(capture, "gbuffer");
    struct answer *answers = calloc(contest->count + 1, sizeof *answers);
    bool ok = (answers || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory")) && load(contest, capture, err) &&
              look_at_all(contest, showings, answers, pictures, err) &&
              share_pixels(contest, showings, answers, glint_judge_labels(contest->judge),
                           (size_t)gbuffer->width * gbuffer->height, err) &&
              take_turns(contest, showings, err);
    unload(contest, answers);
    return ok;
}

#include "pair.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "unit.h"

void pair_check(bool ok, const struct glint_error *err) {
    if (!ok) fail_msg("%s", err->message);
}

struct pair *pair_of(void **state) {
    struct pair *pair = *state;
    void *fixture = pair->fixture;
    fixture_need_device(&fixture);
    pair->falsify = NULL;
    return pair;
}

void pair_use(struct pair *pair, const char *preset) {
    struct glint_error err = {0};
    glint_pipeline_destroy(&pair->pipeline);
    glint_pipeline_destroy(&pair->other);
    pair->pipeline = glint_pipeline_create(preset, &err);
    pair_check(pair->pipeline != NULL, &err);
    if (strcmp(preset, "reference") != 0) /* passes run over a list of tiles, however many it contains */
        pair_check(glint_pipeline_set(pair->pipeline, "classify_tiles.max_coverage=1", &err), &err);
    /* a volume of light of one texel a face takes a tenth of a frame instead of most of it */
    if (pipeline_find(pair->pipeline, "volume_make"))
        pair_check(glint_pipeline_set(pair->pipeline, "volume_make.taps=1", &err), &err);
    if (glint_pipeline_rays(pair->pipeline) > 1)
        pair_check(glint_pipeline_set(pair->pipeline, "pipeline.rays=2", &err), &err);
}

/* Writes `text` with `right` replaced by `wrong`; false if it does not contain `right`. */
static bool write_wrong(const struct pair *pair, const char *path, const char *text, const char *right,
                        const char *wrong) {
    char full[400];
    const char *at = strstr(text, right);
    snprintf(full, sizeof full, "%s/%s", pair->fixture->folder, path);
    FILE *file = fopen(full, "w");
    assert_non_null(file);
    if (at) fprintf(file, "%.*s%s%s", (int)(at - text), text, wrong, at + strlen(right));
    else fputs(text, file);
    assert_int_equal(fclose(file), 0);
    return at != NULL;
}

void pair_spoil(struct pair *pair, const char *slot, const char *variant, const char *right, const char *wrong) {
    static const char maker[] = "shared/list_maker.glsl";
    struct glint_error err = {0};
    char path[300], assignment[400];
    snprintf(path, sizeof path, "%s/shared", pair->fixture->folder);
    (void)mkdir(path, 0777); /* it may exist */
    bool found = write_wrong(pair, maker, glint_pass_text(maker), right, wrong);
    snprintf(path, sizeof path, "%s/%s.comp", glint_pass_find(slot, variant)->folder, variant);
    found |= write_wrong(pair, "wrong.comp", glint_pass_text(path), right, wrong);
    assert_true(found);
    snprintf(assignment, sizeof assignment, "%s=%s/wrong.comp", slot, pair->fixture->folder);
    pair_check(glint_pipeline_shader(pair->pipeline, assignment, &err), &err);
}

int pair_set_up(void **state) {
    static struct pair pair;
    void *fixture = NULL;
    struct glint_error err = {0};
    if (fixture_setup_device(&fixture) != 0) return -1;
    pair.fixture = fixture;
    if (pair.fixture->device) {
        pair.planned = glint_replay_create(pair.fixture->device, &err);
        pair.whole = glint_replay_create(pair.fixture->device, &err);
        if (!pair.planned || !pair.whole) return -1;
    }
    *state = &pair;
    return 0;
}

int pair_tear_down(void **state) {
    struct pair *pair = *state;
    void *fixture = pair->fixture;
    glint_replay_destroy(&pair->planned);
    glint_replay_destroy(&pair->whole);
    glint_pipeline_destroy(&pair->pipeline);
    glint_pipeline_destroy(&pair->other);
    return fixture_teardown(&fixture);
}

/* The last picture that was made, of halves, which convert to floats without loss, or of floats. What a plan leaves out changes nothing, so that
   the one before is the same. */
static uint32_t *picture_of(struct glint_replay *replay, size_t *count) {
    static const char *const pictures[] = {
        "graded",       "exposed",      "bloomed",        "antialiased", "unstippled", "composed_transparent",
        "composed_fog", "composed_sky", "composed_water", "composed"};
    struct glint_error err = {0};
    const struct glint_image *image = NULL;
    for (size_t i = 0; i < sizeof pictures / sizeof *pictures && !image; i++)
        image = glint_replay_find_image(replay, pictures[i]);
    assert_non_null(image);
    *count = (size_t)image->width * image->height * image->components;
    uint32_t *bits = malloc(*count * sizeof *bits);
    assert_non_null(bits);
    pair_check(glint_replay_read_image(replay, image, GLINT_F32, bits, &err), &err);
    return bits;
}

/* Which NaN a device stores is not specified. */
static bool same_bits(uint32_t a, uint32_t b) {
    return a == b || ((a & 0x7FFFFFFF) > 0x7F800000 && (b & 0x7FFFFFFF) > 0x7F800000);
}

size_t pair_differences(struct pair *pair, struct glint_capture *capture, size_t *left_out) {
    struct glint_error err = {0};
    pair_check(glint_replay_load(pair->planned, capture, &err), &err);
    pair_check(glint_replay_load(pair->whole, capture, &err), &err);
    if (pair->falsify) {
        const struct glint_plan_entry *entries;
        size_t count;
        pair_check(glint_replay_plan(pair->planned, pair->pipeline, NULL, &entries, &count, &err), &err);
        pair->falsify(&pair->planned->planner.survey.figures);
    }
    struct glint_replay_options options = {.float_precision = pair->float_precision};
    pair_check(glint_replay_run(pair->planned, pair->pipeline, &options, NULL, NULL, &err), &err);
    options.all = true;
    pair_check(glint_replay_run(pair->whole, pair->other ? pair->other : pair->pipeline, &options, NULL, NULL, &err),
               &err);
    pair->last = pair->planned->planner.survey.figures;
    size_t counts[2], passes, differ = 0;
    const struct glint_pass_result *results = glint_replay_results(pair->planned, &passes);
    for (size_t i = 0; i < passes; i++) *left_out += !results[i].ran;
    uint32_t *bits[] = {picture_of(pair->planned, &counts[0]), picture_of(pair->whole, &counts[1])};
    assert_int_equal(counts[0], counts[1]);
    for (size_t i = 0; i < counts[0]; i++) differ += !same_bits(bits[0][i], bits[1][i]);
    free(bits[0]), free(bits[1]);
    return differ;
}

void pair_cube(uint32_t number, const double direction[3], float out[5]) {
    for (int k = 0; k < 3; k++) out[k] = (float)(1 + 0.5 * direction[k]) + (float)number;
    out[3] = 1;
    out[4] = 6;
}

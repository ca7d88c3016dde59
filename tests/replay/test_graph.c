/* Linking, ordering, dropping and errors with passes that are defined here. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "graph.h"
#include "survey.h"
#include "unit.h"

#define READS(image)                                                                                                   \
    { .kind = GLINT_ROW_READ, .name = image, .glsl = "texture2D" }
#define WRITES(image)                                                                                                  \
    { .kind = GLINT_ROW_WRITE, .name = image, .glsl = "image2D", .format = GLINT_FORMAT_R32F, .channels = "Z" }
#define DIAGNOSES(image)                                                                                               \
    { .kind = GLINT_ROW_DIAGNOSTIC, .name = image, .glsl = "image2D", .format = GLINT_FORMAT_R32F, .channels = "Z" }
#define NEEDED(fact)                                                                                                   \
    { .kind = GLINT_ROW_NEEDS, .name = fact }
#define MAY_READ(image)                                                                                                \
    { .kind = GLINT_ROW_READ, .name = image, .glsl = "texture2D", .format = GLINT_FORMAT_R32F, .optional = true }
#define DEFINE_PASS(name_, variant_, ...)                                                                              \
    static const struct glint_row name_##_rows[] = {__VA_ARGS__};                                                      \
    static const struct glint_pass name_ = {.slot = #name_,                                                            \
                                            .variant = variant_,                                                       \
                                            .rows = name_##_rows,                                                      \
                                            .row_count = sizeof name_##_rows / sizeof name_##_rows[0]}

/* The order is zeta → alpha → mid, unlike that of their names; side is independent. */
DEFINE_PASS(zeta, "v", READS("lit"), WRITES("z"));
DEFINE_PASS(alpha, "v", READS("z"), WRITES("a"), DIAGNOSES("why"));
DEFINE_PASS(mid, "v", READS("a"), WRITES("m"), NEEDED("yes"));
DEFINE_PASS(side, "v", READS("z"), WRITES("s"), NEEDED("no"));

struct pipeline {
    struct pipeline_pass passes[8];
    struct glint_pipeline pipeline;
};

static void make_pipeline(struct pipeline *made, const struct glint_pass *const *passes, size_t count) {
    *made = (struct pipeline){.pipeline = {.name = "made", .passes = made->passes, .count = count}};
    made->pipeline.passes = made->passes;
    for (size_t i = 0; i < count; i++) made->passes[i].pass = passes[i];
}
#define MAKE(made, ...)                                                                                                \
    make_pipeline(made, (const struct glint_pass *const[]){__VA_ARGS__},                                               \
                  sizeof((const struct glint_pass *const[]){__VA_ARGS__}) / sizeof(void *))

static enum fact_about about(const char *fact) {
    return strcmp(fact, "yes") == 0 || strcmp(fact, "no") == 0 ? FACT_PIXELS : FACT_UNKNOWN;
}
static bool holds(void *user, const char *fact, char *reason, size_t size, struct glint_error *err) {
    (void)user, (void)err;
    snprintf(reason, size, "%s of 10", strcmp(fact, "yes") == 0 ? "3" : "0");
    return strcmp(fact, "yes") == 0;
}

static bool link_all(struct graph *graph, const struct glint_pipeline *pipeline,
                     const struct glint_replay_options *options, struct glint_capture *capture,
                     struct glint_error *err) {
    const struct graph_inputs inputs = {options, capture, NULL, {holds, about, NULL}};
    const bool ok =
        graph_init(graph, pipeline, err) && graph_decide(graph, &inputs, err) && graph_link(graph, &inputs, err);
    if (!ok) graph_finish(graph);
    return ok;
}

static bool build(void **state, struct graph *graph, const struct pipeline *made, struct glint_replay_options options,
                  struct glint_error *err) {
    const struct fixture *fixture = *state;
    *err = (struct glint_error){0};
    return link_all(graph, &made->pipeline, &options, fixture->capture, err);
}

static void passes_run_in_the_order_of_their_images(void **state) {
    struct pipeline made;
    struct graph graph;
    struct glint_error err;
    MAKE(&made, &alpha, &mid, &side, &zeta);
    assert_true(build(state, &graph, &made, (struct glint_replay_options){0}, &err));
    const char *const order[] = {"zeta", "alpha", "mid",
                                 "side"}; /* side could run earlier: ties are resolved by name */
    for (size_t i = 0; i < 4; i++) assert_string_equal(graph.passes[i].pass->slot, order[i]);
    graph_finish(&graph);
}

static void what_the_frame_does_not_call_for_is_dropped_with_the_figure(void **state) {
    struct pipeline made;
    struct graph graph;
    struct glint_error err;
    MAKE(&made, &alpha, &mid, &side, &zeta);
    assert_true(build(state, &graph, &made, (struct glint_replay_options){0}, &err));
    assert_true(graph.passes[2].runs);
    assert_string_equal(graph.passes[2].reason, "3 of 10");
    assert_false(graph.passes[3].runs);
    assert_string_equal(graph.passes[3].reason, "0 of 10");
    assert_null(graph_find(&graph, "s"));
    graph_finish(&graph);
    assert_true(build(state, &graph, &made, (struct glint_replay_options){.all = true}, &err));
    assert_true(graph.passes[3].runs);
    graph_finish(&graph);
    const char *const force[] = {"side", NULL}, *const skip[] = {"mid", NULL};
    assert_true(build(state, &graph, &made, (struct glint_replay_options){.force = force, .skip = skip}, &err));
    assert_false(graph.passes[2].runs);
    assert_true(graph.passes[3].runs);
    graph_finish(&graph);
}

static void readers_of_a_dropped_pass_get_nothing(void **state) {
    struct pipeline made;
    struct graph graph;
    struct glint_error err;
    const char *const skip[] = {"zeta", NULL};
    MAKE(&made, &alpha, &mid, &zeta);
    assert_true(build(state, &graph, &made, (struct glint_replay_options){.skip = skip}, &err));
    assert_int_equal(graph_find(&graph, "z")->source, SOURCE_FALLBACK);
    assert_int_equal(graph_find(&graph, "a")->source, SOURCE_MADE);
    graph_finish(&graph);
}

/* A pass that writes an image like the capture's, and one that reads it. */
static void what_a_dropped_pass_would_have_passed_on_is_the_captures(void **state) {
    static const struct glint_row last[] = {
        READS("lit"), WRITES("l"), NEEDED("no"), {.kind = GLINT_ROW_ALIAS, .name = "lit", .image = "l"}};
    struct glint_row like[4];
    memcpy(like, last, sizeof like);
    like[1].format = GLINT_FORMAT_RGBA16F;
    const struct glint_pass unlike = {.slot = "last", .variant = "v", .rows = last, .row_count = 4};
    const struct glint_pass pass = {.slot = "last", .variant = "v", .rows = like, .row_count = 4};
    DEFINE_PASS(later, "v", READS("l"), WRITES("t"));
    const char *const outputs[] = {"t", NULL}, *const others[] = {"z", NULL}, *const skip[] = {"last", NULL};
    struct pipeline made;
    struct graph graph;
    struct glint_error err;
    MAKE(&made, &unlike);
    assert_false(build(state, &graph, &made, (struct glint_replay_options){0}, &err));
    fixture_says(&err, "ALIAS l: expected an image that the pass writes");
    MAKE(&made, &pass, &later, &zeta);
    assert_true(build(state, &graph, &made, (struct glint_replay_options){0}, &err));
    assert_false(graph.passes[0].runs);
    assert_string_equal(graph.passes[0].reason, "0 of 10, l is lit");
    assert_ptr_equal(graph_find(&graph, "l"), graph_find(&graph, "lit"));
    assert_int_equal(graph_find(&graph, "l")->source, SOURCE_CAPTURE);
    assert_true(graph_find(&graph, "l")->requested);
    graph_finish(&graph);
    assert_true(build(state, &graph, &made, (struct glint_replay_options){.outputs = outputs}, &err));
    assert_false(graph_find(&graph, "l")->requested);
    graph_finish(&graph);
    assert_true(build(state, &graph, &made, (struct glint_replay_options){.outputs = others}, &err));
    assert_null(graph_find(&graph, "l"));
    graph_finish(&graph);
    assert_true(build(state, &graph, &made, (struct glint_replay_options){.skip = skip}, &err));
    assert_int_equal(graph_find(&graph, "l")->source, SOURCE_FALLBACK); /* which is independent of the frame */
    graph_finish(&graph);
    char shader[] = "own.comp";
    made.passes[0].shader = shader;
    assert_true(build(state, &graph, &made, (struct glint_replay_options){0}, &err));
    assert_true(graph.passes[0].runs && graph_find(&graph, "l")->source == SOURCE_MADE);
    graph_finish(&graph);
}

static void only_what_wanted_images_need_runs(void **state) {
    struct pipeline made;
    struct graph graph;
    struct glint_error err;
    const char *const outputs[] = {"a", NULL};
    MAKE(&made, &alpha, &mid, &side, &zeta);
    assert_true(build(state, &graph, &made, (struct glint_replay_options){.outputs = outputs, .all = true}, &err));
    const bool runs[] = {true, true, false, false};
    for (size_t i = 0; i < 4; i++) assert_int_equal(graph.passes[i].runs, runs[i]);
    assert_true(graph_find(&graph, "a")->requested);
    assert_false(graph_find(&graph, "z")->requested);
    assert_int_equal(graph_find(&graph, "z")->last_use, 1);
    graph_finish(&graph);
}

static void diagnostic_images_exist_only_on_request(void **state) {
    struct pipeline made;
    struct graph graph;
    struct glint_error err;
    MAKE(&made, &alpha, &zeta);
    assert_true(build(state, &graph, &made, (struct glint_replay_options){0}, &err));
    assert_int_equal(graph_find(&graph, "why")->source, SOURCE_FALLBACK);
    assert_false(graph_find(&graph, "why")->requested);
    graph_finish(&graph);
    assert_true(build(state, &graph, &made, (struct glint_replay_options){.diagnostics = true}, &err));
    assert_int_equal(graph_find(&graph, "why")->source, SOURCE_MADE);
    assert_true(graph_find(&graph, "why")->requested);
    graph_finish(&graph);
    const char *const outputs[] = {"why", NULL};
    assert_false(build(state, &graph, &made, (struct glint_replay_options){.outputs = outputs}, &err));
    fixture_says(&err, "why is a diagnostic image");
    /* they need not be listed, but the passes that write them must run */
    const char *const others[] = {"a", NULL}, *const before[] = {"z", NULL};
    assert_true(
        build(state, &graph, &made, (struct glint_replay_options){.outputs = others, .diagnostics = true}, &err));
    assert_true(graph_find(&graph, "why")->requested && graph_find(&graph, "a")->requested);
    graph_finish(&graph);
    assert_true(
        build(state, &graph, &made, (struct glint_replay_options){.outputs = before, .diagnostics = true}, &err));
    assert_null(graph_find(&graph, "why"));
    graph_finish(&graph);
}

static void a_missing_input_names_the_pass_that_makes_it(void **state) {
    struct pipeline made;
    struct graph graph;
    struct glint_error err;
    const char *const only[] = {"mid", NULL};
    MAKE(&made, &alpha, &mid, &zeta);
    assert_false(build(state, &graph, &made, (struct glint_replay_options){.passes = only}, &err));
    fixture_says(&err, "mid/v reads a, which alpha makes; it does not run");
    DEFINE_PASS(reader, "v", READS("depth_half"), READS("unheard_of"), WRITES("r"));
    MAKE(&made, &reader);
    assert_false(build(state, &graph, &made, (struct glint_replay_options){0}, &err));
    fixture_says(
        &err,
        "reads depth_half, which downsample makes; that slot is empty in the pipeline (variants: bilinear, mips, ");
    fixture_says(&err, "unheard_of, which no known pass writes");
}

static void two_producers_are_a_fault(void **state) {
    DEFINE_PASS(second, "w", WRITES("z"));
    DEFINE_PASS(third, "w", WRITES("lit"));
    struct pipeline made;
    struct graph graph;
    struct glint_error err;
    MAKE(&made, &second, &third, &zeta);
    assert_false(build(state, &graph, &made, (struct glint_replay_options){0}, &err));
    fixture_says(&err, "image z has two producers: second/w and zeta/v");
    fixture_says(&err, "image lit has two producers: third/w and the capture");
}

static void a_cycle_names_its_members_only(void **state) {
    DEFINE_PASS(one, "v", READS("q"), WRITES("p"));
    DEFINE_PASS(two, "v", READS("p"), WRITES("q"));
    DEFINE_PASS(behind, "v", READS("q"), WRITES("b"));
    struct pipeline made;
    struct graph graph;
    struct glint_error err;
    MAKE(&made, &behind, &one, &two, &zeta);
    assert_false(build(state, &graph, &made, (struct glint_replay_options){0}, &err));
    fixture_says(&err, "in a cycle: one, two");
    assert_null(strstr(err.message, "behind"));
}

/* The slot blur is known: one of its variants reads untraced. */
static void what_a_pass_leaves_to_another_has_to_be_read_by_it(void **state) {
    static const char why[] = "holes would stay";
    DEFINE_PASS(sparse, "v", WRITES("untraced"), WRITES("z"),
                {.kind = GLINT_ROW_NEEDS_READER, .name = "untraced", .image = "blur", .help = why});
    DEFINE_PASS(lists, "v", READS("untraced"), WRITES("l"));
    DEFINE_PASS(blur, "made", READS("z"), WRITES("b"));
    DEFINE_PASS(filler, "filling", READS("z"), READS("untraced"), WRITES("b"));
    struct glint_pass filling = filler;
    struct pipeline made;
    struct graph graph;
    struct glint_error err;
    filling.slot = "blur";
    MAKE(&made, &sparse, &lists);
    assert_false(build(state, &graph, &made, (struct glint_replay_options){0}, &err));
    fixture_says(&err, "sparse/v makes untraced, which slot blur has to read (variants: upscale_blur), but it is "
                       "empty; holes would stay");
    MAKE(&made, &sparse, &lists, &blur);
    assert_false(build(state, &graph, &made, (struct glint_replay_options){0}, &err));
    fixture_says(&err, "but it holds made; holes would stay");
    MAKE(&made, &sparse, &filling);
    if (!build(state, &graph, &made, (struct glint_replay_options){0}, &err)) fail_msg("%s", err.message);
    graph_finish(&graph);
}

static void all_faults_come_together(void **state) {
    DEFINE_PASS(odd, "v", READS("gone"), WRITES("z"), NEEDED("maybe"));
    struct pipeline made;
    struct graph graph;
    struct glint_error err;
    const char *const skip[] = {"nobody", NULL}, *const outputs[] = {"z", "nowhere", NULL};
    MAKE(&made, &odd, &zeta);
    assert_false(build(state, &graph, &made, (struct glint_replay_options){.skip = skip, .outputs = outputs}, &err));
    fixture_says(&err, "two producers: odd/v and zeta/v");
    fixture_says(&err, "gone, which no known pass writes");
    fixture_says(&err, "unknown fact 'maybe'");
    fixture_says(&err, "skip: no slot 'nobody'");
    fixture_says(&err, "no pass writes 'nowhere'");
}

static void images_are_read_as_what_they_are(void **state) {
    DEFINE_PASS(wrong, "v", {.kind = GLINT_ROW_READ, .name = "z", .glsl = "utexture2D"},
                {.kind = GLINT_ROW_READ, .name = "sky", .glsl = "texture2D"}, WRITES("w"));
    struct pipeline made;
    struct graph graph;
    struct glint_error err;
    MAKE(&made, &wrong, &zeta);
    assert_false(build(state, &graph, &made, (struct glint_replay_options){0}, &err));
    fixture_says(&err, "wrong/v reads z as utexture2D, but it is a float image");
    fixture_says(&err, "wrong/v reads sky as texture2D, but it is a cube map");
}

static void what_is_assumed_is_a_number_of_the_pass(void **state) {
    DEFINE_PASS(sure, "v", WRITES("w"), {.kind = GLINT_ROW_PUSH, .name = "there"},
                {.kind = GLINT_ROW_ASSUMED, .name = "there"}, {.kind = GLINT_ROW_ASSUMED, .name = "w"});
    struct pipeline made;
    struct graph graph;
    struct glint_error err;
    MAKE(&made, &sure);
    assert_false(build(state, &graph, &made, (struct glint_replay_options){0}, &err));
    fixture_says(&err, "sure/v: ASSUMED w: expected a numeric parameter");
    assert_null(strstr(err.message, "there"));
}

/* Every pipeline of the table links, so the declarations of all passes are consistent. */
static void the_real_passes_link(void **state) {
    const struct fixture *fixture = *state;
    struct graph graph;
    struct glint_error err = {0};
    const struct glint_replay_options options = {.all = true, .diagnostics = true};
    if (!link_all(&graph, fixture->pipeline, &options, fixture->capture, &err)) fail_msg("%s", err.message);
    for (size_t i = 0; i < graph.image_count; i++) {
        size_t channels = 0, components[] = {1, 1, 1, 2, 4, 1, 2, 4};
        if (!graph.images[i].pass) continue;
        for (const char *at = graph.images[i].row->channels; *at; at += strcspn(at, " "), at += strspn(at, " "))
            channels++;
        if (channels != components[graph.images[i].row->format])
            fail_msg("%s: channels and format disagree", graph.images[i].name);
    }
    graph_finish(&graph);
}

/* Catches: a fact that omits the limit itself, pixels that do not reflect, and invalid values. */
static void smooth_and_rough_pixels_are_facts(void **state) {
    const struct fixture *fixture = *state;
    struct glint_survey survey;
    struct glint_error err = {0};
    char reason[192];
    assert_true(glint_survey_capture(fixture->capture, &survey, &err));
    assert_true(survey.reflecting.roughness[0] <= 0.1f && survey.reflecting.roughness[1] > 0.1f);
    survey = (struct glint_survey){.pixels = 10, .reflecting = {.count = 4, .roughness = {0.05f, 0.1f}}};
    assert_true(survey_fact(&survey, false, "smooth 0.05", reason, sizeof reason));
    assert_string_equal(reason, "the smoothest of 4 reflecting pixels has roughness 0.05, required: at most 0.05");
    assert_false(survey_fact(&survey, false, "smooth 0.04", reason, sizeof reason));
    assert_true(survey_fact(&survey, false, "rough 0.1", reason, sizeof reason));
    assert_false(survey_fact(&survey, false, "rough 0.11", reason, sizeof reason));
    assert_string_equal(reason, "the roughest of 4 reflecting pixels has roughness 0.1, required: at least 0.11");
    assert_true(survey_fact(&survey, false, "cones", reason, sizeof reason));
    survey.reflecting.roughness[1] = 0;
    assert_false(survey_fact(&survey, false, "cones", reason, sizeof reason));
    assert_false(survey_fact(&survey, true, "reflecting", reason, sizeof reason)); /* no surface at all */
    float pixels[5][4] = {{1, 0.1f, 0, 1}, {1, 0.3f, 0, NAN}, {1, NAN, 0.5f, 0}, {1, 1, 0, 0}, {INFINITY, 1, 1, 1}};
    const char *names[] = {"depth.Z", "material.roughness", "material.metalness", "material.specular"};
    const struct glint_part_info part = {.width = 5, .height = 1};
    survey = (struct glint_survey){0};
    survey_channels(&(struct channels){.part = &part, .names = names, .count = 4, .data = &pixels[0][0]}, &survey);
    assert_int_equal(survey.sky, 1);
    assert_int_equal(survey.surfaces.count, 4);
    assert_int_equal(survey.reflecting.count, 3);
    assert_true(survey.reflecting.roughness[0] == 0 && survey.surfaces.roughness[1] == 1);
    assert_true(fabsf(survey.reflecting.roughness[1] - 0.3f) < 0.3f / 2048); /* half precision */
}

/* Catches: passes of the ray loop that are not consecutive, or that another pass interrupts although it could wait. */
static void passes_for_each_ray_stand_together(void **state) {
    DEFINE_PASS(a_late, "v", READS("r2"), WRITES("l"));
    DEFINE_PASS(b_ray, "v", READS("e"), WRITES("r1"), {.kind = GLINT_ROW_PER_RAY, .name = ""});
    DEFINE_PASS(c_aside, "v", READS("r1"), WRITES("x"));
    DEFINE_PASS(d_ray, "v", READS("r1"), WRITES("r2"), {.kind = GLINT_ROW_PER_RAY, .name = ""});
    DEFINE_PASS(z_early, "v", READS("lit"), WRITES("e"));
    static const char *const expected[] = {"z_early", "b_ray", "d_ray", "a_late", "c_aside"};
    struct pipeline made;
    struct graph graph;
    struct glint_error err;
    MAKE(&made, &a_late, &b_ray, &c_aside, &d_ray, &z_early);
    made.pipeline.rays = 2;
    if (!build(state, &graph, &made, (struct glint_replay_options){0}, &err)) fail_msg("%s", err.message);
    for (size_t i = 0; i < 5; i++) assert_string_equal(graph.passes[i].pass->slot, expected[i]);
    assert_int_equal(graph.loop_first, 1);
    assert_int_equal(graph.loop_end, 3);
    assert_int_equal(graph_find(&graph, "e")->last_use, 2); /* each ray reads it again */
    graph_finish(&graph);
}

/* Several images call for one pass, each with a fact of its own. Catches: a pass that runs for an image whose fact does not hold or that no pass
   makes, one that is dropped although one image calls for it, and inputs that are asked of the capture without reason. */
static void one_image_of_several_calls_for_a_pass(void **state) {
    DEFINE_PASS(a_maker, "v", READS("lit"), WRITES("a"));
    DEFINE_PASS(b_maker, "v", READS("lit"), WRITES("b"));
    DEFINE_PASS(picture, "v", MAY_READ("a"), MAY_READ("b"),
                {.kind = GLINT_ROW_READ,
                 .name = "stencil_full",
                 .glsl = "utexture2D",
                 .optional = true,
                 .beside = "c b",
                 .format = GLINT_FORMAT_R8UI},
                WRITES("p"), {.kind = GLINT_ROW_CALLED_BY, .name = "yes", .image = "a"},
                {.kind = GLINT_ROW_CALLED_BY, .name = "no", .image = "b"});
    static const char *const only[] = {"picture", NULL};
    struct pipeline made;
    struct graph graph;
    struct glint_error err;
    MAKE(&made, &a_maker, &b_maker, &picture);
    if (!build(state, &graph, &made, (struct glint_replay_options){0}, &err)) fail_msg("%s", err.message);
    assert_true(graph.passes[2].runs);
    assert_string_equal(graph.passes[2].reason, "3 of 10");
    assert_null(graph_find(&graph, "stencil_full")->pass); /* an image of the capture, whether it has it or not */
    assert_int_equal(graph_find(&graph, "stencil_full")->row->kind, GLINT_ROW_CAPTURE);
    graph_finish(&graph);
    MAKE(&made, &b_maker, &picture); /* its fact does not hold */
    assert_true(build(state, &graph, &made, (struct glint_replay_options){0}, &err));
    assert_false(graph.passes[1].runs);
    assert_string_equal(graph.passes[1].reason, "0 of 10");
    graph_finish(&graph);
    MAKE(&made, &a_maker, &picture); /* without the other one, the capture is not asked for what is read beside it */
    assert_true(build(state, &graph, &made, (struct glint_replay_options){0}, &err));
    assert_true(graph.passes[1].runs);
    assert_int_equal(graph_find(&graph, "stencil_full")->row->kind, GLINT_ROW_READ);
    assert_int_equal(graph_find(&graph, "b")->source, SOURCE_FALLBACK);
    graph_finish(&graph);
    assert_false(build(state, &graph, &made, (struct glint_replay_options){.passes = only}, &err));
    fixture_says(&err,
                 "picture/v reads a, which a_maker makes"); /* what calls for the pass has to come from somewhere */
    MAKE(&made, &picture);
    assert_false(build(state, &graph, &made, (struct glint_replay_options){0}, &err));
    fixture_says(&err, "picture/v reads a, which no known pass writes");
}

/* Catches: passes that run although the picture does without their images, and ones left out that a parameter, a shader or the caller uses. */
static void what_another_image_takes_the_place_of_is_left_out(void **state) {
    static const char why[] = "the light replaces it", *const images[] = {"f", NULL};
    DEFINE_PASS(estimate, "v", READS("lit"), WRITES("e"));
    DEFINE_PASS(finish, "v", READS("e"), WRITES("f"));
    DEFINE_PASS(
        picture, "v", MAY_READ("f"), MAY_READ("z"), WRITES("p"),
        {.kind = GLINT_ROW_SPEC, .name = "on", .type = GLINT_VALUE_BOOL},
        {.kind = GLINT_ROW_SPEC, .name = "off", .type = GLINT_VALUE_BOOL},
        {.kind = GLINT_ROW_IN_PLACE_OF, .name = "z", .image = "f", .assigned = "on", .source = "off", .help = why});
    const struct {
        double on, off;
        bool alone, shader, runs;
        struct glint_replay_options options;
    } cases[] = {{.on = 1},
                 {.runs = true},
                 {.on = 1, .off = 1, .runs = true},
                 {.on = 1, .runs = true, .alone = true},
                 {.on = 1, .runs = true, .shader = true},
                 {.on = 1, .runs = true, .options = {.results = images}},
                 {.on = 1, .runs = true, .options = {.all = true}}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        struct pipeline made;
        struct graph graph;
        struct glint_error err;
        MAKE(&made, &estimate, &finish, &picture, &zeta);
        made.pipeline.count -= cases[c].alone;
        made.passes[2].values = (double[]){0, 0, 0, cases[c].on, cases[c].off, 0}; /* beside its rows */
        made.passes[2].shader = cases[c].shader ? (char *)"own.comp" : NULL;
        if (!build(state, &graph, &made, cases[c].options, &err)) fail_msg("%zu: %s", c, err.message);
        for (size_t i = 0; i < 2; i++) { /* estimate and finish */
            assert_int_equal(graph.passes[i].runs, cases[c].runs);
            if (!cases[c].runs) assert_string_equal(graph.passes[i].reason, why);
        }
        graph_finish(&graph);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_image_of_several_calls_for_a_pass),
        cmocka_unit_test(what_another_image_takes_the_place_of_is_left_out),
        cmocka_unit_test(smooth_and_rough_pixels_are_facts),
        cmocka_unit_test(passes_for_each_ray_stand_together),
        cmocka_unit_test(passes_run_in_the_order_of_their_images),
        cmocka_unit_test(what_the_frame_does_not_call_for_is_dropped_with_the_figure),
        cmocka_unit_test(readers_of_a_dropped_pass_get_nothing),
        cmocka_unit_test(what_a_dropped_pass_would_have_passed_on_is_the_captures),
        cmocka_unit_test(only_what_wanted_images_need_runs),
        cmocka_unit_test(diagnostic_images_exist_only_on_request),
        cmocka_unit_test(a_missing_input_names_the_pass_that_makes_it),
        cmocka_unit_test(two_producers_are_a_fault),
        cmocka_unit_test(what_a_pass_leaves_to_another_has_to_be_read_by_it),
        cmocka_unit_test(a_cycle_names_its_members_only),
        cmocka_unit_test(all_faults_come_together),
        cmocka_unit_test(images_are_read_as_what_they_are),
        cmocka_unit_test(what_is_assumed_is_a_number_of_the_pass),
        cmocka_unit_test(the_real_passes_link),
    };
    return cmocka_run_group_tests(tests, fixture_setup_host, fixture_teardown);
}

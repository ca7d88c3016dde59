/* Which slots are replaced by their references together, and the pipelines of coalitions. */
#include <stdio.h>
#include <string.h>

#include "fixture.h"
#include "glint/blame.h"
#include "glint/study.h"
#include "graph.h"
#include "unit.h"

static struct glint_pipeline *preset(const char *name) {
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = glint_pipeline_create(name, &err);
    if (!pipeline) fail_msg("%s", err.message);
    return pipeline;
}

static struct glint_players *players_of(const struct glint_pipeline *pipeline, uint32_t rays) {
    struct glint_error err = {0};
    struct glint_players *players = glint_players_create(pipeline, glint_effect_find("reflection"), rays, &err);
    if (!players) fail_msg("%s", err.message);
    return players;
}

static size_t player(const struct glint_players *players, const char *name) {
    for (size_t p = 0; p < glint_players_count(players); p++)
        if (!strcmp(glint_player_name(players, p), name)) return p;
    fail_msg("no player %s", name);
    return 0;
}

static struct glint_pipeline *exchanged(const struct glint_players *players, uint32_t coalition) {
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = glint_players_pipeline(players, coalition, &err);
    if (!pipeline) fail_msg("%x: %s", coalition, err.message);
    return pipeline;
}

static const char *const presets[] = {"mafia3", "mafia3_shipped", "mafia_de", "mafia_de_levels", "kf2", "gtav"};
enum { PRESETS = sizeof presets / sizeof *presets };

/* The references that passes declare equal those of the preset. */
static void declarations_are_the_preset(UNUSED void **state) {
    struct glint_pipeline *reference = preset("reference");
    size_t count, references = 0;
    const struct glint_pass *passes = glint_passes(&count);
    for (size_t i = 0; i < count; i++) {
        const struct pipeline_pass *entry = pipeline_find(reference, passes[i].slot);
        const bool is = glint_pass_row(&passes[i], GLINT_ROW_REFERENCE, NULL) != NULL;
        if (is != (entry && entry->pass == &passes[i]))
            fail_msg("%s/%s: declared %d, in the preset %s", passes[i].slot, passes[i].variant, is,
                     entry ? entry->pass->variant : "none");
        if (!!glint_pass_row(&passes[i], GLINT_ROW_REFERENCE_NONE, NULL) == (entry != NULL))
            fail_msg("%s: both a reference and left out, or neither", passes[i].slot);
        references += is;
    }
    assert_int_equal(references, reference->count);
    glint_pipeline_destroy(&reference);
}

/* Chains that no pass writes cannot provide cones: the player of rays is separate from that of cube maps. */
static void what_is_not_there_joins_nothing(UNUSED void **state) {
    struct glint_pipeline *kf2 = preset("kf2"), *mafia3 = preset("mafia3");
    struct glint_players *alone = players_of(kf2, 4), *with = players_of(mafia3, 4);
    assert_string_equal(glint_player_change(alone, player(alone, "downsample")), "downsample none by its values");
    assert_non_null(strstr(glint_player_change(with, player(with, "downsample")), "cubemap_mips prefilter"));
    for (uint32_t coalition = 0; coalition < 1u << glint_players_count(alone); coalition++) {
        struct glint_pipeline *between = exchanged(alone, coalition);
        glint_pipeline_destroy(&between);
    }
    glint_players_destroy(&alone);
    glint_players_destroy(&with);
    glint_pipeline_destroy(&kf2);
    glint_pipeline_destroy(&mafia3);
}

/* Applying every declared value to the references' defaults gives the preset's values. */
static void declared_values_are_the_presets(UNUSED void **state) {
    struct glint_pipeline *reference = preset("reference"), *made = preset("reference");
    struct glint_error err = {0};
    for (size_t i = 0; i < made->count; i++)
        for (size_t r = 0; r < made->passes[i].pass->row_count; r++)
            if (glint_row_is_parameter(&made->passes[i].pass->rows[r]))
                made->passes[i].values[r] = made->passes[i].pass->rows[r].initial;
    for (size_t i = 0; i < made->count; i++)
        for (size_t r = 0; r < made->passes[i].pass->row_count; r++) {
            const struct glint_row *row = &made->passes[i].pass->rows[r];
            char assignment[200];
            if (row->kind != GLINT_ROW_REFERENCE_SET) continue;
            snprintf(assignment, sizeof assignment, "%s.%s=%s", row->image, row->name, row->assigned);
            if (!glint_pipeline_set(made, assignment, &err)) fail_msg("%s", err.message);
        }
    for (size_t i = 0; i < made->count; i++)
        for (size_t r = 0; r < made->passes[i].pass->row_count; r++)
            if (made->passes[i].values[r] != reference->passes[i].values[r])
                fail_msg("%s.%s: declared %g, in the preset %g", made->passes[i].pass->slot,
                         made->passes[i].pass->rows[r].name, made->passes[i].values[r], reference->passes[i].values[r]);
    glint_pipeline_destroy(&reference);
    glint_pipeline_destroy(&made);
}

static void players_run_from_the_last_to_the_first(UNUSED void **state) {
    struct glint_pipeline *pipeline = preset("mafia3");
    struct glint_players *players = players_of(pipeline, 0);
    static const char *const names[] = {"upscale",      "temporal",   "blur", "cubemap_trace",
                                        "screen_trace", "downsample", "rays"};
    assert_int_equal(glint_players_count(players), sizeof names / sizeof *names);
    for (size_t p = 0; p < glint_players_count(players); p++)
        assert_string_equal(glint_player_name(players, p), names[p]);
    assert_string_equal(glint_player_change(players, 6), "pipeline.rays 1 → 32");
    /* Joined because of images: the trace reads a pyramid that the reference does not write. The others by declarations. */
    assert_non_null(strstr(glint_player_why(players, 4), "screen_trace/hiz reads hiz, which only hiz/nearest makes"));
    assert_non_null(strstr(glint_player_change(players, 5), "lit_mips cone left out"));
    assert_non_null(strstr(glint_player_why(players, 5), "lit_mips: its levels represent the cones"));
    assert_string_equal(glint_player_why(players, 2), "");
    glint_players_destroy(&players);
    glint_pipeline_destroy(&pipeline);
}

/* A slot that reads images which only one variant of another slot writes cannot be replaced alone. */
static void shared_images_join_slots(UNUSED void **state) {
    struct glint_pipeline *pipeline = preset("mafia_de");
    struct glint_players *players = players_of(pipeline, 0);
    const size_t p = player(players, "downsample+upscale");
    assert_non_null(strstr(glint_player_change(players, p), "blur upscale_blur left out"));
    assert_non_null(
        strstr(glint_player_why(players, p), "upscale/edges reads edge_levels, which only downsample/mips makes"));
    glint_players_destroy(&players);
    glint_pipeline_destroy(&pipeline);
}

static enum fact_about about(UNUSED const char *fact) {
    return FACT_PARTS;
}
static bool holds(void *user, const char *fact, char *reason, size_t size, struct glint_error *err) {
    (void)user, (void)fact, (void)err;
    snprintf(reason, size, "made up");
    return true;
}

/* Catches: a coalition in which a pass reads an image that none writes, or two write the same one. */
static void every_coalition_is_a_pipeline(void **state) {
    const struct fixture *fixture = *state;
    for (size_t i = 0; i < PRESETS; i++) {
        struct glint_pipeline *pipeline = preset(presets[i]);
        struct glint_players *players = players_of(pipeline, 0);
        for (uint32_t c = 0; c < 1u << glint_players_count(players); c++) {
            struct glint_pipeline *made = exchanged(players, c);
            const struct glint_replay_options options = {0};
            struct graph graph;
            struct glint_error err = {0};
            const struct graph_inputs inputs = {&options, fixture->capture, NULL, {holds, about, NULL}};
            if (!graph_init(&graph, made, &err) || !graph_decide(&graph, &inputs, &err) ||
                !graph_link(&graph, &inputs, &err))
                fail_msg("%s, coalition %x: %s", presets[i], c, err.message);
            graph_finish(&graph);
            glint_pipeline_destroy(&made);
        }
        glint_players_destroy(&players);
        glint_pipeline_destroy(&pipeline);
    }
}

/* Every pass of `made` except compose equals that of `model`, and none that the reflection depends on is missing. */
static void assert_same(const struct glint_pipeline *made, const struct glint_pipeline *model) {
    for (size_t i = 0; i < made->count; i++) {
        const struct pipeline_pass *theirs = pipeline_find(model, made->passes[i].pass->slot);
        if (!strcmp(made->passes[i].pass->slot, "compose")) continue;
        if (!theirs || theirs->pass != made->passes[i].pass)
            fail_msg("%s/%s is not in %s", made->passes[i].pass->slot, made->passes[i].pass->variant, model->name);
        for (size_t r = 0; r < theirs->pass->row_count; r++)
            if (theirs->values[r] != made->passes[i].values[r])
                fail_msg("%s.%s: %g, in %s %g", theirs->pass->slot, theirs->pass->rows[r].name,
                         made->passes[i].values[r], model->name, theirs->values[r]);
    }
    for (size_t i = 0; i < model->count; i++) {
        const char *slot = model->passes[i].pass->slot;
        if (strstr(slot, "transparen") || strstr(slot, "water") || !strcmp(slot, "planar")) continue;
        const char *effect = model->passes[i].pass->effect;
        if (glint_effect_find(effect) && strcmp(effect, "reflection") != 0) continue;
        if (!pipeline_find(made, slot)) fail_msg("%s of %s is missing", slot, model->name);
    }
    assert_int_equal(glint_pipeline_rays(made), glint_pipeline_rays(model));
}

static void ends_are_the_preset_and_its_reference(UNUSED void **state) {
    for (size_t i = 0; i < PRESETS; i++) {
        struct glint_error err = {0};
        struct glint_pipeline *pipeline = preset(presets[i]), *reference = glint_study_reference(pipeline, &err);
        struct glint_players *players = players_of(pipeline, 0);
        struct glint_pipeline *none = exchanged(players, 0),
                              *all = exchanged(players, (1u << glint_players_count(players)) - 1);
        assert_same(none, pipeline);
        assert_same(all, reference);
        assert_int_not_equal(all->first_ray, reference->first_ray); /* no ray is compared with itself */
        glint_pipeline_destroy(&none);
        glint_pipeline_destroy(&all);
        glint_players_destroy(&players);
        glint_pipeline_destroy(&reference);
        glint_pipeline_destroy(&pipeline);
    }
}

static double value(const struct glint_pipeline *pipeline, const char *slot, const char *name) {
    const struct pipeline_pass *entry = pipeline_find(pipeline, slot);
    for (size_t r = 0; entry && r < entry->pass->row_count; r++)
        if (glint_row_is_parameter(&entry->pass->rows[r]) && !strcmp(entry->pass->rows[r].name, name))
            return entry->values[r];
    fail_msg("no %s.%s", slot, name);
    return 0;
}

/* How distances are filtered is a parameter of cubemap_trace's player, whichever variant writes the chain. */
static void values_go_with_their_owners(UNUSED void **state) {
    struct glint_pipeline *pipeline = preset("mafia3");
    struct glint_players *players = players_of(pipeline, 7);
    const uint32_t trace = 1u << player(players, "cubemap_trace"), down = 1u << player(players, "downsample");
    for (uint32_t c = 0; c < 1u << glint_players_count(players); c++) {
        struct glint_pipeline *made = exchanged(players, c);
        assert_true(value(made, "cubemap_mips", "join") == (c & trace ? 1 : 0)); /* mean, nearest */
        assert_string_equal(pipeline_find(made, "cubemap_mips")->pass->variant, c & down ? "plain" : "prefilter");
        assert_true(value(made, "downsample", "share") == (c & down ? 1 : 0.25));
        assert_int_equal(glint_pipeline_rays(made), c >> player(players, "rays") & 1 ? 7 : 1);
        glint_pipeline_destroy(&made);
    }
    glint_players_destroy(&players);
    glint_pipeline_destroy(&pipeline);
}

static void the_reference_has_no_players(UNUSED void **state) {
    struct glint_pipeline *pipeline = preset("reference");
    struct glint_error err = {0};
    assert_null(glint_players_create(pipeline, glint_effect_find("reflection"), 0, &err));
    assert_non_null(strstr(err.message, "no slot differs from the reference"));
    assert_true(glint_pipeline_set(pipeline, "screen_trace.solid=1", &err));
    struct glint_players *players = players_of(pipeline, 0);
    assert_int_equal(glint_players_count(players), 1);
    assert_string_equal(glint_player_change(players, 0), "screen_trace dda by its values");
    glint_players_destroy(&players);
    glint_pipeline_destroy(&pipeline);
}

/* Catches: players of an effect that are slots of another one, and those that only the picture depends on. */
static void players_belong_to_the_effect(void **state) {
    static const struct glint_effect
        far = {.name = "far", .noun = "lit levels", .results = {"reflection"}, .channels = "R G B"},
        none = {.name = "none", .noun = "nothing", .results = {"nowhere"}, .channels = "R G B"};
    (void)state;
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = glint_pipeline_create("mafia3", &err);
    assert_non_null(pipeline);
    struct glint_players *whole = glint_players_create(pipeline, glint_effect_find("reflection"), 4, &err),
                         *part = glint_players_create(pipeline, &far, 4, &err);
    assert_true(whole && part);
    bool sharp[2] = {false, false};
    for (size_t i = 0; i < glint_players_count(whole); i++)
        sharp[0] |= strstr(glint_player_change(whole, i), "_sharp") != NULL;
    for (size_t i = 0; i < glint_players_count(part); i++)
        sharp[1] |= strstr(glint_player_change(part, i), "_sharp") != NULL;
    assert_true(sharp[0] && !sharp[1]); /* what replaces that image is behind it */
    struct glint_pipeline *cut = glint_players_pipeline(part, 0, &err);
    assert_non_null(cut);
    assert_null(glint_pipeline_find(cut, "resolve_sharp"));
    assert_non_null(glint_pipeline_find(cut, "upscale"));
    assert_null(glint_players_create(pipeline, &none, 4, &err));
    assert_non_null(strstr(err.message, "no pass of it makes nothing"));
    glint_pipeline_destroy(&cut);
    glint_players_destroy(&whole);
    glint_players_destroy(&part);
    glint_pipeline_destroy(&pipeline);
}

/* Catches: slots of two effects in one player of the picture, an effect without one, and presets whose results differ taken for one. */
static void the_picture_is_played_by_effects(UNUSED void **state) {
    struct glint_error err = {0};
    struct glint_pipeline *frame = preset("mafia_de_frame"), *alone = preset("mafia_de");
    const struct glint_effect *picture = glint_effect_find("picture"), *reflection = glint_effect_find("reflection");
    struct glint_players *players = glint_players_create(frame, picture, 1, &err);
    assert_non_null(players);
    const size_t occlusion = player(players, "occlusion");
    assert_true(occlusion != player(players, "shadow") && occlusion != player(players, "indirect"));
    const char *change = glint_player_change(players, occlusion);
    assert_true(strstr(change, "ao_trace hemisphere → dda") && strstr(change, "ao_blur separable left out"));
    assert_null(strstr(change, "contact_") ? change : strstr(change, "indirect_"));
    struct glint_pipeline *changed = exchanged(players, 1u << occlusion);
    assert_string_equal(glint_pipeline_find(changed, "ao_trace")->variant, "dda");
    assert_string_equal(glint_pipeline_find(changed, "contact_trace")->variant, "linear");

    assert_true(glint_study_same(frame, alone, reflection) && !glint_study_same(frame, alone, picture));
    assert_false(glint_study_same(frame, alone, glint_effect_find("occlusion"))); /* one does not make it */
    assert_true(glint_pipeline_set(frame, "ao_trace.samples=2", &err) && glint_study_same(frame, alone, reflection));
    assert_true(glint_pipeline_set(frame, "screen_trace.steps=2", &err));
    assert_false(glint_study_same(frame, alone, reflection));
    glint_pipeline_destroy(&changed);
    glint_players_destroy(&players);
    glint_pipeline_destroy(&frame);
    glint_pipeline_destroy(&alone);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_picture_is_played_by_effects),
        cmocka_unit_test(players_belong_to_the_effect),
        cmocka_unit_test(what_is_not_there_joins_nothing),
        cmocka_unit_test(declarations_are_the_preset),
        cmocka_unit_test(declared_values_are_the_presets),
        cmocka_unit_test(players_run_from_the_last_to_the_first),
        cmocka_unit_test(shared_images_join_slots),
        cmocka_unit_test(every_coalition_is_a_pipeline),
        cmocka_unit_test(ends_are_the_preset_and_its_reference),
        cmocka_unit_test(values_go_with_their_owners),
        cmocka_unit_test(the_reference_has_no_players),
    };
    return cmocka_run_group_tests(tests, fixture_setup_host, fixture_teardown);
}

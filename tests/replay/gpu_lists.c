/* Dispatches over compacted lists on a device under validation. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "made.h"

enum { W = (FIXTURE_WIDTH + 1) / 2, H = (FIXTURE_HEIGHT + 1) / 2, NOTHING = 7 };

/* `phase_of`: of a pixel by its class, 0 to 4; -1: the pixel lies in no list. */
static void check_worked(struct fixture *fixture, const int phase_of[5]) {
    float *worked = made_read(fixture, "worked");
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const int phase = phase_of[(x + 3 * y) % 5];
            const float expected = phase < 0 ? (float)NOTHING : (float)(10 + phase + 1000 * (x + W * y));
            if (worked[y * W + x] != expected)
                fail_msg("pixel %d,%d: expected %g, found %g", x, y, (double)expected, (double)worked[y * W + x]);
        }
    free(worked);
}

/* Catches: group counts taken from the wrong list or before the list is complete, lists run in one phase, the whole
   image run beside them, and stale pixels where no item lies (worked held other values before). */
static void a_pass_works_on_its_lists(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct made made, alone;
    MADE(&alone, &made_worker);
    MADE(&made, &made_sieve, &made_worker);
    made_run(fixture, &alone, &(struct glint_replay_options){.no_cache = true});
    check_worked(fixture, (const int[]){0, 0, 0, 0, 0}); /* no list: the whole image, in the first phase */
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true, .repeat = 3});
    check_worked(fixture, (const int[]){1, 2, 2, -1, -1});
    for (size_t r = 0; r < made_sieve.row_count; r++)
        if (strcmp(made_sieve.rows[r].name, "empty") == 0) made.values[0][r] = 1;
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true});
    check_worked(fixture, (const int[]){1, -1, -1, -1, -1}); /* an empty list starts nothing */
}

/* Catches: a skipped maker that leaves its readers with a list of nothing instead of none. */
static void without_its_maker_a_list_is_the_whole_image(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    const char *const skip[] = {"sieve", NULL};
    struct made made;
    MADE(&made, &made_sieve, &made_worker);
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true, .skip = skip});
    check_worked(fixture, (const int[]){0, 0, 0, 0, 0});
}

/* Catches: what lay in memory before, in the part of a list that its items do not reach. */
static void a_list_is_empty_behind_its_items(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct made made;
    MADE(&made, &made_forger);
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true}); /* the images hold fives */
    MADE(&made, &made_sieve, &made_worker);
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true});
    const struct glint_image *image = glint_replay_find_image(fixture->replay, "list_a");
    uint32_t *texels = calloc((size_t)image->width * image->height, sizeof *texels);
    assert_true(glint_replay_read_image(fixture->replay, image, GLINT_U32, texels, &err));
    assert_int_equal(texels[3], W * H / 5); /* every fifth of 400 */
    for (uint32_t i = texels[3]; i < image->width * (image->height - 1); i++)
        assert_int_equal(texels[image->width + i], 0xFFFFFFFFu);
    free(texels);
}

/* Catches: a list that a run folder does not keep, or that is not used when it comes from there. */
static void every_cut_of_lists_gives_the_bits_of_the_whole(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct made made;
    MADE(&made, &made_sieve, &made_worker);
    made_check_cuts(fixture, &made, (struct glint_replay_options){0});
    check_worked(fixture, (const int[]){1, 2, 2, -1, -1});
}

static const struct glint_pass *pass_with(const struct glint_pass *base, struct glint_row *rows, const char *name,
                                          struct glint_row change, struct glint_pass *out) {
    memcpy(rows, base->rows, base->row_count * sizeof *rows);
    for (size_t r = 0; r < base->row_count; r++)
        if (rows[r].name && strcmp(rows[r].name, name) == 0 && rows[r].kind == change.kind) rows[r] = change;
    *out = *base;
    out->rows = rows;
    return out;
}

/* Catches: a header from a stranger that starts four billion workgroups, or too few to write every pixel. */
static void a_header_that_lies_is_refused(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    const char *const passes[] = {"worker", NULL}, *const forger[] = {"forger", NULL};
    const int words[] = {5, 1};
    struct made made;
    MADE(&made, &made_forger, &made_worker);
    for (int i = 0; i < 2; i++) {
        struct glint_error err = {0};
        char folder[128];
        for (size_t r = 0; r < made_forger.row_count; r++)
            if (strcmp(made_forger.rows[r].name, "word") == 0) made.values[0][r] = words[i];
        made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true, .passes = forger});
        fixture_write_run(fixture, "forged", folder);
        assert_false(glint_replay_run(fixture->replay, &made.pipeline,
                                      &(struct glint_replay_options){.passes = passes, .inputs = folder}, NULL, NULL,
                                      &err));
        fixture_says(&err, "image list_a: expected at most 1152 items in 8 to 82 workgroups");
        fixture_says(&err, i ? "found 1 in 1 x 1 x 1" : "found 5 in 5 x 5 x 5");
    }
    fixture_check_messages(fixture);
}

/* Catches: declarations that would start work from pixels, or say that a missing list has items. */
static void wrong_declarations_are_refused(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct glint_row rows[16];
    struct glint_pass pass;
    struct made made;
    MADE(&made, pass_with(&made_worker, rows, "list_a",
                          (struct glint_row){.kind = GLINT_ROW_DISPATCH_LIST, .name = "depth_full"}, &pass));
    assert_false(glint_replay_run(fixture->replay, &made.pipeline, NULL, NULL, NULL, &err));
    fixture_says(&err, "worker/made dispatches over depth_full, which is no list");
    struct glint_row none = made_worker.rows[2];
    none.fallback = 0;
    MADE(&made, pass_with(&made_worker, rows, "list_a", none, &pass));
    err = (struct glint_error){0};
    assert_false(glint_replay_run(fixture->replay, &made.pipeline, NULL, NULL, NULL, &err));
    fixture_says(&err, "list list_a: expected R32UI and a fallback value of 0xFFFFFFFF");
    struct glint_row wide = {.kind = GLINT_ROW_WORKGROUP, .id = 1, .name = "", .first = 8, .last = 16};
    MADE(&made, pass_with(&made_worker, rows, "list_b", none, &pass));
    rows[pass.row_count++] = wide;
    MADE(&made, &pass);
    err = (struct glint_error){0};
    assert_false(glint_replay_run(fixture->replay, &made.pipeline, NULL, NULL, NULL, &err));
    fixture_says(&err, "list list_a: expected workgroups of 8 x 8");
    none = made_worker.rows[2];
    none.glsl = "utexture2D";
    MADE(&made, &made_sieve, pass_with(&made_worker, rows, "list_a", none, &pass));
    err = (struct glint_error){0};
    assert_false(glint_replay_run(fixture->replay, &made.pipeline, NULL, NULL, NULL, &err));
    fixture_says(&err, "worker/made reads list_a as utexture2D, but it is a list, to be read as utextureBuffer");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pass_works_on_its_lists),
        cmocka_unit_test(without_its_maker_a_list_is_the_whole_image),
        cmocka_unit_test(a_list_is_empty_behind_its_items),
        cmocka_unit_test(every_cut_of_lists_gives_the_bits_of_the_whole),
        cmocka_unit_test(a_header_that_lies_is_refused),
        cmocka_unit_test(wrong_declarations_are_refused),
    };
    return cmocka_run_group_tests(tests, fixture_setup_device, fixture_teardown);
}

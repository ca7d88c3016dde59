/* Dispatches over lists of tiles on a device under validation. */
#include <stdlib.h>
#include <string.h>

#include "made.h"
#include "shared/work_list.h"
#include "unit.h"

enum { W = (FIXTURE_WIDTH + 1) / 2, H = (FIXTURE_HEIGHT + 1) / 2, NOTHING = 7 };

static void set_parameter(struct made *made, size_t place, const char *parameter) {
    const struct glint_pass *pass = made->pipeline.passes[place].pass;
    for (size_t r = 0; r < pass->row_count; r++)
        if (pass->rows[r].name && strcmp(pass->rows[r].name, parameter) == 0) made->values[place][r] = 1;
}

/* `added`: the value added to a texel by its class, 0 to 4; -1: the pass does not run there. */
static void check_worked(struct fixture *fixture, const int added[5]) {
    float *worked = made_read(fixture, "worked");
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const int more = added[(x + 3 * y) % 5];
            const float expected = more < 0 ? (float)NOTHING : (float)(10 + more + 1000 * (x + W * y));
            if (worked[y * W + x] != expected)
                fail_msg("texel %d,%d: expected %g, found %g", x, y, (double)expected, (double)worked[y * W + x]);
        }
    free(worked);
}

/* Catches: group counts of the wrong range or read before the list is complete, a list that is missing or not written first, a dispatch
   over the whole image in addition, and stale texels elsewhere (worked contained other values). */
static void a_pass_works_on_its_list(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct made made, alone;
    MADE(&alone, &made_worker);
    MADE(&made, &made_sieve, &made_worker);
    set_parameter(&alone, 0, "tell"), set_parameter(&made, 1, "tell");
    made_run(fixture, &alone, &(struct glint_replay_options){.no_cache = true});
    check_worked(fixture, (const int[]){0, 0, 0, 0, 0}); /* no list: the whole image */
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true, .repeat = 3});
    check_worked(fixture, (const int[]){-1, RANGE_smooth + 1, RANGE_smooth + 1, -1, -1});
    set_parameter(&made, 0, "empty");
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true});
    check_worked(fixture, (const int[]){-1, -1, -1, -1, -1}); /* an empty range starts no workgroup */
}

/* Catches: a skipped maker whose readers then have an empty list instead of none. */
static void without_its_maker_a_list_is_the_whole_image(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    const char *const skip[] = {"sieve", NULL};
    struct made made;
    MADE(&made, &made_sieve, &made_worker);
    set_parameter(&made, 1, "tell");
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true, .skip = skip});
    check_worked(fixture, (const int[]){0, 0, 0, 0, 0});
}

/* Catches: stale memory in the part of a list after its items. */
static void a_list_is_empty_behind_its_items(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct made made;
    MADE(&made, &made_forger);
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true}); /* the images contain fives */
    MADE(&made, &made_sieve, &made_worker);
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true});
    const struct glint_image *image = glint_replay_find_image(fixture->replay, "list_a");
    uint32_t *texels = calloc((size_t)image->width * image->height, sizeof *texels);
    assert_true(glint_replay_read_image(fixture->replay, image, GLINT_U32, texels, &err));
    const uint32_t *shown = &texels[LIST_RANGES], tiles = shown[1] + shown[3];
    assert_int_equal(shown[1], W * H * 3 / 5); /* three of five, of 400 */
    assert_int_equal(tiles, W * H);
    for (uint32_t i = tiles; i < image->width * (image->height - 1); i++)
        assert_int_equal(texels[image->width + i], 0xFFFFFFFFu);
    free(texels);
}

/* Catches: a pass whose result differs if its list is not written. */
static void every_cut_of_lists_gives_the_bits_of_the_whole(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct made made;
    MADE(&made, &made_sieve, &made_worker);
    made_check_cuts(fixture, &made, (struct glint_replay_options){0});
    check_worked(fixture, (const int[]){-1, 0, 0, -1, -1});
}

/* Catches: an untrusted header that starts four billion workgroups, or too few to write every texel. */
static void a_list_of_a_run_is_not_taken(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    const char *const passes[] = {"worker", NULL}, *const forger[] = {"forger", NULL};
    char folder[128];
    struct made made;
    MADE(&made, &made_forger, &made_worker);
    set_parameter(&made, 1, "tell");
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true, .passes = forger});
    fixture_write_run(fixture, "forged", folder);
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true, .passes = passes, .inputs = folder});
    check_worked(fixture, (const int[]){0, 0, 0, 0, 0});
    fixture_check_messages(fixture);
}

/* The worker with its first row of that kind and name replaced; if the kind differs, its first row of that name. */
static void assert_refused(struct fixture *fixture, const char *name, enum glint_row_kind kind, struct glint_row change,
                           const char *because) {
    struct glint_error err = {0};
    struct glint_row rows[24];
    struct glint_pass pass = made_worker;
    struct made made;
    memcpy(rows, made_worker.rows, made_worker.row_count * sizeof *rows);
    size_t r = 0;
    while (r < pass.row_count && (rows[r].kind != kind || strcmp(rows[r].name, name) != 0)) r++;
    rows[r] = change; /* appended if there is none */
    pass.row_count += r == pass.row_count;
    pass.rows = rows;
    MADE(&made, &made_sieve, &pass);
    assert_false(glint_replay_run(fixture->replay, &made.pipeline, NULL, NULL, NULL, &err));
    fixture_says(&err, because);
}

/* Catches: declarations that would start workgroups from pixels, or from a list of another layout. */
static void wrong_declarations_are_refused(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_row list = *glint_pass_row(&made_worker, GLINT_ROW_READ, "list_a"), wrong = list;
    wrong.name = "depth_full";
    assert_refused(fixture, "list_a", GLINT_ROW_READ, wrong,
                   "worker/made reads depth_full as utextureBuffer, but it is not a list");
    wrong = list;
    wrong.fallback = 0;
    assert_refused(fixture, "list_a", GLINT_ROW_READ, wrong,
                   "list list_a: expected R32UI and a fallback value of 0xFFFFFFFF");
    wrong = list;
    wrong.glsl = "utexture2D";
    assert_refused(fixture, "list_a", GLINT_ROW_READ, wrong,
                   "worker/made reads list_a as utexture2D, but it is a list, to be read as utextureBuffer");
    assert_refused(fixture, "worked", GLINT_ROW_DISPATCH,
                   (struct glint_row){.kind = GLINT_ROW_DISPATCH_LIST, .name = "list_a"},
                   "worker/made: DISPATCH_LIST list_a: expected a DISPATCH before it");
    assert_refused(
        fixture, "", GLINT_ROW_WORKGROUP,
        (struct glint_row){.kind = GLINT_ROW_WORKGROUP, .id = 1, .name = "", .first = 8, .last = 16},
        "worker/made: DISPATCH_LIST list_a: expected 16, 32 or 64 tiles of 1 x 1 texels in a workgroup, found 128");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pass_works_on_its_list),
        cmocka_unit_test(without_its_maker_a_list_is_the_whole_image),
        cmocka_unit_test(a_list_is_empty_behind_its_items),
        cmocka_unit_test(every_cut_of_lists_gives_the_bits_of_the_whole),
        cmocka_unit_test(a_list_of_a_run_is_not_taken),
        cmocka_unit_test(wrong_declarations_are_refused),
    };
    return cmocka_run_group_tests(tests, fixture_setup_device, fixture_teardown);
}

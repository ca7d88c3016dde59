/* The sizes of images by their size class. */
#include "frame_plan.h"
#include "graph.h"
#include "unit.h"

/* Full is 7 x 5 here, and half of it 4 x 3, or 7 x 5 where every pixel is traced. */
static void pictures_are_divided_by_powers_of_two(UNUSED void **state) {
    static const struct {
        int size;
        uint32_t half[2], whole[2], levels, whole_levels; /* whole: while half is full */
    } cases[] = {{GLINT_SIZE_FULL, {7, 5}, {7, 5}, 1, 1},
                 {GLINT_SIZE_HALF, {4, 3}, {7, 5}, 1, 1},
                 {GLINT_SIZE_QUARTER, {2, 1}, {3, 2}, 1, 1},
                 {GLINT_SIZE_EIGHTH, {1, 1}, {1, 1}, 1, 1},
                 {GLINT_SIZE_PICTURE(7, 1), {1, 1}, {1, 1}, 1, 1},
                 {GLINT_SIZE_FULL_MIPS, {7, 5}, {7, 5}, 3, 3},
                 {GLINT_SIZE_HALF_MIPS, {4, 3}, {7, 5}, 3, 3},
                 {GLINT_SIZE_HALF_MIPS(2), {4, 3}, {7, 5}, 2, 2},
                 {GLINT_SIZE_QUARTER_MIPS(3), {2, 1}, {3, 2}, 2, 2},
                 {GLINT_SIZE_QUARTER_MIPS, {2, 1}, {3, 2}, 2, 2}};
    const struct glint_replay_options options = {0};
    struct tables tables = {0};
    for (size_t i = 0; i < 2 * sizeof cases / sizeof *cases; i++) {
        const size_t at = i / 2;
        const bool whole = i % 2;
        const struct glint_row row = {
            .kind = GLINT_ROW_WRITE, .name = "x", .size = (enum glint_size_class)cases[at].size};
        const struct graph_image image = {.name = "x", .row = &row, .source = SOURCE_MADE};
        const struct frame_plan plan = {
            .options = &options, .tables = &tables, .sizes = {.full = {7, 5}, .half = {whole ? 7 : 4, whole ? 5 : 3}}};
        const uint32_t *expected = whole ? cases[at].whole : cases[at].half;
        struct image_desc desc;
        struct glint_error err = {0};
        assert_true(plan_describe(&plan, &image, &desc, &err));
        assert_int_equal(desc.width, expected[0]);
        assert_int_equal(desc.height, expected[1]);
        assert_int_equal(desc.levels, whole ? cases[at].whole_levels : cases[at].levels);
    }
    assert_false(glint_size_is_picture(GLINT_SIZE_CUBEMAPS));
    assert_false(glint_size_is_picture(GLINT_SIZE_LIST));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(pictures_are_divided_by_powers_of_two)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

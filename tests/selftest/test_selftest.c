/* The selection of cases, and which findings pass. cli_selftest tests the cases themselves. */
#include <math.h>
#include <string.h>

#include "glint/selftest.h"
#include "unit.h"

static size_t count_cases(const struct glint_selftest *selftest) {
    size_t count = 0;
    for (size_t g = 0; g < glint_selftest_group_count(selftest); g++)
        count += glint_selftest_get_group(selftest, g)->count;
    return count;
}

static struct glint_selftest *select_cases(const char *first, const char *second) {
    const char *const only[] = {first, second, NULL};
    struct glint_error err = {0};
    struct glint_selftest *selftest = glint_selftest_create(first ? only : NULL, &err);
    assert_string_equal(err.message, "");
    assert_non_null(selftest);
    return selftest;
}

static void every_case_says_what_it_claims(UNUSED void **state) {
    struct glint_selftest *selftest = select_cases(NULL, NULL);
    for (size_t g = 0; g < glint_selftest_group_count(selftest); g++) {
        const struct glint_selftest_group *group = glint_selftest_get_group(selftest, g);
        assert_true(group->count > 0 && group->seconds == 0);
        for (size_t i = 0; i < group->count; i++) {
            const struct glint_selftest_case *c = &group->cases[i];
            assert_true(c->name[0] && c->what[0] && c->unit[0] && c->reason[0]);
            assert_true(c->bound >= 0 && isfinite(c->bound));
            assert_false(glint_selftest_passes(c, &group->findings[i])); /* nothing was compared yet */
            for (size_t k = 0; k < i; k++) assert_string_not_equal(c->name, group->cases[k].name);
        }
    }
    glint_selftest_destroy(&selftest);
    assert_null(selftest);
    glint_selftest_destroy(&selftest);
}

static void a_name_selects_its_case_and_a_group_all_of_its_own(UNUSED void **state) {
    struct glint_selftest *all = select_cases(NULL, NULL), *one = select_cases("cut through mafia3", NULL),
                          *group = select_cases("garbage", NULL), *both = select_cases("garbage", "cut through mafia3");
    assert_int_equal(count_cases(one), 1);
    assert_int_equal(count_cases(both), count_cases(group) + 1);
    assert_true(count_cases(group) > 1 && count_cases(both) < count_cases(all));
    for (size_t g = 0; g < glint_selftest_group_count(all); g++) {
        const struct glint_selftest_group *whole = glint_selftest_get_group(all, g);
        const size_t count = glint_selftest_get_group(group, g)->count;
        if (strcmp(whole->name, "garbage") == 0) assert_int_equal(count, whole->count);
    }
    glint_selftest_destroy(&all);
    glint_selftest_destroy(&one);
    glint_selftest_destroy(&group);
    glint_selftest_destroy(&both);
}

static void a_text_that_no_case_has_is_a_usage_error(UNUSED void **state) {
    const char *const only[] = {"no such thing", NULL};
    struct glint_error err = {0};
    assert_null(glint_selftest_create(only, &err));
    assert_int_equal(err.code, GLINT_ERROR_USAGE);
    assert_non_null(strstr(err.message, "no such thing"));
}

static void only_compared_values_within_the_bound_pass(UNUSED void **state) {
    const struct glint_selftest_case c = {.bound = 0.5};
    const double worst[] = {0, 0.5, 0.6, INFINITY, NAN};
    const bool passes[] = {true, true, false, false, false};
    for (size_t i = 0; i < sizeof worst / sizeof *worst; i++) {
        struct glint_selftest_finding finding = {.worst = worst[i], .values = 1};
        assert_int_equal(glint_selftest_passes(&c, &finding), passes[i]);
        finding.values = 0;
        assert_false(glint_selftest_passes(&c, &finding));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_case_says_what_it_claims),
        cmocka_unit_test(a_name_selects_its_case_and_a_group_all_of_its_own),
        cmocka_unit_test(a_text_that_no_case_has_is_a_usage_error),
        cmocka_unit_test(only_compared_values_within_the_bound_pass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

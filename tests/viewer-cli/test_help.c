/* First contact: help, version, man pages, unknown words. */
#include "cli.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const names[] = {"sample", "info", "validate", "plan",   "replay",  "reference", "compare",
                                    "batch",  "view", "export",   "passes", "devices", "selftest"};
enum { COUNT = sizeof names / sizeof *names };

static void help_lists_every_command(UNUSED void **state) {
    char *help = glint_ok("--help"), *same = glint_ok("help");
    assert_string_equal(help, same);
    for (size_t i = 0; i < COUNT; i++) {
        char line[64];
        snprintf(line, sizeof line, "\n  %-10s ", names[i]);
        assert_contains(help, line);
    }
    free(help);
    free(same);
}

static void every_command_teaches_with_examples(UNUSED void **state) {
    for (size_t i = 0; i < COUNT; i++) {
        char *help = glint_ok(names[i], "--help"), *same = glint_ok("help", names[i]), usage[64];
        assert_string_equal(help, same);
        snprintf(usage, sizeof usage, "Usage: glint %s", names[i]);
        assert_contains(help, usage);
        assert_contains(help, "\nExamples:\n  ");
        assert_contains(strstr(help, "\nExamples:\n"), names[i]);
        free(help);
        free(same);
    }
}

/* The long options in a command's help and in its man page are equal, as both derive from one table. */
static void help_and_man_page_list_the_same_options(UNUSED void **state) {
    for (size_t i = 0; i < COUNT; i++) {
        char *help = glint_ok(names[i], "--help"), *man = glint_ok("--man", names[i]);
        size_t listed = 0;
        for (char *at = man; (at = strstr(at, "Fl \\-")) != NULL; listed++) {
            char option[80];
            at += strlen("Fl \\-");
            snprintf(option, sizeof option, "--%.*s", (int)strcspn(at, " \n"), at);
            assert_contains(help, option);
        }
        for (char *at = help; (at = strstr(at, "\n  ")) != NULL; at++) {
            char *option = strstr(at, "--"), in_man[80];
            if (!option || option > strchr(at + 1, '\n') || option > at + 9 || !strncmp(option, "--help", 6) ||
                !strncmp(option, "--usage", 7))
                continue;
            snprintf(in_man, sizeof in_man, "Fl \\-%.*s", (int)strcspn(option + 2, " =[,\n"), option + 2);
            assert_contains(man, in_man);
        }
        assert_true(listed >= 1);
        free(help);
        free(man);
    }
}

static void run_time_values_are_in_help(UNUSED void **state) {
    char *help = glint_ok("sample", "--help"), *view = glint_ok("view", "--help");
    assert_contains(help, "reversed_infinite");
    assert_contains(help, "octahedral");
    assert_contains(view, "ACES, sRGB, raw");
    free(help);
    free(view);
}

/* The program's page if `name` is NULL. */
static void check_page(const char *name, const char *heading) {
    char *man = name ? glint_ok("--man", name) : glint_ok("--man");
    FILE *file = fopen(in_folder("page.1"), "w");
    assert_non_null(file);
    fputs(man, file);
    fclose(file);
    struct outcome lint = run_program("mandoc", "-T", "lint", "-W", "warning", in_folder("page.1"), NULL);
    assert_string_equal(lint.out, "");
    assert_int_equal(lint.status, 0);
    struct outcome text = run_program("mandoc", "-T", "markdown", in_folder("page.1"), NULL);
    assert_contains(text.out, heading);
    outcome_free(&lint);
    outcome_free(&text);
    free(man);
}

static void man_pages_have_no_lint(UNUSED void **state) {
    check_page(NULL, "# EXIT STATUS");
    for (size_t i = 0; i < COUNT; i++) check_page(names[i], "# EXAMPLES");
    glint_fails(2, "did you mean view?", "--man", "veiw");
}

/* glint(1) refers to the page of each command. */
static void the_program_s_page_lists_the_others(UNUSED void **state) {
    char *man = glint_ok("--man");
    for (size_t i = 0; i < COUNT; i++) {
        char item[64];
        snprintf(item, sizeof item, ".It Xr glint\\-%s 1", names[i]);
        assert_contains(man, item);
    }
    free(man);
}

static void wrong_words_are_usage_errors_with_a_hint(UNUSED void **state) {
    glint_fails(2, "did you mean replay?", "repaly");
    glint_fails(2, "did you mean view?", "help", "veiw");
    glint_fails(2, "unknown option --jsno", "--jsno");
    glint_fails(2, "unrecognized option", "replay", "--bogus", "x.exr");
    for (size_t i = 0; i < COUNT; i++) {
        if (!strcmp(names[i], "passes") || !strcmp(names[i], "devices") || !strcmp(names[i], "selftest")) continue;
        char name[64];
        snprintf(name, sizeof name, "glint %s: ", names[i]);
        glint_fails(2, name, names[i]);
    }
    struct outcome bare = glint(NULL, NULL);
    assert_int_equal(bare.status, 2);
    assert_contains(bare.err, "Usage: glint COMMAND");
    outcome_free(&bare);
}

static void version_is_one_line(UNUSED void **state) {
    char *version = glint_ok("--version");
    assert_string_equal(version, "glint " GLINT_VERSION "\n");
    free(version);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(help_lists_every_command),
        cmocka_unit_test(every_command_teaches_with_examples),
        cmocka_unit_test(help_and_man_page_list_the_same_options),
        cmocka_unit_test(run_time_values_are_in_help),
        cmocka_unit_test(man_pages_have_no_lint),
        cmocka_unit_test(the_program_s_page_lists_the_others),
        cmocka_unit_test(wrong_words_are_usage_errors_with_a_hint),
        cmocka_unit_test(version_is_one_line),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

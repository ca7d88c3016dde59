/* First contact: help, version, man page, completion, unknown words. */
#include "cli.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const names[] = {"sample",  "info", "validate", "plan",    "replay",  "reference",
                                    "compare", "view", "passes",   "devices", "selftest"};
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

/* The long options in the help of a command and in the completion are equal, as both derive from one table. */
static void help_man_and_completion_list_the_same_options(UNUSED void **state) {
    char *completion = glint_ok("--completion"), *man = glint_ok("--man");
    for (size_t i = 0; i < COUNT; i++) {
        char head[64], *help = glint_ok(names[i], "--help");
        snprintf(head, sizeof head, " %s) options='", names[i]);
        char *options = strstr(completion, head);
        assert_non_null(options);
        options = strdup(options + strlen(head));
        *strchr(options, '\'') = '\0';
        size_t listed = 0;
        for (char *word = strtok(options, " "); word; word = strtok(NULL, " "), listed++) {
            char in_man[80];
            word[strcspn(word, "=")] = '\0';
            assert_contains(help, word);
            if (!strcmp(word, "--help")) continue;
            snprintf(in_man, sizeof in_man, "Fl \\-%s", word + 2);
            assert_contains(man, in_man);
        }
        assert_true(listed >= 2);
        free(options);
        free(help);
    }
    free(completion);
    free(man);
}

static void run_time_values_are_in_help(UNUSED void **state) {
    char *help = glint_ok("sample", "--help"), *view = glint_ok("view", "--help");
    assert_contains(help, "reversed_infinite");
    assert_contains(help, "octahedral");
    assert_contains(view, "ACES, sRGB, raw");
    free(help);
    free(view);
}

static void man_page_has_no_lint(UNUSED void **state) {
    char *man = glint_ok("--man");
    FILE *file = fopen(in_folder("glint.1"), "w");
    assert_non_null(file);
    fputs(man, file);
    fclose(file);
    struct outcome lint = run_program("mandoc", "-T", "lint", "-W", "warning", in_folder("glint.1"), NULL);
    assert_string_equal(lint.out, "");
    assert_int_equal(lint.status, 0);
    struct outcome text = run_program("mandoc", "-T", "markdown", in_folder("glint.1"), NULL);
    assert_contains(text.out, "# EXIT STATUS");
    outcome_free(&lint);
    outcome_free(&text);
    free(man);
}

static void completion_is_valid_bash(UNUSED void **state) {
    char *completion = glint_ok("--completion");
    FILE *file = fopen(in_folder("completion"), "w");
    assert_non_null(file);
    fprintf(file, "%s\nCOMP_WORDS=(glint repl); COMP_CWORD=1; _glint; echo \"${COMPREPLY[@]}\"\n", completion);
    fclose(file);
    struct outcome bash = run_program("bash", in_folder("completion"), NULL);
    assert_string_equal(bash.out, "replay\n");
    outcome_free(&bash);
    free(completion);
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
        cmocka_unit_test(help_man_and_completion_list_the_same_options),
        cmocka_unit_test(run_time_values_are_in_help),
        cmocka_unit_test(man_page_has_no_lint),
        cmocka_unit_test(completion_is_valid_bash),
        cmocka_unit_test(wrong_words_are_usage_errors_with_a_hint),
        cmocka_unit_test(version_is_one_line),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

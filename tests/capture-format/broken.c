/* Captures in which one rule of FORMAT.md is broken, and what validate and the reader say of them. */
#include "broken.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "fixture.h"
#include "unit.h"

struct found {
    size_t count;
    char rules[32][32];
    char messages[32][1024];
};

static void collect(void *user, const char *rule, const char *message) {
    struct found *found = user;
    if (found->count < 32) {
        snprintf(found->rules[found->count], 32, "%s", rule);
        snprintf(found->messages[found->count], 1024, "%s", message);
    }
    found->count++;
}

/* Fails the test when the file cannot be checked at all. */
static void validate(const char *path, struct found *found) {
    struct glint_error err = {0};
    size_t count = 0;
    memset(found, 0, sizeof *found);
    if (!glint_capture_validate(path, NULL, collect, found, &count, &err)) fail_msg("%s", err.message);
    assert_int_equal(count, found->count);
}

void broken_numbers(struct rewrite *r, const char *part, const char *name, size_t at, double value) {
    static double numbers[16];
    struct glint_exr_attribute *a = rewrite_attribute(r, part, name);
    memcpy(numbers, a->numbers, a->count * sizeof *numbers);
    numbers[at] = value;
    a->numbers = numbers;
}

void broken_string(struct rewrite *r, const char *part, const char *name, const char *value) {
    rewrite_attribute(r, part, name)->string = value;
}

void broken_check_file(const struct broken_case *c, const char *path, size_t i) {
    static struct found found;
    struct glint_error err = {0};
    validate(path, &found);
    bool said = false;
    for (size_t f = 0; f < found.count && f < 32; f++)
        said |= !strcmp(found.rules[f], c->rule) && strstr(found.messages[f], c->words[0]) &&
                strstr(found.messages[f], c->words[1]);
    if (!said)
        fail_msg("case %zu: %s %s %s: %zu reports, first %s: %s", i, c->rule, c->words[0], c->words[1], found.count,
                 found.rules[0], found.messages[0]);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    if (!!capture != c->opens) fail_msg("case %zu (%s): opens %d", i, c->words[0], capture != NULL);
    if (!capture && (!strstr(err.message, path) || !err.code)) fail_msg("case %zu: %s", i, err.message);
    glint_capture_close(&capture);
}

void broken_check_count(const char *path, void (*change)(struct rewrite *r), size_t count) {
    static struct rewrite r;
    static struct found found;
    struct glint_error err = {0};
    assert_true(fixture_write(&fixture, path, FIXTURE_PARTS, NULL, &err));
    if (change) {
        rewrite_load(&r, path);
        change(&r);
        rewrite_save(&r, path);
        rewrite_finish(&r);
    }
    validate(path, &found);
    if (found.count != count)
        fail_msg("%zu reports, expected %zu; first %s: %s", found.count, count, found.rules[0], found.messages[0]);
}

void broken_check(const struct broken_case *cases, size_t count) {
    static struct rewrite r;
    char path[512], broken[512];
    struct glint_error err = {0};
    assert_true(fixture_write(&fixture, fixture_path(path, "whole.exr"), FIXTURE_PARTS, NULL, &err));
    fixture_path(broken, "broken.exr");
    for (size_t i = 0; i < count; i++) {
        rewrite_load(&r, path);
        cases[i].change(&r);
        rewrite_save(&r, broken);
        rewrite_finish(&r);
        broken_check_file(&cases[i], broken, i);
    }
    unlink(path);
    unlink(broken);
}

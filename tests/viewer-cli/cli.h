/* Runs the built program as a user would, and looks at what it says and leaves behind. */
#ifndef GLINT_TEST_CLI_H
#define GLINT_TEST_CLI_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka wants these before it */
#include <cmocka.h>
#include <stdbool.h>

struct outcome {
    int status; /* exit status, or 128 + the signal's number */
    char *out, *err;
};

/* The program named by $GLINT with these arguments, NULL-terminated. */
struct outcome glint(const char *first, ...);
/* The same of a NULL-terminated list. */
struct outcome glint_with(const char *const *arguments);
/* Any program; the first argument is its name. */
struct outcome run_program(const char *first, ...);
void outcome_free(struct outcome *outcome);

/* Runs and checks the exit status; shows what the program said when it is another. Returns stdout, to be freed. */
#define glint_ok(...) checked(glint(__VA_ARGS__, NULL), 0, __FILE__, __LINE__)
char *checked(struct outcome outcome, int status, const char *file, int line);
/* Runs, expects an exit status and a message on stderr that contains `text`, and nothing on stdout. */
#define glint_fails(status, text, ...) refused(glint(__VA_ARGS__, NULL), status, text, __FILE__, __LINE__)
void refused(struct outcome outcome, int status, const char *text, const char *file, int line);

void assert_contains(const char *text, const char *needle);
/* Parses, or fails. Released by json_decref. */
struct json_t *parse_json(const char *text);
/* The object of a list whose `key` is `name`, and the number that an object has under a key; or fail. */
const struct json_t *named(const struct json_t *list, const char *key, const char *name);
double number(const struct json_t *object, const char *key);

/* A fresh folder; in_folder gives the path of a file in it (static storage for a few calls). */
int make_folder(void **state);
int remove_folder(void **state);
const char *in_folder(const char *name);
bool file_exists(const char *path);

/* A decoded PNG: 8-bit RGB. */
struct pixels {
    uint32_t width, height;
    uint8_t *rgb;
};
struct pixels read_png(const char *path);
const uint8_t *pixel(const struct pixels *pixels, uint32_t x, uint32_t y);

#endif

/* Runs the built program like a user, and checks its output and files. */
#ifndef GLINT_TEST_CLI_H
#define GLINT_TEST_CLI_H

#include <stdbool.h>

#include "unit.h"

/* A preset of few passes: the linear march, the cube maps, one resolve. */
#define PLAIN "-p", GLINT_TEST_PRESET

struct outcome {
    int status; /* exit status, or 128 + the number of the signal */
    char *out, *err;
};

/* Runs the program $GLINT with these arguments, NULL-terminated. */
struct outcome glint(const char *first, ...);
/* The same with a NULL-terminated list. */
struct outcome glint_with(const char *const *arguments);
/* Runs any program; the first argument is its name. */
struct outcome run_program(const char *first, ...);
void outcome_free(struct outcome *outcome);

/* Runs and checks the exit status, printing the output if it differs. Returns stdout, which the caller frees. */
#define glint_ok(...) checked(glint(__VA_ARGS__, NULL), 0, __FILE__, __LINE__)
char *checked(struct outcome outcome, int status, const char *file, int line);
/* Runs and expects an exit status, a message on stderr that contains `text`, and no output. */
#define glint_fails(status, text, ...) refused(glint(__VA_ARGS__, NULL), status, text, __FILE__, __LINE__)
void refused(struct outcome outcome, int status, const char *text, const char *file, int line);

void assert_contains(const char *text, const char *needle);
/* Parses, or fails the test. Released by json_decref. */
struct json_t *parse_json(const char *text);
/* The same for a file of the folder; the number of its lines. */
struct json_t *load_json(const char *name);
int count_lines(const char *name);
/* The object in a list whose member `key` is `name`, and the number of a member; fails the test if there is none. */
const struct json_t *named(const struct json_t *list, const char *key, const char *name);
double number(const struct json_t *object, const char *key);
/* How long it took to trace the reference in a folder, whose name may be a pattern of the shell: two tracings differ in it. */
double reference_seconds(const char *folder);

/* Creates a folder; in_folder returns the path of a file in it, in static storage for a few calls. */
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

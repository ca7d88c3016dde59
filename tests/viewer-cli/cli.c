/* Runs the built program like a user. */
#include "cli.h"
#include "need.h"

#include <fcntl.h>
#include <ftw.h>
#include <jansson.h>
#include <png.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;
static char folder[] = "/tmp/glint-cli-XXXXXX";

static char *read_text(const char *path) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    long size = ftell(file);
    rewind(file);
    char *text = calloc(1, (size_t)size + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, (size_t)size, file), (size_t)size);
    fclose(file);
    return text;
}

static struct outcome run_arguments(const char *const *argv) {
    struct outcome outcome = {0};
    char out[sizeof folder + 16], err[sizeof folder + 16];
    posix_spawn_file_actions_t files;
    pid_t child = 0;
    int wait_status = 0;
    snprintf(out, sizeof out, "%s/.out", folder);
    snprintf(err, sizeof err, "%s/.err", folder);
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, 1, out, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addopen(&files, 2, err, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    need_program(argv[0]);
    assert_int_equal(posix_spawnp(&child, argv[0], &files, NULL, (char *const *)argv, environ), 0);
    posix_spawn_file_actions_destroy(&files);
    assert_int_equal(waitpid(child, &wait_status, 0), child);
    outcome.status = WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : 128 + WTERMSIG(wait_status);
    outcome.out = read_text(out);
    outcome.err = read_text(err);
    return outcome;
}

static struct outcome run_list(const char *program, const char *first, va_list rest) {
    const char *argv[40] = {program, first};
    for (size_t i = first ? 2 : 1; i < 39 && (argv[i] = va_arg(rest, const char *)) != NULL; i++) continue;
    return run_arguments(argv);
}

struct outcome glint(const char *first, ...) {
    const char *program = getenv("GLINT");
    assert_non_null(program);
    va_list rest;
    va_start(rest, first);
    struct outcome outcome = run_list(program, first, rest);
    va_end(rest);
    return outcome;
}

struct outcome glint_with(const char *const *arguments) {
    const char *argv[40] = {getenv("GLINT")};
    assert_non_null(argv[0]);
    for (size_t i = 0; i < 38 && arguments[i]; i++) argv[i + 1] = arguments[i];
    return run_arguments(argv);
}

struct outcome run_program(const char *first, ...) {
    const char *argv[40] = {first};
    va_list rest;
    va_start(rest, first);
    for (size_t i = 1; i < 39 && (argv[i] = va_arg(rest, const char *)) != NULL; i++) continue;
    va_end(rest);
    return run_arguments(argv);
}

void outcome_free(struct outcome *outcome) {
    free(outcome->out);
    free(outcome->err);
}

char *checked(struct outcome outcome, int status, const char *file, int line) {
    if (outcome.status != status) {
        print_error("exit status %d instead of %d, stderr: %s\nstdout: %s\n", outcome.status, status, outcome.err,
                    outcome.out);
        _fail(file, line);
    }
    free(outcome.err);
    return outcome.out;
}

void refused(struct outcome outcome, int status, const char *text, const char *file, int line) {
    if (outcome.status != status || !strstr(outcome.err, text) || outcome.out[0]) {
        print_error("exit status %d (expected %d), expected on stderr: %s\nstderr: %s\nstdout: %s\n", outcome.status,
                    status, text, outcome.err, outcome.out);
        _fail(file, line);
    }
    outcome_free(&outcome);
}

void assert_contains(const char *text, const char *needle) {
    if (strstr(text, needle)) return;
    print_error("\"%s\" is not in:\n%s\n", needle, text);
    fail();
}

json_t *parse_json(const char *text) {
    json_error_t error;
    json_t *json = json_loads(text, 0, &error);
    if (!json) print_error("line %d: %s in:\n%s\n", error.line, error.text, text);
    assert_non_null(json);
    return json;
}

int count_lines(const char *name) {
    struct outcome lines = run_program("wc", "-l", in_folder(name), NULL);
    const int count = atoi(lines.out);
    outcome_free(&lines);
    return count;
}

json_t *load_json(const char *name) {
    json_t *json = json_load_file(in_folder(name), 0, NULL);
    if (!json) fail_msg("%s is no JSON", name);
    return json;
}

const json_t *named(const json_t *list, const char *key, const char *name) {
    size_t i;
    json_t *item;
    json_array_foreach(list, i, item) if (!strcmp(json_string_value(json_object_get(item, key)), name)) return item;
    fail_msg("%s %s is not listed", key, name);
    return NULL;
}

double reference_seconds(const char *pattern) {
    char *command = NULL;
    assert_true(asprintf(&command, "cat %s/run.json", in_folder(pattern)) > 0);
    struct outcome record = run_program("sh", "-c", command, NULL);
    assert_int_equal(record.status, 0);
    json_t *json = parse_json(record.out);
    const double seconds = number(json_object_get(json, "reference"), "seconds");
    json_decref(json);
    outcome_free(&record);
    free(command);
    return seconds;
}

double number(const json_t *object, const char *key) {
    const json_t *value = json_object_get(object, key);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

int make_folder(UNUSED void **state) {
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_entry(const char *path, const struct stat *info, int type, struct FTW *walk) {
    (void)info, (void)type, (void)walk;
    return remove(path);
}

int remove_folder(UNUSED void **state) {
    return nftw(folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}

const char *in_folder(const char *name) {
    static char paths[8][256];
    static unsigned turn;
    char *path = paths[turn++ % 8];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

bool file_exists(const char *path) {
    struct stat info;
    return stat(path, &info) == 0;
}

/* Without conversion: the simplified interface would convert files that oiiotool marks as linear. */
struct pixels read_png(const char *path) {
    struct pixels pixels = {0};
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    assert_non_null(info);
    if (setjmp(png_jmpbuf(png))) fail_msg("%s is no PNG", path);
    png_init_io(png, file);
    png_read_png(png, info, PNG_TRANSFORM_STRIP_ALPHA, NULL);
    pixels.width = png_get_image_width(png, info);
    pixels.height = png_get_image_height(png, info);
    assert_int_equal(png_get_rowbytes(png, info), 3 * (size_t)pixels.width);
    pixels.rgb = malloc((size_t)3 * pixels.width * pixels.height);
    assert_non_null(pixels.rgb);
    for (uint32_t y = 0; y < pixels.height; y++)
        memcpy(pixels.rgb + (size_t)3 * pixels.width * y, png_get_rows(png, info)[y], (size_t)3 * pixels.width);
    png_destroy_read_struct(&png, &info, NULL);
    fclose(file);
    return pixels;
}

const uint8_t *pixel(const struct pixels *pixels, uint32_t x, uint32_t y) {
    assert_true(x < pixels->width && y < pixels->height);
    return pixels->rgb + 3 * ((size_t)y * pixels->width + x);
}

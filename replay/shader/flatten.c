/* Inlines includes, since the C interface of glslang 12 takes no include callback. #line directives preserve files and
   line numbers, so that messages are correct and __LINE__ of a declaration row remains its binding. */
#include "shader.h"
#include "text_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { DEPTH_MAX = 16, TEXT_MAX = 1 << 22, PATH_SIZE = 1024 };

struct flatten {
    FILE *stream;
    char *text;
    size_t size, stream_size;
    const char *path;                /* of the file that is flattened */
    const char *open[DEPTH_MAX + 2]; /* that file, and those whose includes are being inlined */
    const char *pass_folder;         /* folder of the pass under passes/: "reflection/blur" */
    const char *folder;              /* the user's copy of passes/, or NULL */
    bool versioned;                  /* #version, which must come first, has been seen */
    bool foreign;                    /* a file came from `folder` */
};

static bool append_text(struct flatten *out, const char *text, size_t length, struct glint_error *err) {
    return ((out->size += length) <= TEXT_MAX && fwrite(text, 1, length, out->stream) == length) ||
           glint_fail(err, GLINT_ERROR_LIMIT, "%s: more than %d bytes with its includes, the limit", out->path,
                      TEXT_MAX);
}

static bool append_line_directive(struct flatten *out, size_t line, const char *file, struct glint_error *err) {
    char directive[PATH_SIZE + 64];
    int length = snprintf(directive, sizeof directive, "#line %zu \"%s\"\n", line, file);
    for (int i = 0; i < length; i++)
        if (directive[i] == '\\') directive[i] = '/';
    return append_text(out, directive, (size_t)length, err);
}

/* A line of the source. */
struct directive {
    char include[PATH_SIZE / 2]; /* the name of an #include, or "" */
    int renumber;                /* N of `#line N`, else 0 */
    bool version;
};
static struct directive parse_line(const char *text, size_t length) {
    struct directive d = {0};
    char line[PATH_SIZE], close = 0;
    int version = 0;
    snprintf(line, sizeof line, "%.*s", (int)(length < PATH_SIZE ? length : PATH_SIZE - 1), text);
    if ((sscanf(line, " # include \"%511[^\"]%c", d.include, &close) != 2 || close != '"') &&
        (sscanf(line, " # include <%511[^>]%c", d.include, &close) != 2 || close != '>'))
        d.include[0] = 0;
    sscanf(line, " #line %d", &d.renumber);
    sscanf(line, " # version%n", &version);
    d.version = version > 0;
    return d;
}

/* The path of a file relative to the folder of another file, with "x/../" resolved. */
static bool join_sibling(char *path, const char *file, const char *name) {
    const char *slash = strrchr(file, '/');
    int folder = slash ? (int)(slash - file + 1) : 0;
    if (snprintf(path, PATH_SIZE, "%.*s%s", folder, file, name) >= PATH_SIZE) return false;
    for (char *up; (up = strstr(path, "/../")) && up > path && strncmp(path, "..", 2) != 0;) {
        char *start = up;
        while (start > path && start[-1] != '/') start--;
        memmove(start, up + 4, strlen(up + 4) + 1);
    }
    return true;
}

static bool flatten_text(struct flatten *out, const char *file, const char *text, bool on_disk, int depth,
                         struct glint_error *err);

static bool flatten_disk(struct flatten *out, const char *path, int depth, struct glint_error *err) {
    char *text = depth ? file_text_found(path, TEXT_MAX / 4, err) : file_text(path, TEXT_MAX / 4, err);
    bool ok = text && flatten_text(out, path, text, true, depth, err);
    free(text);
    return ok;
}

/* Whether the path is a file of passes/, in `folder` or built in. */
static bool is_pass_file(const struct flatten *out, const char *path) {
    char own[PATH_SIZE];
    return glint_pass_text(path) ||
           (out->folder && snprintf(own, sizeof own, "%s/%s", out->folder, path) < PATH_SIZE && access(own, R_OK) == 0);
}

static bool flatten_pass_file(struct flatten *out, const char *path, int depth, struct glint_error *err) {
    char own[PATH_SIZE];
    if (!out->folder || snprintf(own, sizeof own, "%s/%s", out->folder, path) >= PATH_SIZE || access(own, R_OK) != 0)
        return flatten_text(out, path, glint_pass_text(path), false, depth, err);
    char *text = file_text_found(own, TEXT_MAX / 4, err);
    bool ok = text && flatten_text(out, path, text, false, depth, err);
    out->foreign = true;
    free(text);
    return ok;
}

static bool flatten_include(struct flatten *out, const char *file, size_t line, const char *name, bool on_disk,
                            int depth, struct glint_error *err) {
    char path[PATH_SIZE], in_slot[PATH_SIZE];
    if (depth >= DEPTH_MAX)
        return glint_fail(err, GLINT_ERROR_LIMIT, "%s:%zu: includes nest deeper than %d, the limit", file, line,
                          DEPTH_MAX);
    if (on_disk &&
        (name[0] == '/' ? snprintf(path, sizeof path, "%s", name) < PATH_SIZE : join_sibling(path, file, name)) &&
        access(path, R_OK) == 0)
        return flatten_disk(out, path, depth + 1, err);
    if (!on_disk && join_sibling(path, file, name) && is_pass_file(out, path))
        return flatten_pass_file(out, path, depth + 1, err);
    if (on_disk && snprintf(in_slot, sizeof in_slot, "%s/", out->pass_folder) < PATH_SIZE &&
        join_sibling(path, in_slot, name) && is_pass_file(out, path))
        return flatten_pass_file(out, path, depth + 1, err);
    if (is_pass_file(out, name)) return flatten_pass_file(out, name, depth + 1, err);
    return glint_fail(err, GLINT_ERROR_USAGE, "%s:%zu: include \"%s\" not found beside the file nor among the passes",
                      file, line, name);
}

static bool flatten_text(struct flatten *out, const char *file, const char *text, bool on_disk, int depth,
                         struct glint_error *err) {
    for (int i = 0; i < depth; i++)
        if (!strcmp(out->open[i], file))
            return glint_fail(err, GLINT_ERROR_FORMAT, "%s: %s includes itself", out->open[depth - 1], file);
    out->open[depth] = file;
    static const char names_in_lines[] = "#extension GL_GOOGLE_cpp_style_line_directive : require\n";
    if (out->versioned && !append_line_directive(out, 1, file, err)) return false;
    for (size_t line = 1; *text; line++) {
        const char *end = strchr(text, '\n');
        size_t length = end ? (size_t)(end - text) : strlen(text);
        const struct directive directive = parse_line(text, length);
        if (directive.include[0]) {
            if (!flatten_include(out, file, line, directive.include, on_disk, depth, err) ||
                !append_line_directive(out, line + 1, file, err))
                return false;
        } else if (!append_text(out, text, length, err) || !append_text(out, "\n", 1, err)) return false;
        if (!out->versioned && directive.version) {
            out->versioned = true;
            if (!append_text(out, names_in_lines, sizeof names_in_lines - 1, err) ||
                !append_line_directive(out, line + 1, file, err))
                return false;
        }
        if (directive.renumber > 0) line = (size_t)directive.renumber - 1;
        text += length + (end != NULL);
    }
    return true;
}

/* Flattens a user's file, or a pass's shader. */
static char *flatten_file(struct flatten *out, const char *path, bool on_disk, struct glint_error *err) {
    out->path = path;
    if (!(out->stream = open_memstream(&out->text, &out->stream_size))) {
        glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
        return NULL;
    }
    bool ok = on_disk ? flatten_disk(out, path, 0, err) : flatten_pass_file(out, path, 0, err);
    ok = fclose(out->stream) == 0 && ok;
    if (ok && !on_disk && !out->foreign) ok = false;
    else if (ok && !out->versioned)
        ok = glint_fail(err, GLINT_ERROR_FORMAT, out->size ? "%s:1: expected #version 460 first" : "%s: empty", path);
    if (ok) return out->text;
    free(out->text);
    return NULL;
}

char *shader_flatten(const char *path, const struct glint_pass *pass, const char *folder, struct glint_error *err) {
    struct flatten out = {.pass_folder = pass->folder ? pass->folder : "", .folder = folder};
    return flatten_file(&out, path, true, err);
}

char *shader_flatten_pass(const struct glint_pass *pass, const char *folder, struct glint_error *err) {
    struct flatten out = {.pass_folder = pass->folder, .folder = folder};
    char path[PATH_SIZE];
    if (!folder || !pass->folder) return NULL;
    snprintf(path, sizeof path, "%s/%s.comp", pass->folder, pass->variant);
    return is_pass_file(&out, path) ? flatten_file(&out, path, false, err) : NULL;
}

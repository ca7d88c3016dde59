/* Renders documents as self-contained HTML pages. */
#include "draw/page/page.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/blobs.h"
#include "inside.h"
#include "io/output.h"
#include "options/args.h"

/* ---- Pictures: each is stored once and referred to by its index ---- */

struct files {
    json_t *places; /* {file: index} */
    json_t *uris;
    const char *folder;
    bool beside; /* the page is in this folder */
};

/* Replaces the file names of all pictures by their indices. */
static void number_files(struct files *files, json_t *json) {
    size_t i;
    const char *key;
    json_t *item;
    if (json_is_array(json)) json_array_foreach(json, i, item) number_files(files, item);
    json_object_foreach(json, key, item) {
        number_files(files, item);
        if (strcmp(key, "pictures") != 0) continue;
        json_t *picture;
        json_array_foreach(item, i, picture) {
            const char *file = json_string_value(json_object_get(picture, "file"));
            if (!file || (files->beside && json_is_true(json_object_get(picture, "beside")))) continue;
            if (!json_object_get(files->places, file))
                json_object_set_new(files->places, file, json_integer((json_int_t)json_object_size(files->places)));
            json_object_set(picture, "file", json_object_get(files->places, file));
        }
    }
}

/* Reads a file below `folder`, malloc'd. Documents may come from anybody. */
static uint8_t *read_below(const char *folder, const char *name, size_t *size, struct glint_error *err) {
    enum { LARGEST_BYTES = 256 << 20 };
    glint_file file = GLINT_NO_FILE;
    uint64_t bytes = 0;
    char *path = folder ? inside_path(folder, name, err) : NULL;
    if (!folder) glint_fail(err, GLINT_ERROR_IO, "page: picture %s: not in a folder", name);
    const bool open = path && inside_open(&file, path, LARGEST_BYTES, &bytes, err);
    uint8_t *contents = open ? malloc((size_t)bytes + 1) : NULL;
    if (open && (!contents || !glint_file_read(file, contents, (size_t)bytes, 0, size))) {
        glint_fail(err, GLINT_ERROR_IO, "%s: cannot be read as a picture", path);
        free(contents);
        contents = NULL;
    }
    if (open) glint_file_close(file);
    free(path);
    return contents;
}

static json_t *picture_file(const char *folder, const char *name, size_t bytes, struct glint_error *err) {
    size_t size = 0;
    uint8_t *file = read_below(folder, name, &size, err);
    json_t *json = file ? page_picture_file(name, file, size, bytes, err) : NULL;
    free(file);
    return json;
}

static bool load_files(struct files *files, struct glint_error *err) {
    const char *name;
    json_t *place, *uri;
    size_t share = PAGE_PICTURE_BYTES / (json_object_size(files->places) + 1);
    json_object_foreach(files->places, name,
                        place) { /* jansson keeps the order of insertion, which is that of the indices */
        uri = strncmp(name, "data:", 5) == 0 ? json_string(name) : picture_file(files->folder, name, share, err);
        if (!uri) return false;
        json_array_append_new(files->uris, uri);
    }
    return true;
}

/* ---- HTML ---- */

static void write_bytes(FILE *out, const unsigned char *begin, const unsigned char *end) {
    fwrite(begin, 1, (size_t)(end - begin), out);
}

/* JSON contains '<' and DEL only in strings. Without the one, no string can close the script element; the other is the one control character
   that jansson leaves. */
static int put_json(const char *text, size_t size, void *user) {
    FILE *out = user;
    for (const char *end = text + size; text < end;) {
        const char *stop = text;
        while (stop < end && *stop != '<' && *stop != 0x7F) stop++;
        fwrite(text, 1, (size_t)(stop - text), out);
        if (stop < end) fputs(*stop == '<' ? "\\u003c" : "\\u007f", out);
        text = stop < end ? stop + 1 : end;
    }
    return ferror(out) ? -1 : 0;
}

struct around {
    const unsigned char *head, *head_end, *scripts, *scripts_end;
};

static char *html(const struct around *around, const json_t *document) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    write_bytes(out, around->head, around->head_end);
    bool ok = json_dump_callback(document, put_json, out, JSON_COMPACT | JSON_ENSURE_ASCII) == 0;
    fputs("</script>\n<script>", out);
    write_bytes(out, blob_echarts, blob_echarts_end);
    fputs("</script>\n", out);
    write_bytes(out, around->scripts, around->scripts_end);
    ok = ok && !ferror(out);
    if (fclose(out) == 0 && ok) return text;
    free(text);
    return NULL;
}

char *page_live(struct glint_error *err) {
    const struct around around = {blob_live_head, blob_live_head_end, blob_live_scripts, blob_live_scripts_end};
    json_t *nothing = json_object();
    char *text = nothing ? html(&around, nothing) : NULL;
    json_decref(nothing);
    if (!text) glint_fail(err, GLINT_ERROR_MEMORY, "page: out of memory");
    return text;
}

/* Whether the file is in the folder, by their names. */
static bool is_in(const char *path, const char *folder) {
    const char *name = base_name(path);
    const size_t length = folder ? strlen(folder) : 0;
    return length && (size_t)(name - path) == length + 1 && !strncmp(path, folder, length);
}

bool page_write(const char *path, const json_t *document, const char *folder, struct glint_error *err) {
    json_t *copy = json_deep_copy(document);
    struct files files = {json_object(), json_array(), folder, is_in(path, folder)};
    number_files(&files, copy);
    bool ok = load_files(&files, err);
    if (ok) json_object_set(copy, "files", files.uris);
    const struct around around = {blob_page_head, blob_page_head_end, blob_page_scripts, blob_page_scripts_end};
    char *text = ok && copy ? html(&around, copy) : NULL;
    ok = ok && (text ? output_text(path, text, err) : glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path));
    free(text);
    json_decref(files.places);
    json_decref(files.uris);
    json_decref(copy);
    return ok;
}

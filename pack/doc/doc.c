/* Keeps manifest.schema.json and the tables of docs/pack.md those of the rows.
   usage: pack_doc manifest.schema.json pack.md           writes both anew
          pack_doc --check manifest.schema.json pack.md   exit 1 when they differ */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "format.h"
#include "keys.h"

/* ---- Schema ---- */

static json_t *words_of(const char *detail) {
    json_t *list = json_array();
    for (const char *word = detail; *word;) {
        const size_t length = strcspn(word, " ");
        json_array_append_new(list, json_stringn(word, length));
        word += length + (word[length] == ' ');
    }
    return list;
}

static json_t *reference(const char *object) {
    /* what may stand in the place of an object */
    if (!strcmp(object, "channel"))
        return json_pack("{s:[{s:s}, {s:s}, {s:s}]}", "anyOf", "type", "string", "type", "number", "$ref",
                         "#/$defs/channel");
    if (!strcmp(object, "attribute"))
        return json_pack("{s:[{s:s}, {s:s}, {s:s}]}", "anyOf", "type", "string", "type", "number", "$ref",
                         "#/$defs/attribute");
    return json_pack("{s:s+}", "$ref", "#/$defs/", object);
}

static json_t *list_of(json_t *items, int count) {
    json_t *list = json_pack("{s:s, s:o}", "type", "array", "items", items);
    if (count) json_object_set_new(list, "minItems", json_integer(count));
    if (count) json_object_set_new(list, "maxItems", json_integer(count));
    return list;
}

static json_t *value_of(const struct key *key) {
    switch (key->kind) {
    case KEY_TEXT:
        return json_pack("{s:s}", "type", "string");
    case KEY_NUMBER:
        return json_pack("{s:s}", "type", "number");
    case KEY_COUNT:
        return json_pack("{s:s, s:i}", "type", "integer", "minimum", 0);
    case KEY_BOOL:
        return json_pack("{s:s}", "type", "boolean");
    case KEY_NUMBERS:
        return list_of(json_pack("{s:s}", "type", "number"), atoi(key->detail));
    case KEY_MATRIX:
        return json_pack("{s:[o, o]}", "anyOf", list_of(json_pack("{s:s}", "type", "number"), 16),
                         list_of(list_of(json_pack("{s:s}", "type", "number"), 4), 4));
    case KEY_CHOICE:
        return json_pack("{s:o}", "enum", words_of(key->detail));
    case KEY_CHOICES:
        return list_of(json_pack("{s:o}", "enum", words_of(key->detail)), strcmp(key->name, "axes") ? 6 : 3);
    case KEY_ONE:
        return reference(key->detail);
    case KEY_LIST:
        return list_of(reference(key->detail), 0);
    case KEY_MAP:
        return json_pack("{s:s, s:o}", "type", "object", "additionalProperties", reference(key->detail));
    case KEY_TEXTS:
        return list_of(json_pack("{s:s}", "type", "string"), atoi(key->detail));
    case KEY_PLANES:
        return list_of(list_of(json_pack("{s:s}", "type", "number"), 4), 0);
    case KEY_ANY:
        break;
    }
    return json_object();
}

static json_t *schema_of(const struct object *object) {
    json_t *properties = json_object(), *required = json_array();
    for (const struct key *key = object->keys; key->name; key++) {
        json_t *value = value_of(key);
        char text[512];
        snprintf(text, sizeof text, "%s%s%s%s", key->meaning, key->fallback[0] ? " (not said: " : "", key->fallback,
                 key->fallback[0] ? ")" : "");
        if (text[0]) json_object_set_new(value, "description", json_string(text));
        json_object_set_new(properties, key->name, value);
        if (key->required) json_array_append_new(required, json_string(key->name));
    }
    json_object_set_new(properties, "comment", json_object());
    json_t *schema =
        json_pack("{s:s, s:s, s:o}", "description", object->meaning, "type", "object", "properties", properties);
    if (json_array_size(required)) json_object_set_new(schema, "required", required);
    else json_decref(required);
    json_object_set_new(schema, "additionalProperties",
                        strcmp(object->name, "part") ? json_false() : reference("channel"));
    return schema;
}

static char *schema_text(void) {
    json_t *definitions = json_object();
    for (const struct object *object = pack_objects; object->name; object++)
        if (object != pack_objects) json_object_set_new(definitions, object->name, schema_of(object));
    json_t *schema = json_pack("{s:s, s:s}", "$schema", "https://json-schema.org/draft/2020-12/schema", "title",
                               "Manifest of glint pack");
    json_t *root = schema_of(pack_objects);
    json_object_update(schema, root);
    json_object_set_new(schema, "$defs", definitions);
    json_object_set_new(json_object_get(json_object_get(schema, "properties"), "glint"), "const", json_integer(1));
    json_decref(root);
    char *text = json_dumps(schema, JSON_INDENT(2) | JSON_ENSURE_ASCII);
    json_decref(schema);
    return text;
}

/* ---- Tables ---- */

static void write_keys(FILE *out) {
    static const char *const kinds[] = {
        [KEY_TEXT] = "text",     [KEY_NUMBER] = "number", [KEY_COUNT] = "integer ≥ 0", [KEY_BOOL] = "bool",
        [KEY_MATRIX] = "matrix", [KEY_ANY] = "any",       [KEY_PLANES] = "planes",     [KEY_ONE] = "object",
        [KEY_LIST] = "list of",  [KEY_MAP] = "names and"};
    for (const struct object *object = pack_objects; object->name; object++) {
        fprintf(out, "### %s\n\n%c%s.\n\n| key | value | not said | meaning |\n| --- | --- | --- | --- |\n",
                object->name, object->meaning[0] - 'a' + 'A', object->meaning + 1);
        for (const struct key *key = object->keys; key->name; key++) {
            fprintf(out, "| `%s` | ", key->name);
            if (key->kind == KEY_CHOICE || key->kind == KEY_CHOICES) {
                fprintf(out, "%s", key->kind == KEY_CHOICES ? "list of " : "");
                for (const char *word = key->detail; *word;) {
                    const size_t length = strcspn(word, " ");
                    fprintf(out, "%s`%.*s`", word == key->detail ? "" : ", ", (int)length, word);
                    word += length + (word[length] == ' ');
                }
            } else if (key->kind == KEY_NUMBERS || key->kind == KEY_TEXTS)
                fprintf(out, "%s %s", key->detail, key->kind == KEY_TEXTS ? "texts" : "numbers");
            else if (key->kind == KEY_ONE || key->kind == KEY_LIST || key->kind == KEY_MAP)
                fprintf(out, "%s [%s](#%s)", kinds[key->kind], key->detail, key->detail);
            else fprintf(out, "%s", kinds[key->kind]);
            fprintf(out, " | %s | %s |\n", key->required ? "required" : key->fallback, key->meaning);
        }
        fputs("\n", out);
    }
}

static void write_formats(FILE *out) {
    fputs("| Vulkan (`VK_FORMAT_`) | Direct3D (`DXGI_FORMAT_`) | bytes | components, from the lowest bit |\n"
          "| --- | --- | --- | --- |\n",
          out);
    for (size_t i = 0; i < pack_format_count; i++) {
        const struct format *f = &pack_formats[i];
        fprintf(out, "| %s%s%s | %s%s%s | %u |", f->vulkan[0] ? "`" : "", f->vulkan, f->vulkan[0] ? "`" : "",
                f->dxgi[0] ? "`" : "", f->dxgi, f->dxgi[0] ? "`" : "", f->bytes);
        for (unsigned c = 0; c < f->count; c++) fprintf(out, " %c%u", f->components[c].letter, f->components[c].bits);
        fputs(" |\n", out);
    }
}

/* ---- Files ---- */

static char *read_text(const char *path) {
    FILE *in = fopen(path, "rb");
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    for (int c; in && (c = fgetc(in)) != EOF;) fputc(c, out);
    if (in) fclose(in);
    fclose(out);
    return text;
}

/* The page with what stands between "<!-- table NAME -->" and "<!-- end -->" written anew. */
static char *page_text(const char *page) {
    static const struct {
        const char *mark;
        void (*write)(FILE *out);
    } tables[] = {{"<!-- table formats -->\n", write_formats}, {"<!-- table keys -->\n", write_keys}};
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        const char *at = strstr(page, tables[i].mark), *end = at ? strstr(at, "<!-- end -->") : NULL;
        if (!end) continue;
        at += strlen(tables[i].mark);
        fwrite(page, 1, (size_t)(at - page), out);
        tables[i].write(out);
        page = end;
    }
    fputs(page, out);
    fclose(out);
    return text;
}

static bool keep(const char *path, const char *old, const char *text, bool check) {
    if (!strcmp(old, text)) return true;
    if (check) {
        fprintf(stderr, "%s: differs from the rows of keys and formats; meson compile pack-doc writes it anew\n", path);
        return false;
    }
    FILE *out = fopen(path, "wb");
    if (!out) return false;
    fputs(text, out);
    return fclose(out) == 0;
}

int main(int argc, char **argv) {
    const bool check = argc == 4 && !strcmp(argv[1], "--check");
    if (argc != 3 + check) return 2;
    const char *schema_path = argv[1 + check], *page_path = argv[2 + check];
    char *old_schema = read_text(schema_path), *old_page = read_text(page_path), *schema = schema_text(), *page = NULL;
    char *lined = malloc(strlen(schema) + 2);
    sprintf(lined, "%s\n", schema);
    page = page_text(old_page);
    const bool schema_same = keep(schema_path, old_schema, lined, check);
    const bool same = keep(page_path, old_page, page, check) && schema_same;
    free(old_schema);
    free(old_page);
    free(schema);
    free(lined);
    free(page);
    return same ? 0 : 1;
}

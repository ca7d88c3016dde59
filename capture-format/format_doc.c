/* Keeps FORMAT.md's tables those of the registry.
   usage: format_doc FORMAT.md          rewrites the tables
          format_doc --check FORMAT.md  exit 1 when they differ */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "registry.h"

static const char *or_dash(const char *text) {
    return text[0] ? text : "–";
}

static void write_roles(FILE *out) {
    static const char *const shapes[] = {"frame", "cube", "levels", "table", "any"};
    size_t count = 0;
    const struct glint_role *all = glint_roles(&count);
    fprintf(out, "| role | shape | required | `previous.ROLE` allowed | meaning |\n| --- | --- | --- | --- | --- |\n");
    for (size_t i = 0; i < count; i++) {
        const struct glint_role *role = &all[i];
        const bool free_rest = role->name[strlen(role->name) - 1] == '.';
        fprintf(out, "| `%s%s` | %s | %s | %s | %s%s |\n", role->name,
                free_rest        ? "*"
                : role->numbered ? ".NNN"
                                 : "",
                shapes[role->shape], role->required ? "yes" : "no", role->may_be_previous ? "yes" : "no",
                role->reserved ? "*reserved:* " : "", role->meaning);
    }
}

static void write_channels(FILE *out) {
    size_t count = 0;
    const struct glint_role *all = glint_roles(&count);
    fprintf(
        out,
        "| role | channel | required | decoded unit | encoding | meaning |\n| --- | --- | --- | --- | --- | --- |\n");
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < all[i].channel_count; c++) {
            const struct glint_role_channel *row = &all[i].channels[c];
            char need[40] = "no";
            if (row->required) snprintf(need, sizeof need, "yes");
            else if (!isnan(row->absent)) snprintf(need, sizeof need, "no, read as %g", row->absent);
            fprintf(out, "| %s%s%s | `%s` | %s | %s | %s | %s |\n", c ? "" : "`", c ? "" : all[i].name, c ? "" : "`",
                    row->name, need, row->unit, or_dash(row->encoding), or_dash(row->meaning));
        }
}

static void write_encodings(FILE *out) {
    size_t count = 0;
    const struct glint_encoding_row *rows = glint_encoding_rows(&count);
    fprintf(out, "| encoding | attribute | value | what is stored |\n| --- | --- | --- | --- |\n");
    for (size_t i = 0; i < count; i++)
        for (int v = 0; v < rows[i].count; v++)
            fprintf(out, "| %s | %s%s%s | `%s` | %s |\n", v ? "" : rows[i].which, v ? "" : "`",
                    v ? "" : rows[i].attribute, v ? "" : "`", rows[i].values[v].name, rows[i].values[v].meaning);
}

static void write_attributes(FILE *out) {
    static const char *const ranges[] = {"any", "> 0", "≥ 0", "(0, 1]", "[−90, 90]", "[0, π/2)", "[0, π]", "(−1, 1)"};
    size_t count = 0;
    const struct glint_attribute_row *rows = glint_attribute_rows(&count);
    for (int scope = 0; scope < GLINT_SCOPE_COUNT; scope++) {
        fprintf(out,
                "%sAttributes %s:\n\n| attribute | type | required | range | value when absent | unit | meaning |\n"
                "| --- | --- | --- | --- | --- | --- | --- |\n",
                scope ? "\n" : "", glint_scope_row((enum glint_scope)scope)->place);
        for (size_t i = 0; i < count; i++) {
            const struct glint_attribute_row *row = &rows[i];
            if ((int)row->scope != scope) continue;
            char absent[32] = "–";
            if (row->kind == GLINT_KIND_DOUBLE && !row->required && !isnan(row->fallback))
                snprintf(absent, sizeof absent, "%g", row->fallback);
            if (row->kind == GLINT_KIND_RANGE) snprintf(absent, sizeof absent, "0 1");
            fprintf(out, "| `%s` | %s | %s | %s | %s | %s | %s |\n", row->name, glint_kind_type(row->kind),
                    !row->required                 ? "no"
                    : row->group == GLINT_NO_GROUP ? "yes"
                                                   : "with its group",
                    ranges[row->range], absent, or_dash(row->unit), row->meaning);
        }
    }
}

static void write_rules(FILE *out) {
    const struct glint_rule_row *rows = glint_rule_rows();
    fprintf(out, "| rule | what must hold |\n| --- | --- |\n");
    for (int i = 0; i < GLINT_RULE_COUNT; i++) fprintf(out, "| `%s` | %s |\n", rows[i].name, rows[i].text);
}

static void write_version(FILE *out) {
    fprintf(out, "This is version **%d**.\n", GLINT_FORMAT_VERSION);
}

static const struct {
    const char *name;
    void (*print)(FILE *out);
} tables[] = {{"version", write_version},     {"roles", write_roles},           {"channels", write_channels},
              {"encodings", write_encodings}, {"attributes", write_attributes}, {"rules", write_rules}};

/* Copies the text and replaces what is between `<!-- table NAME -->` and `<!-- end -->` by the table. */
static bool renew_tables(const char *text, FILE *out) {
    size_t found = 0;
    for (const char *line = text; *line;) {
        const char *end = strchr(line, '\n');
        end = end ? end + 1 : line + strlen(line);
        fwrite(line, 1, (size_t)(end - line), out);
        for (size_t t = 0; t < sizeof tables / sizeof *tables; t++) {
            char mark[64];
            snprintf(mark, sizeof mark, "<!-- table %s -->\n", tables[t].name);
            if (strncmp(line, mark, strlen(mark))) continue;
            tables[t].print(out);
            end = strstr(end, "<!-- end -->");
            if (!end) return false;
            found++;
        }
        line = end;
    }
    return found == sizeof tables / sizeof *tables;
}

static char *read_text(const char *path) {
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    fseek(file, 0, SEEK_END);
    const long size = ftell(file);
    rewind(file);
    char *text = size < 0 ? NULL : calloc(1, (size_t)size + 1);
    if (text && fread(text, 1, (size_t)size, file) != (size_t)size) text[0] = 0;
    fclose(file);
    return text;
}

int main(int argc, char **argv) {
    const bool check = argc > 2 && !strcmp(argv[1], "--check");
    const char *path = argc > 1 ? argv[argc - 1] : "";
    char *text = read_text(path), *fresh = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&fresh, &size);
    bool ok = text && memory && renew_tables(text, memory);
    if (memory) fclose(memory);
    if (!ok) fprintf(stderr, "%s: expected a text with the markers of every table\n", path);
    if (ok && check && strcmp(text, fresh)) {
        fprintf(stderr, "%s: its tables are not the registry's: run `meson compile format-doc`\n", path);
        ok = false;
    }
    if (ok && !check) {
        FILE *file = fopen(path, "wb");
        ok = file && fwrite(fresh, 1, size, file) == size;
        if (file && fclose(file)) ok = false;
    }
    free(text);
    free(fresh);
    return ok ? 0 : 1;
}
